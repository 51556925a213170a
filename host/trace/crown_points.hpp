// What random lines through a crown tell about it: how much of them its foliage blocks, and where they first meet the
// plant, which are the fragments that cameras all around would see.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/trace/tracer.hpp"
#include "sim/crown.hpp"
#include "sim/prototype.hpp"

namespace understory {

/// A prototype's triangles at rest, its own frame, ready to be traced.
Tracer trace_prototype(const Prototype& prototype);

/// A line, inside a sphere: from where it enters, over `length` m.
struct CrownLine {
  glm::vec3 origin{0}, direction{0, 0, 1};  // unit
  float length = 0;
};

/// `count` lines spread evenly over places and directions: uniform chords of the sphere.
std::vector<CrownLine> random_lines(const Sphere& sphere, std::size_t count, std::uint32_t seed);

/// Points of the plant's surface, each with what is open above it.
struct CrownPoints {
  std::vector<glm::vec3> positions, normals;  // m; unit, towards where the point was seen from
  std::vector<float> visibility;              // V_c under `sky: sphere`, traced
};

/// Where lines first meet the plant: up to `count` points, fewer where it is too sparse, V by `rays` rays each.
CrownPoints seen_points(const Tracer& tracer, const Prototype& prototype, std::size_t count, int rays,
                        std::uint32_t seed);

/// For each line 1 when a triangle lies on it within the sphere, 0 when none does, -1 when it misses the sphere.
std::vector<std::int8_t> blocked_within(const Tracer& tracer, const std::vector<CrownLine>& lines,
                                        const Sphere& sphere);

}  // namespace understory
