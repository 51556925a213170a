// A prototype's surface at rest, to be traced and sampled: points on either side of its triangles, evenly by area.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/trace/tracer.hpp"
#include "sim/prototype.hpp"
#include "sim/scene.hpp"

namespace understory {

/// A point, m, prototype frame, and the unit normal of the side that is looked from.
struct SurfacePoint {
  glm::vec3 position{0}, normal{0};
};

class RestSurface {
 public:
  explicit RestSurface(const Prototype& prototype);

  /// Corner 0, 1 or 2 of a triangle, m.
  glm::vec3 corner(std::size_t triangle, int number) const {
    return positions_[triangles_[3 * triangle + static_cast<std::size_t>(number)]];
  }
  std::size_t triangle_count() const { return triangles_.size() / 3; }
  float area(std::size_t triangle) const;           // m^2, of one side
  glm::vec3 normal(std::size_t triangle) const;     // unit, counter-clockwise
  float offset() const { return offset_; }          // how far off the surface rays start, m
  const Tracer& tracer() const { return tracer_; }  // of all triangles

  /// Which of the rays leave `points[i]` towards `directions[i]` (unit, above its surface) unhindered: 1 or 0.
  void open(std::span<const SurfacePoint> points, std::span<const glm::vec3> directions,
            std::span<std::uint8_t> out) const;

 private:
  std::vector<glm::vec3> positions_;
  std::vector<std::uint32_t> triangles_;
  float offset_ = 0;
  Tracer tracer_;
};

}  // namespace understory
