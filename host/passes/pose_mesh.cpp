#include "host/passes/pose_mesh.hpp"

#include "sim/error.hpp"
#include "sim/prototype.hpp"

namespace understory {

PoseMeshPass::PoseMeshPass(Device& device)
    : lanes_(static_cast<std::size_t>(device.info().vector_width)),
      kernel_(device, "pose_mesh", "pose_mesh", "pose_mesh") {}

void PoseMeshPass::run(const RestVertices& rest, const Buffer<PosedBlock>& blocks, const Buffer<LimbPose>& limbs,
                       PosedVertices& posed) {
  const std::size_t vertices = blocks.size() * vertex_block;
  if (posed.points.size() < vertices)
    throw Error(ErrorKind::unexpected, "pose_mesh: " + std::to_string(vertices) + " vertices do not fit the " +
                                           std::to_string(posed.points.size()) + " of the posed planes");
  const std::size_t items = vertices / lanes_;
  kernel_.launch(items, 64, rest.x, rest.y, rest.z, rest.flutter_x, rest.flutter_y, rest.flutter_z, rest.flutter_phase,
                 blocks, limbs, posed.points, static_cast<std::uint32_t>(items));
}

}  // namespace understory
