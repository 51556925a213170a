#include "host/passes/rasterise.hpp"

#include <algorithm>

namespace understory {
namespace {

std::vector<Kernel> raster_kernels(Device& device, const char* name, bool wide_atomics) {
  std::vector<Kernel> kernels;
  if (wide_atomics) {
    kernels.emplace_back(device, "rasterise", name, name);
  } else {
    for (const char* options : {"-DNARROW_ATOMICS -DRASTER_PASS=0", "-DNARROW_ATOMICS -DRASTER_PASS=1"})
      kernels.emplace_back(device, "rasterise", name, name, options);
  }
  return kernels;
}

}  // namespace

RasterisePass::RasterisePass(Device& device, bool mesh, bool grass, bool wide_atomics)
    : lanes_(static_cast<std::size_t>(device.info().vector_width)),
      words_per_item_(wide_atomics ? 2 : 1),
      clear_(std::move(raster_kernels(device, "clear_visible", wide_atomics).front())) {
  if (mesh) rasterise_mesh_ = raster_kernels(device, "rasterise_mesh", wide_atomics);
  if (grass) rasterise_grass_ = raster_kernels(device, "rasterise_grass", wide_atomics);
}

void RasterisePass::run(const TriangleTables& triangles, const PosedVertices& posed, const CameraView& camera,
                        VisibilityBuffer& visible, bool clear, std::uint32_t first_chunk) {
  const auto items = static_cast<std::uint32_t>(visible.words.size() / words_per_item_);
  if (clear) clear_.launch(items, 256, visible.words, items);
  const std::size_t local = triangles_per_chunk / lanes_;
  // Without 64-bit atomics all depths come first, then all triangles at those depths.
  for (std::size_t pass = 0; pass < std::max(rasterise_mesh_.size(), rasterise_grass_.size()); ++pass) {
    if (!rasterise_mesh_.empty())
      rasterise_mesh_[pass].launch_from(first_chunk * local, (triangles.mesh_chunks - first_chunk) * local, local,
                                        triangles.chunks, triangles.index_a, triangles.index_b, triangles.index_c,
                                        posed.points, camera, visible.words);
    if (!rasterise_grass_.empty())
      rasterise_grass_[pass].launch(triangles.grass_chunks * local, local, triangles.chunks, triangles.mesh_chunks,
                                    posed.points, camera, visible.words);
  }
}

}  // namespace understory
