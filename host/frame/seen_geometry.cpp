#include "host/frame/seen_geometry.hpp"

#include <algorithm>

#include "kernels/shared/farthest_depth.h"

namespace understory {
namespace {

template <typename T>
Buffer<T> uploaded(Device& device, const std::vector<T>& data, const char* what) {
  return data.empty() ? Buffer<T>() : Buffer<T>(device, std::span<const T>(data), what);
}

/// Writes the rows of a list from `first` on, or all of them into more memory when it must. `wait`: as
/// RawBuffer::write.
template <typename T>
void rewrite(Device& device, Buffer<T>& buffer, const std::vector<T>& rows, const char* what, std::size_t first = 0,
             bool wait = false) {
  if (buffer.size() < rows.size()) {
    buffer = Buffer<T>(device, rows.size() + rows.size() / 4, what);
    first = 0;
  }
  if (first < rows.size()) buffer.write(std::span<const T>(rows).subspan(first), wait, first);
}

/// A quarter is left for what the next frame may see more.
std::uint32_t vertices_that_fit(const Device& device) {
  const std::uint64_t vertices = device.info().max_allocation_mib * 1024 * 1024 / sizeof(std::array<float, 4>);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(vertices / 5 * 4, 0xffffffffu));
}

}  // namespace

SeenGeometry::SeenGeometry(Device& device, const World& world, bool thinned, std::uint32_t most_vertices)
    : device_(device),
      thinned_(thinned),
      layout_(lay_out_detail(world, thinned)),
      blades_(lay_out_blades(world)),
      lister_(world, layout_, blades_, thinned, std::min(most_vertices, vertices_that_fit(device))) {
  upload(layout_, world);
  if (!world.instances.empty()) pose_mesh_.emplace(device, thinned);
  if (std::any_of(world.grass.begin(), world.grass.end(), [](const GrassBlades& field) { return field.size() > 0; }))
    draw_blades_.emplace(device, device.info().atomic64);
  if (thinned && has_far_pieces(world)) draw_far_.emplace(device, device.info().atomic64);
  if (device.info().atomic64 && has_hiders(world)) farthest_depth_.emplace(device);
}

void SeenGeometry::upload(const DetailLayout& layout, const World& world) {
  const VertexBlocks& v = layout.vertices;
  geometry_.rest = {uploaded(device_, v.x, "rest vertices"),           uploaded(device_, v.y, "rest vertices"),
                    uploaded(device_, v.z, "rest vertices"),           uploaded(device_, v.flutter_x, "leaf flutter"),
                    uploaded(device_, v.flutter_y, "leaf flutter"),    uploaded(device_, v.flutter_z, "leaf flutter"),
                    uploaded(device_, v.flutter_phase, "leaf flutter")};
  geometry_.triangles.index_a = uploaded(device_, layout.a, "triangle corners");
  geometry_.triangles.index_b = uploaded(device_, layout.b, "triangle corners");
  geometry_.triangles.index_c = uploaded(device_, layout.c, "triangle corners");
  if (thinned_) {
    enlarged_.pivot_x = uploaded(device_, layout.pivot_x, "leaf middles");
    enlarged_.pivot_y = uploaded(device_, layout.pivot_y, "leaf middles");
    enlarged_.pivot_z = uploaded(device_, layout.pivot_z, "leaf middles");
  }
  upload_blades(device_, blades_.fields, 0, geometry_.blades, geometry_.fields);
  geometry_.mesh_grass = upload_mesh_grass(device_, world);
}

void SeenGeometry::begin(const Pose& pose, const CameraView& camera) {
  pose_ = &pose;
  camera_ = camera;
  limbs_there_ = blocks_there_ = chunks_there_ = 0;
  lister_.begin(pose, camera);
}

void SeenGeometry::draw_hiders(RasterisePass& rasterise, VisibilityBuffer& visible) {
  if (!farthest_depth_) return;
  list_ = &lister_.hiders();
  if (list_->mesh.chunks.empty()) return;
  pose_list();
  // Their far twigs are drawn with those of the first batch.
  rasterise.draw_mesh(0, geometry_.triangles, 0, list_->posed_chunks, geometry_.posed, camera_, visible);
  limbs_there_ = list_->limbs.size();
  blocks_there_ = list_->mesh.blocks.size();
  chunks_there_ = list_->mesh_chunks;

  const std::size_t tiles = std::size_t{farthest_tiles(static_cast<std::uint32_t>(camera_.width))} *
                            farthest_tiles(static_cast<std::uint32_t>(camera_.height));
  if (farthest_.size() != tiles) farthest_ = Buffer<float>(device_, tiles, "farthest depths");
  farthest_depth_->run(visible, camera_, farthest_);
  drawn_ = {camera_, farthest_.read()};
  if (drawn_.hides()) lister_.leave_out_behind(drawn_);
}

