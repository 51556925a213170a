// The traced truth: ambient visibility of surface points by Monte Carlo over the triangles themselves, with the
// uncertainty of every value. What methods, fields, grids and calibrations are judged by.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "host/trace/tracer.hpp"
#include "sim/scene.hpp"

namespace understory {

enum class Weighting {
  cosine,   // V_c, the product's quantity
  uniform,  // V_u of Hegeman et al. 2006, eq. 3
};

struct TruthOptions {
  int rays = 256;          // per point, rounded up to whole replicates of `truth_replicates`
  std::uint64_t seed = 1;  // the same seed gives the same bytes on any number of threads
  Weighting weighting = Weighting::cosine;
  /// Under the dome, directions below the horizon see no sky. Not applied with a finite `max_distance`.
  Sky sky = Sky::dome;
  /// Hits farther away than this do not count, m: the distance-limited obscurance that near-field methods approximate.
  float max_distance = std::numeric_limits<float>::infinity();
  /// Where positions were measured from, m: their float error grows with the distance to it, see surface_offset.
  glm::vec3 eye{0};
  /// Number of the first point: points that are traced in several calls get the rays they would get in one.
  std::uint64_t first_point = 0;
};

/// Rays come in this many independently scrambled sets, whose scatter tells the error.
inline constexpr int truth_replicates = 8;

/// One entry a point.
struct Truth {
  std::vector<float> visibility;    // [0, 1]
  std::vector<float> halfwidth;     // of the 95 % interval about it; never 0
  std::vector<std::uint32_t> rays;  // traced or known without; 0: position or normal unusable (V = 1, half-width 1)
};

/// `positions` in the tracer's frame, m; `normals` unit, on the side that is asked for. Surfaces are opaque and
/// two-sided. Runs on all cores. Throws Error(invalid_input) for spans of different size, fewer than two rays a
/// replicate, or a max_distance that is not positive.
Truth trace_truth(const Tracer& tracer, std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                  const TruthOptions& options);

/// How far off its own surface a ray starts, m, along the normal: 2^-18 of the distances to the origin and to the eye,
/// 64 times the rounding error of such a position, and at least 2 micrometres. 0.1 mm for a tree seen from 20 m.
float surface_offset(glm::vec3 position, glm::vec3 eye);

/// Variance of a value that trace_truth gave, from its half-width: unbiased over many of them. 0 without rays.
double truth_variance(float halfwidth, std::uint32_t rays);

/// Half-width of the 95 % interval from the means of the replicates, of `rays` rays in all. See truth.cpp.
float interval_halfwidth(std::span<const double> replicate_means, int rays);

}  // namespace understory
