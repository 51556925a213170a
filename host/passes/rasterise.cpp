#include "host/passes/rasterise.hpp"

#include <algorithm>

namespace understory {
namespace {

// A CPU core walks runs of marks; a GPU gives every triangle its own work-item.
std::uint32_t triangles_per_item(const Device& device) { return device.info().type == "cpu" ? 256 : 1; }

std::vector<Kernel> raster_kernels(Device& device, const char* name, std::uint32_t per_item, bool wide_atomics) {
  const std::string options = "-DTRIANGLES_PER_ITEM=" + std::to_string(per_item);
  std::vector<Kernel> kernels;
  if (wide_atomics) {
    kernels.emplace_back(device, "rasterise", name, name, options);
  } else {
    for (const char* pass : {" -DNARROW_ATOMICS -DRASTER_PASS=0", " -DNARROW_ATOMICS -DRASTER_PASS=1"})
      kernels.emplace_back(device, "rasterise", name, name, options + pass);
  }
  return kernels;
}

}  // namespace

RasterisePass::RasterisePass(Device& device, bool mesh, bool grass, bool wide_atomics)
    : lanes_(static_cast<std::size_t>(device.info().vector_width)),
      triangles_per_item_(triangles_per_item(device)),
      local_size_(device.info().type == "cpu" ? 16 : 64),
      words_per_item_(wide_atomics ? 2 : 1),
      clear_(std::move(raster_kernels(device, "clear_visible", triangles_per_item_, wide_atomics).front())) {
  if (mesh) {
    cull_mesh_.emplace(device, "cull_triangles", "cull_mesh", "cull_mesh");
    rasterise_mesh_ = raster_kernels(device, "rasterise_mesh", triangles_per_item_, wide_atomics);
  }
  if (grass) {
    cull_grass_.emplace(device, "cull_triangles", "cull_grass", "cull_grass");
    rasterise_grass_ = raster_kernels(device, "rasterise_grass", triangles_per_item_, wide_atomics);
  }
}

void RasterisePass::run(const TriangleTables& triangles, const PosedVertices& posed, const CameraView& camera,
                        Buffer<std::uint8_t>& marks, VisibilityBuffer& visible) {
  const auto items = static_cast<std::uint32_t>(visible.words.size() / words_per_item_);
  const std::uint32_t mesh_end = triangles.mesh_chunks * triangles_per_chunk;
  const std::uint32_t end = triangles.chunk_count() * triangles_per_chunk;
  clear_.launch(items, 256, visible.words, items);
  if (cull_mesh_)
    cull_mesh_->launch(mesh_end / lanes_, triangles_per_chunk / lanes_, triangles.chunks, triangles.index_a,
                       triangles.index_b, triangles.index_c, posed.x, posed.y, posed.z, camera, marks);
  if (cull_grass_)
    cull_grass_->launch((end - mesh_end) / lanes_, triangles_per_chunk / lanes_, triangles.chunks,
                        triangles.mesh_chunks, posed.x, posed.y, posed.z, camera, marks);
  const std::size_t mesh_items = (mesh_end + triangles_per_item_ - 1) / triangles_per_item_;
  const std::size_t grass_items = (end - mesh_end + triangles_per_item_ - 1) / triangles_per_item_;
  for (std::size_t pass = 0; pass < std::max(rasterise_mesh_.size(), rasterise_grass_.size()); ++pass) {
    if (cull_mesh_)
      rasterise_mesh_[pass].launch(mesh_items, local_size_, marks, mesh_end, triangles.chunks, triangles.index_a,
                                   triangles.index_b, triangles.index_c, posed.x, posed.y, posed.z, camera,
                                   visible.words);
    if (cull_grass_)
      rasterise_grass_[pass].launch(grass_items, local_size_, marks, mesh_end, end, triangles.chunks, posed.x, posed.y,
                                    posed.z, camera, visible.words);
  }
}

}  // namespace understory
