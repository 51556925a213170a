#include "host/frame/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/error.hpp"

namespace understory {
namespace {

/// Where a prototype stands in the concatenated planes.
struct PrototypeStart {
  std::uint32_t block = 0;
  std::vector<std::uint32_t> run_triangle;  // first triangle of each run, a multiple of 256
};

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& part) {
  all.insert(all.end(), part.begin(), part.end());
}

/// Buffers cannot be empty in OpenCL 1.2: a scene without meshes allocates none of these at all.
template <typename T>
Buffer<T> upload(Device& device, const std::vector<T>& data, const char* what) {
  return data.empty() ? Buffer<T>() : Buffer<T>(device, std::span<const T>(data), what);
}

std::vector<PrototypeStart> upload_prototypes(Device& device, const World& world, Geometry& geometry) {
  VertexBlocks all;
  std::vector<std::uint32_t> a, b, c;
  std::vector<PrototypeStart> starts;
  const std::vector<std::uint32_t> run_starts = first_triangles(world);
  std::size_t run_number = 0;
  for (const Prototype& prototype : world.prototypes) {
    PrototypeStart& start = starts.emplace_back();
    start.block = static_cast<std::uint32_t>(all.x.size() / vertex_block);
    const VertexBlocks& vertices = prototype.vertices;
    append(all.x, vertices.x);
    append(all.y, vertices.y);
    append(all.z, vertices.z);
    append(all.flutter_x, vertices.flutter_x);
    append(all.flutter_y, vertices.flutter_y);
    append(all.flutter_z, vertices.flutter_z);
    append(all.flutter_phase, vertices.flutter_phase);
    for (const TriangleRun& run : prototype.runs) {
      start.run_triangle.push_back(run_starts[run_number++]);
      for (std::size_t i = 3 * std::size_t{run.first}; i < 3 * (std::size_t{run.first} + run.count); i += 3) {
        a.push_back(prototype.triangles[i]);
        b.push_back(prototype.triangles[i + 1]);
        c.push_back(prototype.triangles[i + 2]);
      }
      for (std::vector<std::uint32_t>* index : {&a, &b, &c}) index->resize(run_starts[run_number], 0);  // no area
    }
  }
  geometry.rest = {upload(device, all.x, "rest vertices"),           upload(device, all.y, "rest vertices"),
                   upload(device, all.z, "rest vertices"),           upload(device, all.flutter_x, "leaf flutter"),
                   upload(device, all.flutter_y, "leaf flutter"),    upload(device, all.flutter_z, "leaf flutter"),
                   upload(device, all.flutter_phase, "leaf flutter")};
  geometry.triangles.index_a = upload(device, a, "triangle corners");
  geometry.triangles.index_b = upload(device, b, "triangle corners");
  geometry.triangles.index_c = upload(device, c, "triangle corners");
  return starts;
}

void lay_out_instances(const World& world, const std::vector<PrototypeStart>& starts, Geometry& geometry,
                       std::vector<PosedBlock>& blocks) {
  const std::vector<std::uint32_t> limb_starts = first_limbs(world);
  for (std::size_t i = 0; i < world.instances.size(); ++i) {
    const Instance& instance = world.instances[i];
    const Prototype& prototype = world.prototypes[instance.prototype];
    const PrototypeStart& start = starts[instance.prototype];
    const auto first_vertex = static_cast<std::uint32_t>(blocks.size() * vertex_block);
    for (std::size_t block = 0; block < prototype.vertices.block_limb.size(); ++block)
      blocks.push_back(
          {start.block + static_cast<std::uint32_t>(block), limb_starts[i] + prototype.vertices.block_limb[block]});
    for (std::size_t run = 0; run < prototype.runs.size(); ++run)
      for (std::uint32_t done = 0; done < prototype.runs[run].count; done += triangles_per_chunk)
        geometry.chunks.push_back({first_vertex, start.run_triangle[run] + done,
                                   std::min(triangles_per_chunk, prototype.runs[run].count - done),
                                   instance.run_owner[run]});
  }
  geometry.triangles.mesh_chunks = static_cast<std::uint32_t>(geometry.chunks.size());
  geometry.mesh_vertices = static_cast<std::uint32_t>(blocks.size() * vertex_block);
}

/// Appends one plane of a field's blades, padded to whole groups.
void append_padded(std::vector<float>& plane, const std::vector<float>& values, std::size_t padded, float filler) {
  append(plane, values);
  plane.insert(plane.end(), padded - values.size(), filler);
}

/// Five chunks of a group's triangles after another.
void list_blade_chunks(const std::vector<GrassBlades>& fields, Geometry& geometry) {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const FieldRange& range = geometry.fields[f];
    for (std::uint32_t blade = 0; blade < range.blades; blade += blades_per_group) {
      const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(blades_per_group, fields[f].size() - blade));
      const std::uint32_t group_vertex = range.first_vertex + blade * vertices_per_blade;
      for (std::uint32_t k = 0; k < triangles_per_blade; ++k)
        geometry.chunks.push_back(
            {group_vertex + k * blades_per_group, range.first_blade + blade, count, fields[f].owner});
    }
  }
  geometry.triangles.grass_chunks = static_cast<std::uint32_t>(geometry.chunks.size()) - geometry.triangles.mesh_chunks;
}

