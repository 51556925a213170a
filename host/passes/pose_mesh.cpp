#include "host/passes/pose_mesh.hpp"

#include "sim/error.hpp"
#include "sim/prototype.hpp"

namespace understory {

PoseMeshPass::PoseMeshPass(Device& device, bool thinned)
    : thinned_(thinned),
      lanes_(static_cast<std::size_t>(device.info().vector_width)),
      kernel_(device, "pose_mesh", "pose_mesh", "pose_mesh", thinned ? "-DTHINNED" : "") {}

void PoseMeshPass::run(const RestVertices& rest, const Buffer<PosedBlock>& blocks, const Buffer<LimbPose>& limbs,
                       PosedVertices& posed) {
  run(rest, blocks, 0, blocks.size(), limbs, nullptr, posed);
}

void PoseMeshPass::run(const RestVertices& rest, const Buffer<PosedBlock>& blocks, std::size_t first, std::size_t end,
                       const Buffer<LimbPose>& limbs, const EnlargedLeaves* enlarged, PosedVertices& posed) {
  const std::size_t vertices = end * vertex_block;
  if (posed.points.size() < vertices)
    throw Error(ErrorKind::unexpected, "pose_mesh: " + std::to_string(vertices) + " vertices do not fit the " +
                                           std::to_string(posed.points.size()) + " of the posed planes");
  if (blocks.size() < end || thinned_ != (enlarged != nullptr) || (thinned_ && enlarged->block_scale.size() < end))
    throw Error(ErrorKind::unexpected, "pose_mesh: " + std::to_string(end) + " blocks, of which " +
                                           std::to_string(blocks.size()) + " are there");
  const std::size_t items = vertices / lanes_, first_item = first * vertex_block / lanes_;
  const auto launch = [&](const auto&... more) {
    kernel_.launch_from(first_item, items - first_item, 64, rest.x, rest.y, rest.z, rest.flutter_x, rest.flutter_y,
                        rest.flutter_z, rest.flutter_phase, blocks, limbs, posed.points,
                        static_cast<std::uint32_t>(items), more...);
  };
  if (thinned_)
    launch(enlarged->pivot_x, enlarged->pivot_y, enlarged->pivot_z, enlarged->block_scale);
  else
    launch();
}

}  // namespace understory
