#include "host/passes/rasterise.hpp"

namespace understory {

std::vector<Kernel> raster_kernels(Device& device, const char* program, const char* name, bool wide_atomics) {
  std::vector<Kernel> kernels;
  if (wide_atomics) {
    kernels.emplace_back(device, program, name, name);
  } else {
    for (const char* options : {"-DNARROW_ATOMICS -DRASTER_PASS=0", "-DNARROW_ATOMICS -DRASTER_PASS=1"})
      kernels.emplace_back(device, program, name, name, options);
  }
  return kernels;
}

RasterisePass::RasterisePass(Device& device, bool mesh, bool grass, bool wide_atomics)
    : lanes_(static_cast<std::size_t>(device.info().vector_width)),
      wide_atomics_(wide_atomics),
      clear_(std::move(raster_kernels(device, "rasterise", "clear_visible", wide_atomics).front())) {
  if (mesh) rasterise_mesh_ = raster_kernels(device, "rasterise", "rasterise_mesh", wide_atomics);
  if (grass) rasterise_grass_ = raster_kernels(device, "rasterise", "rasterise_grass", wide_atomics);
}

void RasterisePass::clear(VisibilityBuffer& visible) {
  const auto items = static_cast<std::uint32_t>(visible.words.size() / (wide_atomics_ ? 2 : 1));
  clear_.launch(items, 256, visible.words, items);
}

void RasterisePass::draw_mesh(std::size_t raster_pass, const TriangleTables& triangles, std::uint32_t first,
                              std::uint32_t end, const PosedVertices& posed, const CameraView& camera,
                              VisibilityBuffer& visible) {
  if (first == end) return;
  const std::size_t local = triangles_per_chunk / lanes_;
  rasterise_mesh_[raster_pass].launch_from(first * local, (end - first) * local, local, triangles.chunks,
                                           triangles.index_a, triangles.index_b, triangles.index_c, posed.points,
                                           camera, visible.words);
}

void RasterisePass::run(const TriangleTables& triangles, const PosedVertices& posed, const CameraView& camera,
                        VisibilityBuffer& visible) {
  clear(visible);
  const std::size_t local = triangles_per_chunk / lanes_;
  for (std::size_t pass = 0; pass < raster_passes(); ++pass) {
    if (!rasterise_mesh_.empty()) draw_mesh(pass, triangles, 0, triangles.mesh_chunks, posed, camera, visible);
    if (!rasterise_grass_.empty())
      rasterise_grass_[pass].launch(triangles.grass_chunks * local, local, triangles.chunks, triangles.mesh_chunks,
                                    posed.points, camera, visible.words);
  }
}

}  // namespace understory
