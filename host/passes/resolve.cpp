#include "host/passes/resolve.hpp"

namespace understory {

ResolvePass::ResolvePass(Device& device, bool grass_height, bool wide_atomics)
    : grass_height_(grass_height),
      kernel_(device, "resolve", "resolve", "resolve",
              std::string(grass_height ? "-DGRASS_HEIGHT " : "") + (wide_atomics ? "" : "-DNARROW_ATOMICS")) {}

void ResolvePass::run(const VisibilityBuffer& visible, const TriangleTables& triangles, const PosedVertices& posed,
                      const RestBlades& blades, const CameraView& camera, float root_offset_z, FragmentPlanes& planes) {
  const auto fragments = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  require_size("resolve", "fragments", planes.fragments, fragments);
  require_size("resolve", "visible", visible.words.size(), 2 * fragments);
  const auto padded = static_cast<std::uint32_t>(planes.padded_fragments);
  const auto launch = [&](const auto&... grass) {
    kernel_.launch(padded, 64, visible.words, triangles.chunks, triangles.mesh_chunks, triangles.index_a,
                   triangles.index_b, triangles.index_c, posed.points, camera, padded, planes.position_x,
                   planes.position_y, planes.position_z, planes.normal_x, planes.normal_y, planes.normal_z,
                   planes.depth, planes.owner, planes.validity, grass...);
  };
  if (grass_height_)
    launch(blades.root_z, blades.length, root_offset_z, planes.height_above_root, planes.blade_length);
  else
    launch();
}

}  // namespace understory
