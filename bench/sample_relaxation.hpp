// Where obscurance samples the unit disc (lines) or the unit ball (points): Loos & Sloan 2010 section 4.5. Repulsion by
// 1/d^4 with a charge on the boundary, and Voronoi relaxation, so that every sample stands for an equal share of the
// ball's volume. Offline: `obscurance_samples` writes host/passes/obscurance_samples.cpp from it.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace understory {

enum class SampleDomain { disc, ball };

struct RelaxedSamples {
  SampleDomain domain = SampleDomain::disc;
  bool centre = false;             // the first sample is the centre
  std::vector<glm::dvec3> points;  // z = 0 in the disc
  /// Of each sample's Voronoi region, summing to 1: the share of the ball's volume (falloff constant), and of the
  /// integral of 1 - r^2 over it (falloff quadratic).
  std::vector<double> constant_share, quadratic_share;
  double deviation = 0;  // largest of |share times count - 1|, constant falloff
  double noise = 0;      // see sample_noise
};

/// The best of `starts` seeded starts by its noise, among those whose deviation is within twice the least. `polish`:
/// then moved a little for less noise, which a quarter of deviation may pay for.
RelaxedSamples relax_samples(SampleDomain domain, int count, bool centre, std::uint64_t seed, int starts, bool polish);

/// RMS error of the estimated open share, over planes in front of the ball's part behind them and over straight edges
/// of occluders, in all directions: what a per-pixel rotation turns into noise.
double sample_noise(const RelaxedSamples& samples);

}  // namespace understory
