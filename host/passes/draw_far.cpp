#include "host/passes/draw_far.hpp"

#include "sim/error.hpp"
#include "sim/prototype.hpp"

namespace understory {

DrawFarPass::DrawFarPass(Device& device, bool wide_atomics)
    : lanes_(static_cast<std::size_t>(device.info().vector_width)),
      kernels_(raster_kernels(device, "draw_far", "draw_far", wide_atomics)) {}

void DrawFarPass::run(std::size_t raster_pass, const RestVertices& rest, const Buffer<PosedBlock>& blocks,
                      const Buffer<float>& block_scale, const Buffer<LimbPose>& limbs, const Buffer<FarUnit>& units,
                      std::size_t count, const CameraView& camera, PosedVertices& posed, VisibilityBuffer& visible) {
  if (count > units.size() || blocks.size() > block_scale.size())
    throw Error(ErrorKind::unexpected, "draw_far: " + std::to_string(count) + " units of " +
                                           std::to_string(units.size()) + ", " + std::to_string(block_scale.size()) +
                                           " scales for " + std::to_string(blocks.size()) + " blocks");
  const auto items = static_cast<std::uint32_t>(count * vertex_block / lanes_);
  kernels_[raster_pass].launch(items, 64, rest.x, rest.y, rest.z, rest.flutter_x, rest.flutter_y, rest.flutter_z,
                               rest.flutter_phase, blocks, block_scale, limbs, units, items, camera, posed.points,
                               visible.words);
}

}  // namespace understory
