#include "host/passes/depth_moments.hpp"

namespace understory {

DepthMomentsPass::DepthMomentsPass(Device& device)
    : take_(device, "depth_moments", "take_depths", "depth-moments"),
      halve_(device, "depth_moments", "halve_moments", "depth-moments") {}

DepthMoments DepthMomentsPass::allocate(Device& device, const ObscuranceView& view) const {
  DepthMoments moments;
  MomentLevel level{0, view.width, view.height, 0};
  while (true) {
    moments.levels.push_back(level);
    if (level.width == 1 && level.height == 1) break;
    // The taps 1 3 3 1 spread by 3/4 of a finer texel squared: 3/4 (1 + 4 + 16 + ...) = (4^l - 1)/4.
    level.plane_variance = 4 * level.plane_variance + 0.75f;
    level.first += static_cast<std::uint32_t>(level.width * level.height);
    level.width = (level.width + 1) / 2;
    level.height = (level.height + 1) / 2;
  }
  const std::size_t texels = level.first + 1;
  moments.mean = Buffer<float>(device, texels, "mean depth");
  moments.variance = Buffer<float>(device, texels, "depth variance");
  moments.coverage = Buffer<float>(device, texels, "depth coverage");
  moments.level_table = Buffer<MomentLevel>(device, std::span<const MomentLevel>(moments.levels), "moment levels");
  return moments;
}

void DepthMomentsPass::run(const FragmentPlanes& planes, const ObscuranceView& view, DepthMoments& moments) {
  require_view("depth-moments", planes, view, planes.depth);
  const MomentLevel& finest = moments.levels.front();
  require_size("depth-moments", "finest level", static_cast<std::size_t>(finest.width * finest.height),
               planes.fragments);
  const auto count = static_cast<std::uint32_t>(planes.fragments);
  take_.launch(count, 0, planes.depth, planes.validity, count, static_cast<std::uint32_t>(view.perspective),
               moments.mean, moments.variance, moments.coverage);
  for (std::size_t level = 1; level < moments.levels.size(); ++level) {
    const MomentLevel &from = moments.levels[level - 1], &to = moments.levels[level];
    halve_.launch(static_cast<std::size_t>(to.width * to.height), 0, from, to, moments.mean, moments.variance,
                  moments.coverage);
  }
}

}  // namespace understory
