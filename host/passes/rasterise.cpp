#include "host/passes/rasterise.hpp"

#include <algorithm>

namespace understory {
namespace {

// A CPU core walks runs of marks; a GPU gives every triangle its own work-item.
std::uint32_t triangles_per_item(const Device& device) { return device.info().type == "cpu" ? 256 : 1; }

std::vector<Kernel> raster_kernels(Device& device, const char* name, std::uint32_t per_item) {
  const std::string common = "-DTRIANGLES_PER_ITEM=" + std::to_string(per_item);
  std::vector<Kernel> kernels;
  if (device.info().atomic64) {
    kernels.emplace_back(device, "rasterise", name, name, common);
  } else {
    kernels.emplace_back(device, "rasterise", name, name, common + " -DRASTER_PASS=0");
    kernels.emplace_back(device, "rasterise", name, name, common + " -DRASTER_PASS=1");
  }
  return kernels;
}

}  // namespace

RasterisePass::RasterisePass(Device& device, bool mesh, bool grass)
    : lanes_(static_cast<std::size_t>(device.info().vector_width)),
      triangles_per_item_(triangles_per_item(device)),
      local_size_(device.info().type == "cpu" ? 16 : 64),
      clear_(device, "rasterise", "clear_visible", "clear_visible",
             "-DTRIANGLES_PER_ITEM=" + std::to_string(triangles_per_item_) +
                 (device.info().atomic64 ? "" : " -DRASTER_PASS=0")),
      clear_words_per_item_(device.info().atomic64 ? 2 : 1) {
  if (mesh) {
    cull_mesh_.emplace(device, "cull_triangles", "cull_mesh", "cull_mesh");
    rasterise_mesh_ = raster_kernels(device, "rasterise_mesh", triangles_per_item_);
  }
  if (grass) {
    cull_grass_.emplace(device, "cull_triangles", "cull_grass", "cull_grass");
    rasterise_grass_ = raster_kernels(device, "rasterise_grass", triangles_per_item_);
  }
}

void RasterisePass::run(const TriangleTables& triangles, const PosedVertices& posed, const CameraView& camera,
                        Buffer<std::uint8_t>& marks, VisibilityBuffer& visible) {
  const auto words = static_cast<std::uint32_t>(visible.words.size() / clear_words_per_item_);
  const std::uint32_t mesh_end = triangles.mesh_chunks * triangles_per_chunk;
  const std::uint32_t end = triangles.chunk_count() * triangles_per_chunk;
  clear_.launch(words, 256, visible.words, words);
  if (cull_mesh_)
    cull_mesh_->launch(mesh_end / lanes_, triangles_per_chunk / lanes_, triangles.chunks, triangles.index_a, triangles.index_b,
                       triangles.index_c, posed.x, posed.y, posed.z, camera, marks);
  if (cull_grass_)
    cull_grass_->launch((end - mesh_end) / lanes_, triangles_per_chunk / lanes_, triangles.chunks, triangles.mesh_chunks, posed.x, posed.y,
                        posed.z, camera, marks);
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
