// Rays against triangles: the traced truth, grid baking and calibration stand on it. Embree only here.
// Positions in metres in whatever frame the caller likes; floats, so keep coordinates near its origin.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>

namespace understory {

/// Points origin + s * direction for s in [nearest, farthest], nearest >= 0; `direction` need not be unit. A ray that
/// is not finite or has no direction hits nothing.
struct Ray {
  glm::vec3 origin{0};
  float nearest = 0;
  glm::vec3 direction{0, 0, 1};
  float farthest = std::numeric_limits<float>::infinity();
};

inline constexpr std::uint32_t no_hit = 0xffffffffu;

/// The nearest triangle that a ray meets, from either side.
struct Hit {
  float distance = std::numeric_limits<float>::infinity();  // in units of Ray::direction
  std::uint32_t triangle = no_hit;
  bool from_front = false;  // against the triangle's counter-clockwise normal
};

/// Triangles, two-sided and opaque, ready to be traced. Copies them. Calls are safe from many threads at once and run
/// on the caller's. Hand over 64 rays or more at once: they are traced in streams. A ray's answer does not depend on
/// those beside it.
class Tracer {
 public:
  /// `triangles`: three indices each into `vertices`. Builds on all cores; the same input gives the same answers.
  /// No triangles: nothing is ever hit. Throws Error(invalid_input) for an index out of range or more than 2^31
  /// vertices or triangles, Error(unexpected) when Embree refuses.
  Tracer(std::span<const glm::vec3> vertices, std::span<const std::uint32_t> triangles);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  /// For each ray 1 when any triangle lies on it, else 0. Spans of one size.
  void blocked(std::span<const Ray> rays, std::span<std::uint8_t> out) const;
  void nearest(std::span<const Ray> rays, std::span<Hit> out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understory