bool SeenGeometry::draw_next(const std::vector<SwaySeries>& series, RasterisePass& rasterise,
                             VisibilityBuffer& visible) {
  list_ = &lister_.next();
  const std::uint32_t first_chunk = chunks_there_;
  pose_list();
  limbs_there_ = blocks_there_ = chunks_there_ = 0;  // the next batch is a new list
  for (std::size_t pass = 0; pass < rasterise.raster_passes(); ++pass) {
    rasterise.draw_mesh(pass, geometry_.triangles, first_chunk, list_->posed_chunks, geometry_.posed, camera_, visible);
    if (!list_->far_units.empty())
      draw_far_->run(pass, geometry_.rest, geometry_.blocks, enlarged_.block_scale, limbs_, far_units_,
                     list_->far_units.size(), camera_, geometry_.posed, visible);
    draw_blades(pass, series, visible);
  }
  return lister_.more();
}

void SeenGeometry::draw_blades(std::size_t raster_pass, const std::vector<SwaySeries>& series,
                               VisibilityBuffer& visible) {
  for (std::size_t field = 0; field < blades_.fields.size(); ++field) {
    const std::uint32_t first = list_->first_unit[field], count = list_->first_unit[field + 1] - first;
    if (count > 0)
      draw_blades_->run(raster_pass, geometry_.blades, pose_->grass[field], series[field], blade_units_, first, count,
                        geometry_.triangles, camera_, geometry_.posed, visible);
  }
}

void SeenGeometry::write_list() {
  rewrite(device_, geometry_.blocks, list_->mesh.blocks, "posed blocks", blocks_there_);
  rewrite(device_, limbs_, list_->limbs, "limb poses", limbs_there_);
  if (thinned_) rewrite(device_, enlarged_.block_scale, list_->mesh.block_scale, "enlarged leaves", blocks_there_);
  rewrite(device_, far_units_, list_->far_units, "far pieces");
  rewrite(device_, blade_units_, list_->blade_units, "blade units");
  // The queue is in order: when this one is written, all are.
  rewrite(device_, geometry_.triangles.chunks, list_->mesh.chunks, "triangle chunks", chunks_there_, true);
  if (chunks_there_ == list_->mesh.chunks.size()) device_.finish();
}

void SeenGeometry::pose_list() {
  write_list();
  geometry_.triangles.mesh_chunks = list_->mesh_chunks;
  geometry_.triangles.grass_chunks = static_cast<std::uint32_t>(list_->mesh.chunks.size()) - list_->mesh_chunks;
  geometry_.vertices = list_->vertices;
  geometry_.mesh_vertices = static_cast<std::uint32_t>(list_->mesh.blocks.size() * vertex_block);
  std::size_t first_block = blocks_there_;
  if (geometry_.posed.points.size() < list_->vertices) {
    geometry_.posed = {Buffer<std::array<float, 4>>(device_, list_->vertices + list_->vertices / 4, "posed vertices")};
    first_block = 0;
  }
  if (first_block < list_->posed_blocks)
    pose_mesh_->run(geometry_.rest, geometry_.blocks, first_block, list_->posed_blocks, limbs_,
                    thinned_ ? &enlarged_ : nullptr, geometry_.posed);
}

const Buffer<std::array<std::uint32_t, 2>>* SeenGeometry::faces(
    const Buffer<std::array<std::uint32_t, 2>>* of_prototypes) {
  if (!of_prototypes) return nullptr;
  if (faces_.size() == 0) {
    const std::vector<std::array<std::uint32_t, 2>> all = of_prototypes->read();
    std::vector<std::array<std::uint32_t, 2>> ordered(layout_.source.size());  // no texel: of triangles without area
    for (std::size_t t = 0; t < ordered.size(); ++t)
      if (layout_.source[t] != no_source) ordered[t] = all[layout_.source[t]];
    faces_ = uploaded(device_, ordered, "baked faces");
  }
  return &faces_;
}

}  // namespace understory
