// Which passes a scene needs, and why. Nothing else is built, allocated or run.
#pragma once
#include <string>
#include <vector>

#include "sim/world.hpp"

namespace understory {

struct PlannedPass {
  std::string name;     // as in timings and run.json: pose_mesh, rasterise_grass, sphere-cap, combine, ...
  std::string program;  // stem of its kernel file
  std::string because;  // one phrase for a person: what in the scene needs it
  std::string key;      // of the scene, which asked for it; empty: every frame has it
};

/// A kind of pass that this frame does without.
struct LeftOut {
  std::string what;     // in words: the near field, the tree model, ...
  std::string because;  // one phrase for a person
  std::string key;      // of the scene, by which it would come back
};

struct Plan {
  std::vector<PlannedPass> passes;  // in order of execution
  std::vector<LeftOut> left_out;    // what other scenes or methods would run
  bool has(const std::string& pass_name) const;
};

/// The plan of a whole frame. Throws Error(invalid_input) for a method name that does not exist.
Plan make_plan(const World& world, const Methods& methods);

/// The plan of the visibility passes alone, for planes rendered elsewhere; `world` may be null (open dome only).
Plan make_visibility_plan(const World* world, const Methods& methods);

}  // namespace understory