/// Ids and vertex numbers are 32-bit on the device: refuse before any of them can wrap.
void check_sizes(const World& world) {
  std::uint64_t vertices = 0, triangles = 0;
  for (const Instance& instance : world.instances) {
    const Prototype& prototype = world.prototypes[instance.prototype];
    vertices += prototype.vertices.x.size();
    triangles += prototype.triangle_count() + prototype.runs.size() * std::uint64_t{triangles_per_chunk};
  }
  for (const GrassBlades& field : world.grass) {
    vertices += (field.size() + blades_per_group) * vertices_per_blade;
    triangles += (field.size() + blades_per_group) * triangles_per_blade;
  }
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() / 2;
  if (vertices > most || triangles > most)
    throw Error(ErrorKind::invalid_input, "the scene poses " + std::to_string(vertices) + " vertices and " +
                                              std::to_string(triangles) + " triangles; at most " +
                                              std::to_string(most) + " of each are allowed");
}

}  // namespace

std::uint32_t upload_blades(Device& device, const std::vector<GrassBlades>& fields, std::uint32_t vertex,
                            RestBlades& blades, std::vector<FieldRange>& ranges) {
  GrassBlades all;
  std::vector<float> facing_x, facing_y;
  for (const GrassBlades& field : fields) {
    const std::size_t padded = (field.size() + blades_per_group - 1) / blades_per_group * blades_per_group;
    const auto first_blade = static_cast<std::uint32_t>(all.length.size());
    ranges.push_back({first_blade, static_cast<std::uint32_t>(padded), vertex});
    append_padded(all.root_x, field.root_x, padded, 0);
    append_padded(all.root_y, field.root_y, padded, 0);
    append_padded(all.root_z, field.root_z, padded, 0);
    append_padded(all.length, field.length, padded, 0);
    append_padded(all.half_width, field.half_width, padded, 0);
    append_padded(all.bend_x, field.bend_x, padded, 0);
    append_padded(all.bend_y, field.bend_y, padded, 0);
    append_padded(all.flexibility, field.flexibility, padded, 0);
    append_padded(all.phase, field.phase, padded, 0);
    for (std::size_t i = 0; i < padded; ++i) {
      const float azimuth = i < field.size() ? field.facing[i] : 0.0f;
      facing_x.push_back(std::cos(azimuth));
      facing_y.push_back(std::sin(azimuth));
    }
    vertex += static_cast<std::uint32_t>(padded * vertices_per_blade);
  }
  blades = {upload(device, all.root_x, "grass roots"),      upload(device, all.root_y, "grass roots"),
            upload(device, all.root_z, "grass roots"),      upload(device, all.length, "grass lengths"),
            upload(device, all.half_width, "grass widths"), upload(device, all.bend_x, "grass bend"),
            upload(device, all.bend_y, "grass bend"),       upload(device, facing_x, "grass facing"),
            upload(device, facing_y, "grass facing"),       upload(device, all.flexibility, "grass flexibility"),
            upload(device, all.phase, "grass phase")};
  return vertex;
}

MeshGrass upload_mesh_grass(Device& device, const World& world) {
  const auto is_blade = [](const Owner& owner) { return owner.surface == SurfaceClass::blade; };
  if (std::none_of(world.owners.begin(), world.owners.end(), is_blade)) return {};
  std::vector<float> root_z(world.owners.size(), 0.0f), height(world.owners.size(), 0.0f);
  for (const Instance& instance : world.instances)
    for (const std::uint32_t row : instance.run_owner)
      if (is_blade(world.owners[row])) {
        root_z[row] = static_cast<float>(instance.position.z);
        height[row] = static_cast<float>(instance.scale) * world.prototypes[instance.prototype].high.z;
      }
  return {Buffer<float>(device, std::span<const float>(root_z), "mesh grass roots"),
          Buffer<float>(device, std::span<const float>(height), "mesh grass heights")};
}

std::vector<std::uint32_t> first_triangles(const World& world) {
  std::vector<std::uint32_t> starts{0};
  for (const Prototype& prototype : world.prototypes)
    for (const TriangleRun& run : prototype.runs)
      starts.push_back(starts.back() +
                       (run.count + triangles_per_chunk - 1) / triangles_per_chunk * triangles_per_chunk);
  return starts;
}

std::vector<std::uint32_t> first_limbs(const World& world) {
  std::vector<std::uint32_t> starts;
  std::uint32_t limbs = 0;
  for (const Instance& instance : world.instances) {
    starts.push_back(limbs);
    limbs += static_cast<std::uint32_t>(world.prototypes[instance.prototype].limbs.size());
  }
  return starts;
}

Geometry upload_geometry(Device& device, const World& world) {
  check_sizes(world);
  Geometry geometry;
  std::vector<PosedBlock> blocks;
  lay_out_instances(world, upload_prototypes(device, world, geometry), geometry, blocks);
  geometry.blocks = upload(device, blocks, "posed blocks");
  geometry.vertices = upload_blades(device, world.grass, geometry.mesh_vertices, geometry.blades, geometry.fields);
  list_blade_chunks(world.grass, geometry);
  geometry.mesh_grass = upload_mesh_grass(device, world);
  geometry.triangles.chunks = upload(device, geometry.chunks, "triangle chunks");
  if (geometry.vertices > 0)
    geometry.posed = {Buffer<std::array<float, 4>>(device, geometry.vertices, "posed vertices")};
  return geometry;
}

}  // namespace understory
