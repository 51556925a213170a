#include "bench/sample_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/random.hpp"

namespace understory {
namespace {

const double pi = std::numbers::pi;

struct Cell {
  glm::dvec3 at{0};
  double constant = 0, quadratic = 0;  // integrals over the cell, not normalised
};

/// A grid of `side` cells across the disc or ball; disc cells hold the integral along the line through them.
std::vector<Cell> cells_of(SampleDomain domain, int side) {
  std::vector<Cell> cells;
  const auto middle = [&](int i) { return (i + 0.5) * 2 / side - 1; };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double x = middle(i), y = middle(j), flat = x * x + y * y;
      if (flat >= 1) continue;
      if (domain == SampleDomain::disc) {
        const double half = std::sqrt(1 - flat);
        cells.push_back({{x, y, 0}, 2 * half, 4.0 / 3 * half * half * half});
        continue;
      }
      for (int k = 0; k < side; ++k) {
        const double z = middle(k), square = flat + z * z;
        if (square < 1) cells.push_back({{x, y, z}, 1, 1 - square});
      }
    }
  return cells;
}

struct Regions {
  std::vector<double> constant, quadratic;
  std::vector<glm::dvec3> centroid;  // weighted by the constant integral
};

Regions voronoi(const std::vector<glm::dvec3>& points, const std::vector<Cell>& cells) {
  Regions regions{std::vector<double>(points.size()), std::vector<double>(points.size()),
                  std::vector<glm::dvec3>(points.size(), glm::dvec3(0))};
  double constant = 0, quadratic = 0;
  for (const Cell& cell : cells) {
    std::size_t nearest = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec3 offset = points[i] - cell.at;
      const double square = glm::dot(offset, offset);
      if (square < least) least = square, nearest = i;
    }
    regions.constant[nearest] += cell.constant;
    regions.quadratic[nearest] += cell.quadratic;
    regions.centroid[nearest] += cell.constant * cell.at;
    constant += cell.constant;
    quadratic += cell.quadratic;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    regions.centroid[i] = regions.constant[i] > 0 ? regions.centroid[i] / regions.constant[i] : points[i];
    regions.constant[i] /= constant;
    regions.quadratic[i] /= quadratic;
  }
  return regions;
}

double deviation_of(const Regions& regions) {
  double worst = 0;
  for (const double share : regions.constant)
    worst = std::max(worst, std::abs(share * static_cast<double>(regions.constant.size()) - 1));
  return worst;
}

glm::dvec3 random_point(Random& random, SampleDomain domain) {
  while (true) {
    glm::dvec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (domain == SampleDomain::disc) p.z = 0;
    if (glm::dot(p, p) < 0.9) return p;
  }
}

/// One step of at most `step` along the forces: 1/d^4 from each other and `charge`/d^4 from the nearest boundary.
std::vector<glm::dvec3> pushed(const std::vector<glm::dvec3>& points, bool centre, double charge, double step) {
  std::vector<glm::dvec3> force(points.size(), glm::dvec3(0));
  double largest = 0;
  for (std::size_t i = centre ? 1 : 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (i == j) continue;
      const glm::dvec3 apart = points[i] - points[j];
      force[i] += apart / std::pow(std::max(glm::dot(apart, apart), 1e-8), 2.5);
    }
    const double radius = glm::length(points[i]);
    if (radius > 1e-9) force[i] -= charge * points[i] / radius / std::pow(std::max(1 - radius, 0.02), 4);
    largest = std::max(largest, glm::length(force[i]));
  }
  std::vector<glm::dvec3> moved = points;
  for (std::size_t i = centre ? 1 : 0; i < points.size(); ++i) {
    moved[i] += step * force[i] / std::max(largest, 1e-12);
    const double radius = glm::length(moved[i]);
    if (radius > 0.98) moved[i] *= 0.98 / radius;
  }
  return moved;
}

/// Forces are reduced until the error decreases and grow otherwise; centroids pull every eighth round.
std::vector<glm::dvec3> relaxed(std::vector<glm::dvec3> points, bool centre, double charge,
                                const std::vector<Cell>& cells) {
  double step = 0.1;
  for (int round = 0; round < 60; ++round) points = pushed(points, centre, charge, 0.1 / (1 + 0.1 * round));
  double error = deviation_of(voronoi(points, cells));
  for (int round = 0; round < 120 && step > 1e-4; ++round) {
    const std::vector<glm::dvec3> moved = pushed(points, centre, charge, step);
    const double moved_error = deviation_of(voronoi(moved, cells));
    if (moved_error < error)
      points = moved, error = moved_error, step *= 1.3;
    else
      step *= 0.6;
    if (round % 8 != 7) continue;
    std::vector<glm::dvec3> pulled = points;
    const Regions regions = voronoi(points, cells);
    for (std::size_t i = centre ? 1 : 0; i < points.size(); ++i)
      pulled[i] = 0.7 * points[i] + 0.3 * regions.centroid[i];
    const double pulled_error = deviation_of(voronoi(pulled, cells));
    if (pulled_error < error) points = pulled, error = pulled_error;
  }
  return points;
}

