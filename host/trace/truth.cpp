// Randomised quasi-Monte Carlo: each replicate is an Owen-scrambled Sobol set of its own, an unbiased estimate by
// itself (Owen 1997, "Monte Carlo variance of scrambled net quadrature"; L'Ecuyer and Lemieux 2002, section 4).
#include "host/trace/truth.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "host/trace/directions.hpp"
#include "sim/error.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr double student_t_7 = 2.364624;  // 97.5 % quantile at truth_replicates - 1 degrees of freedom
constexpr double normal_95 = 1.959964;    // 97.5 % quantile of the normal distribution
static_assert(truth_replicates == 8);

/// Upper end of Wilson's 95 % interval for a share of which `rays` rays saw nothing.
double unseen_share(double rays) { return normal_95 * normal_95 / (rays + normal_95 * normal_95); }

bool is_usable(glm::vec3 position, glm::vec3 normal) {
  const float sum = position.x + position.y + position.z + normal.x + normal.y + normal.z;
  return std::isfinite(sum) && std::abs(glm::dot(normal, normal) - 1) < 1e-2f;
}

/// One thread's rays, and where their answers go.
class PointTracer {
 public:
  PointTracer(const Tracer& tracer, const TruthOptions& options)
      : tracer_(tracer),
        options_(options),
        per_replicate_((options.rays + truth_replicates - 1) / truth_replicates),
        horizon_(options.sky == Sky::dome && std::isinf(options.max_distance)) {}

  void trace(glm::vec3 position, glm::vec3 normal, std::uint64_t point, Truth& truth, std::size_t at) {
    if (!is_usable(position, normal)) {
      truth.visibility[at] = truth.halfwidth[at] = 1;
      truth.rays[at] = 0;
      return;
    }
    make_rays(position + surface_offset(position, options_.eye) * normal, normal, point);
    blocked_.resize(rays_.size());
    tracer_.blocked(rays_, blocked_);
    std::array<double, truth_replicates> means{};
    for (std::size_t i = 0; i < rays_.size(); ++i)
      if (!blocked_[i]) means[replicate_[i]] += 1.0 / per_replicate_;
    double sum = 0;
    for (const double mean : means) sum += mean;
    const int count = truth_replicates * per_replicate_;
    truth.visibility[at] = static_cast<float>(std::clamp(sum / truth_replicates, 0.0, 1.0));
    truth.halfwidth[at] = interval_halfwidth(means, count);
    truth.rays[at] = static_cast<std::uint32_t>(count);
  }

 private:
  void make_rays(glm::vec3 origin, glm::vec3 normal, std::uint64_t point) {
    const glm::mat3 frame = frame_about(normal);
    Random random(options_.seed, stream_of("truth"), point);
    rays_.clear();
    replicate_.clear();
    for (std::uint8_t replicate = 0; replicate < truth_replicates; ++replicate) {
      const auto seed = static_cast<std::uint32_t>(random.bits());
      for (int i = 0; i < per_replicate_; ++i) {
        const glm::vec2 u = scrambled_sobol(static_cast<std::uint32_t>(i), seed);
        const glm::vec3 local = options_.weighting == Weighting::cosine ? cosine_hemisphere(u) : uniform_hemisphere(u);
        const glm::vec3 direction = frame * local;
        if (horizon_ && direction.z <= 0) continue;
        rays_.push_back({origin, 0, direction, options_.max_distance});
        replicate_.push_back(replicate);
      }
    }
  }

  const Tracer& tracer_;
  const TruthOptions& options_;
  int per_replicate_;
  bool horizon_;
  std::vector<Ray> rays_;
  std::vector<std::uint8_t> replicate_, blocked_;
};

void require(const TruthOptions& options, std::size_t positions, std::size_t normals) {
  const auto refuse = [](const std::string& message) { throw Error(ErrorKind::invalid_input, "truth: " + message); };
  if (positions != normals)
    refuse(std::to_string(positions) + " positions and " + std::to_string(normals) + " normals; allowed: as many");
  if (options.rays < 2 * truth_replicates || options.rays > 1 << 24)
    refuse(std::to_string(options.rays) + " rays; allowed: " + std::to_string(2 * truth_replicates) + " to " +
           std::to_string(1 << 24));
  if (!(options.max_distance > 0))
    refuse("a largest distance of " + std::to_string(options.max_distance) + " m; allowed: more than 0");
}

}  // namespace

float surface_offset(glm::vec3 position, glm::vec3 eye) {
  return std::max(0x1p-18f * (glm::length(position) + glm::distance(position, eye)), 2e-6f);
}

// The scatter of the replicates gives a Student interval. It is 0 when all agree, as they do when few rays saw nothing
// or missed nothing; Wilson's score interval (1927) at 0 of n bounds what n rays may have overlooked, z^2/(n + z^2).
// Both errors are independent, so their squares add.
float interval_halfwidth(std::span<const double> replicate_means, int rays) {
  const auto replicates = static_cast<double>(replicate_means.size());
  double mean = 0, squares = 0;
  for (const double m : replicate_means) mean += m / replicates;
  for (const double m : replicate_means) squares += (m - mean) * (m - mean);
  const double scatter = student_t_7 * std::sqrt(squares / (replicates * (replicates - 1)));
  const double unseen = unseen_share(rays);
  return static_cast<float>(std::hypot(scatter, unseen));
}

double truth_variance(float halfwidth, std::uint32_t rays) {
  if (rays == 0) return 0;
  const double unseen = unseen_share(rays);
  return std::max(double(halfwidth) * halfwidth - unseen * unseen, 0.0) / (student_t_7 * student_t_7);
}

Truth trace_truth(const Tracer& tracer, std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                  const TruthOptions& options) {
  require(options, positions.size(), normals.size());
  Truth truth;
  truth.visibility.resize(positions.size());
  truth.halfwidth.resize(positions.size());
  truth.rays.resize(positions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, positions.size(), 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      PointTracer points(tracer, options);
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                        points.trace(positions[i], normals[i], options.first_point + i, truth, i);
                    });
  return truth;
}

}  // namespace understory
