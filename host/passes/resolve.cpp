#include "host/passes/resolve.hpp"

namespace understory {
namespace {

std::string options(const ResolvedPlanes& write, bool wide_atomics) {
  std::string text;
  if (write.grass_height) text += "-DGRASS_HEIGHT ";
  if (write.rest_point) text += "-DREST_POINT ";
  if (write.texel) text += "-DFACE_TEXEL ";
  if (!wide_atomics) text += "-DNARROW_ATOMICS ";
  return text;
}

}  // namespace

ResolvePass::ResolvePass(Device& device, const ResolvedPlanes& write, bool wide_atomics)
    : write_(write),
      lanes_(static_cast<std::uint32_t>(device.info().vector_width)),
      kernel_(device, "resolve", "resolve", "resolve", options(write, wide_atomics)) {}

void ResolvePass::run(const VisibilityBuffer& visible, const TriangleTables& triangles, const PosedVertices& posed,
                      const RestGeometry& rest, const CameraView& camera, FragmentPlanes& planes, const Batch& batch) {
  const auto fragments = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  require_size("resolve", "fragments", planes.fragments, fragments);
  require_size("resolve", "visible", visible.words.size(), 2 * fragments);
  const auto padded = static_cast<std::uint32_t>(planes.padded_fragments);
  // Small groups on a processor: what work-items hold of their triangles has to fit its first cache.
  const std::size_t local = lanes_ > 1 ? 8 : 64;
  const auto launch = [&](const auto&... more) {
    kernel_.launch(padded / lanes_, local, visible.words, triangles.chunks, triangles.mesh_chunks, triangles.index_a,
                   triangles.index_b, triangles.index_c, posed.points, camera, padded, std::uint32_t{batch.first},
                   std::uint32_t{batch.last}, planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                   planes.normal_y, planes.normal_z, planes.depth, planes.owner, planes.validity, more...);
  };
  const auto with_texel = [&](const auto&... more) {
    if (!write_.texel) return launch(more...);
    require_size("resolve", "texel", planes.texel.size(), planes.padded_fragments);
    require_size("resolve", "faces", rest.faces->size(), triangles.index_a.size());
    launch(more..., *rest.faces, planes.texel, planes.texel_place);
  };
  const auto with_rest = [&](const auto&... more) {
    if (!write_.rest_point) return with_texel(more...);
    const auto& p = planes.rest_position;
    const auto& n = planes.rest_normal;
    require_size("resolve", "rest point", p[0].size(), planes.padded_fragments);
    with_texel(more..., *rest.blocks, rest.vertices->x, rest.vertices->y, rest.vertices->z, p[0], p[1], p[2], n[0],
               n[1], n[2]);
  };
  if (write_.grass_height)
    with_rest(rest.blades.root_z, rest.blades.length, rest.mesh_grass->root_z, rest.mesh_grass->height,
              rest.root_offset_z, planes.height_above_root, planes.blade_length);
  else
    with_rest();
}

}  // namespace understory