RelaxedSamples weighed(SampleDomain domain, bool centre, std::vector<glm::dvec3> points,
                       const std::vector<Cell>& cells) {
  const Regions regions = voronoi(points, cells);
  RelaxedSamples samples{domain, centre, std::move(points), regions.constant, regions.quadratic, deviation_of(regions),
                         0};
  samples.noise = sample_noise(samples);
  return samples;
}

/// Small random moves that lower the noise; the Voronoi shares follow, and may drift apart by a quarter.
RelaxedSamples polished(RelaxedSamples samples, std::uint64_t seed, const std::vector<Cell>& cells) {
  Random random(seed, stream_of("obscurance polish", samples.points.size()));
  double step = 0.05;
  for (int round = 0; round < 1500; ++round) {
    std::vector<glm::dvec3> moved = samples.points;
    for (std::size_t i = samples.centre ? 1 : 0; i < moved.size(); ++i) {
      glm::dvec3 by(random.normal(), random.normal(), random.normal());
      if (samples.domain == SampleDomain::disc) by.z = 0;
      moved[i] += step * by;
      if (glm::length(moved[i]) > 0.98) moved[i] *= 0.98 / glm::length(moved[i]);
    }
    RelaxedSamples next = weighed(samples.domain, samples.centre, moved, cells);
    const bool better = next.noise < samples.noise && next.deviation < std::max(0.25, samples.deviation);
    step = std::clamp(step * (better ? 1.5 : 0.97), 1e-4, 0.1);
    if (better) samples = std::move(next);
  }
  return samples;
}

/// Share of the ball in front of the depth that `depth(x, y)` gives.
double estimated(const RelaxedSamples& samples, const auto& depth) {
  double open = 0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const glm::dvec3 p = samples.points[i];
    const double d = depth(p.x, p.y);
    if (samples.domain == SampleDomain::ball) {
      open += p.z < d ? samples.constant_share[i] : 0;
      continue;
    }
    const double half = std::sqrt(std::max(1 - p.x * p.x - p.y * p.y, 1e-12));
    open += samples.constant_share[i] * std::max(std::min(half, d) + half, 0.0) / (2 * half);
  }
  return open;
}

/// Share of the unit ball on the side of a plane at signed distance t in [-1, 1] that holds more for larger t.
double ball_share(double t) { return (2 + 3 * t - t * t * t) / 4; }

}  // namespace

double sample_noise(const RelaxedSamples& samples) {
  constexpr int turns = 48, heights = 9, tilts = 5;
  double sum = 0;
  int cases = 0;
  for (int turn = 0; turn < turns; ++turn) {
    const double phi = 2 * pi * (turn + 0.5) / turns, c = std::cos(phi), s = std::sin(phi);
    for (int height = 0; height < heights; ++height) {
      const double t = -0.9 + 1.8 * height / (heights - 1);
      // An edge: nothing beyond the line, everything closed before it.
      const double edge = estimated(samples, [=](double x, double y) { return c * x + s * y < t ? 9.0 : -9.0; });
      sum += (edge - ball_share(t)) * (edge - ball_share(t));
      ++cases;
      for (int tilt = 0; tilt < tilts; ++tilt) {
        const double theta = 0.5 * pi * (tilt + 0.25) / tilts, slope = std::tan(theta);
        const double plane =
            estimated(samples, [=](double x, double y) { return (c * x + s * y) * slope + t / std::cos(theta); });
        sum += (plane - ball_share(t)) * (plane - ball_share(t));
        ++cases;
      }
    }
  }
  return std::sqrt(sum / cases);
}

RelaxedSamples relax_samples(SampleDomain domain, int count, bool centre, std::uint64_t seed, int starts, bool polish) {
  const bool disc = domain == SampleDomain::disc;
  const std::vector<Cell> coarse = cells_of(domain, disc ? 64 : 20), fine = cells_of(domain, disc ? 512 : 128);
  std::vector<RelaxedSamples> all;
  for (int start = 0; start < starts; ++start) {
    Random random(seed, stream_of("obscurance samples"), static_cast<std::uint64_t>(start));
    std::vector<glm::dvec3> points;
    for (int i = 0; i < count; ++i) points.push_back(centre && i == 0 ? glm::dvec3(0) : random_point(random, domain));
    // The boundary's charge decides how far out the outermost points lie.
    for (double charge = 1e-4; charge < 2; charge *= 3)
      all.push_back(weighed(domain, centre, relaxed(points, centre, charge, coarse), coarse));
  }
  double least = 1e300;
  for (const RelaxedSamples& samples : all) least = std::min(least, samples.deviation);
  const RelaxedSamples* best = nullptr;
  for (const RelaxedSamples& samples : all)
    if (samples.deviation <= 2 * least && (!best || samples.noise < best->noise)) best = &samples;
  return weighed(domain, centre, (polish ? polished(*best, seed, coarse) : *best).points, fine);
}

}  // namespace understory
