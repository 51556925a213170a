// Which methods and settings a scene can be shaded with, one class of object at a time: the terms of a tradeoff.
#pragma once
#include <vector>

#include "bench/tradeoff.hpp"

namespace understory {

/// The terms of V that methods stand for (FORMULAS.md, "One fragment, several methods"). `crowns_occluders`: one pass
/// that shades by the spheres of both.
enum class Axis { tree, grass, crowns, occluders, crowns_occluders, near };

/// One way to compute one term, all other terms left out.
struct Term {
  Axis axis = Axis::tree;
  Variant variant;
};

/// Nothing but the open dome; settings (radius of the near field, ...) are the scene's.
Variant bare_variant(const Scene& scene);

/// Every term that the scene has something for, each once. Those that the plan would leave out are not among them.
std::vector<Term> terms_of(const World& world);

/// The scene's own methods, those without an effect there as "none".
Variant own_variant(const World& world);

/// `into` with the methods and settings that `term` is about.
Methods with_term(Methods into, Axis axis, const Methods& term);

}  // namespace understory
