#include "host/frame/occluder_grids.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

#include "host/trace/grid_cache.hpp"
#include "host/trace/own_shadow_bake.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

/// Triangles of one limb of a prototype, each vertex once.
struct LimbMesh {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;
  std::int32_t group = -1;
  bool operator==(const LimbMesh& other) const { return vertices == other.vertices && triangles == other.triangles; }
};

std::vector<LimbMesh> limb_meshes(const World& world, const Instance& instance) {
  const Prototype& prototype = world.prototypes[instance.prototype];
  const VertexBlocks& source = prototype.vertices;
  constexpr std::uint32_t unused = ~0u;
  std::vector<std::uint32_t> place(source.x.size(), unused);
  std::vector<LimbMesh> meshes(prototype.limbs.size());
  for (std::size_t run = 0; run < prototype.runs.size(); ++run) {
    const TriangleRun& triangles = prototype.runs[run];
    for (std::uint32_t i = 3 * triangles.first; i < 3 * (triangles.first + triangles.count); ++i) {
      const std::uint32_t vertex = prototype.triangles[i];
      LimbMesh& mesh = meshes[source.block_limb[vertex / vertex_block]];
      mesh.group = world.owners[instance.run_owner[run]].group;
      if (place[vertex] == unused) {
        place[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.emplace_back(source.x[vertex], source.y[vertex], source.z[vertex]);
      }
      mesh.triangles.push_back(place[vertex]);
    }
  }
  return meshes;
}

GridSettings settings_of(const Methods& methods, bool cone) {
  GridSettings settings;
  settings.size.fill(static_cast<std::uint32_t>(methods.grid.size));
  settings.epsilon = methods.grid.epsilon;
  settings.stretch = methods.grid.stretch;
  settings.rays = static_cast<std::uint32_t>(methods.grid.rays);
  settings.cone = cone;
  return settings;
}

/// Where equal meshes' grids are: `grid[i]` is the index, in `different`, of the mesh like meshes[i].
struct DifferentMeshes {
  std::vector<const LimbMesh*> different;
  std::vector<std::size_t> grid;
};

DifferentMeshes find_different(const std::vector<LimbMesh>& meshes) {
  DifferentMeshes found;
  std::multimap<std::size_t, std::size_t> by_size;  // triangles' indices -> index in `different`
  for (const LimbMesh& mesh : meshes) {
    const auto [first, last] = by_size.equal_range(mesh.triangles.size());
    const auto same =
        std::find_if(first, last, [&](const auto& entry) { return *found.different[entry.second] == mesh; });
    if (same != last) {
      found.grid.push_back(same->second);
      continue;
    }
    found.grid.push_back(found.different.size());
    by_size.emplace(mesh.triangles.size(), found.different.size());
    found.different.push_back(&mesh);
  }
  return found;
}

/// to_scene after to_limb of a stiff limb: rest point of the prototype to camera-relative metres.
glm::dmat4x3 placement(const LimbPose& pose) {
  const auto matrix = [](const float(&m)[12]) {
    glm::dmat4 full(1);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) full[column][row] = double(m[4 * row + column]);
    return full;
  };
  return glm::dmat4x3(matrix(pose.to_scene) * matrix(pose.to_limb));
}

}  // namespace

bool is_grid_method(const std::string& method) {
  return method == "grid" || method == "grid-self-paper" || method == "grid-cone" || method == "grid-cone-paper";
}

OccluderGrids::OccluderGrids(Device& device, const World& world, const Methods& methods, std::size_t cone_fragments) {
  const bool cone = methods.occluders.starts_with("grid-cone");
  std::vector<LimbMesh> meshes;
  for (std::size_t i = 0; i < world.instances.size(); ++i) {
    if (world.instances[i].role != Instance::Role::occluder) continue;
    std::vector<LimbMesh> limbs = limb_meshes(world, world.instances[i]);
    for (std::size_t limb = 0; limb < limbs.size(); ++limb) {
      if (limbs[limb].triangles.empty()) continue;
      Part part;
      part.instance = i;
      part.limb = limb;
      part.record.group = limbs[limb].group;
      parts_.push_back(part);
      meshes.push_back(std::move(limbs[limb]));
    }
  }
  const DifferentMeshes found = find_different(meshes);
  const GridSettings settings = settings_of(methods, cone);
  std::vector<OcclusionGrid> grids(found.different.size());
  std::vector<OwnShadow> own(found.different.size());
  tbb::parallel_for(std::size_t(0), grids.size(), [&](std::size_t g) {
    const LimbMesh& mesh = *found.different[g];
    grids[g] = cached_grid(mesh.vertices, mesh.triangles, settings);
    if (methods.occluders == "grid-cone")  // other methods have the paper's rules for a body's own surface
      own[g] = cached_own_shadow(mesh.vertices, mesh.triangles, std::max(settings.rays / 4, 16u), settings.seed);
  });
  std::vector<std::uint8_t> samples;
  std::vector<std::uint32_t> first;
  for (const OcclusionGrid& grid : grids) {
    first.push_back(static_cast<std::uint32_t>(samples.size() / (cone ? 4 : 1)));
    const std::vector<std::uint8_t> packed = cone ? packed_cone(grid) : packed_share(grid);
    samples.insert(samples.end(), packed.begin(), packed.end());
  }
  std::vector<std::uint32_t> first_own;
  for (const OwnShadow& shadow : own) {
    first_own.push_back(static_cast<std::uint32_t>(samples.size() / 4));
    const std::vector<std::uint8_t> packed = packed_own_shadow(shadow);
    samples.insert(samples.end(), packed.begin(), packed.end());
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const OcclusionGrid& grid = grids[found.grid[p]];
    Part& part = parts_[p];
    part.middle = 0.5f * (grid.low + grid.high);
    part.half = 0.5f * (grid.high - grid.low);
    part.record.first = first[found.grid[p]];
    part.record.width = grid.size[0];
    part.record.height = grid.size[1];
    part.record.depth = grid.size[2];
    part.record.border = grid.border;
    part.record.stretch = grid.stretch;
    part.record.faded_from = faded_from(grid);
    const OwnShadow& shadow = own[found.grid[p]];
    part.record.own_first = first_own[found.grid[p]];
    part.record.own_size = shadow.size;
    for (int axis = 0; shadow.size > 0 && axis < 3; ++axis)
      part.record.own_scale[axis] = (grid.high[axis] - grid.low[axis]) / (shadow.high[axis] - shadow.low[axis]);
  }
  table_ = std::make_unique<GridTable>(device, samples);
  if (cone && cone_fragments > 0) cones_ = std::make_unique<ConePlanes>(allocate_cones(device, cone_fragments));
  if (cone)
    cone_ = std::make_unique<GridConePass>(device, methods.occluders, methods.combine, 0, cones_ != nullptr);
  else
    scalar_ = std::make_unique<GridPass>(device, methods.occluders);
}

std::vector<GridRecord> OccluderGrids::records_at(const Pose& pose) const {
  std::vector<GridRecord> records;
  for (const Part& part : parts_) {
    const glm::dmat4x3 to_scene = placement(pose.limbs[pose.first_limb[part.instance] + part.limb]);
    const glm::dmat3 linear(to_scene), to_part = glm::inverse(linear);
    const double scale = std::cbrt(std::abs(glm::determinant(linear)));
    GridRecord record = part.record;
    for (int row = 0; row < 3; ++row) {
      const double per_metre = 1 / double(part.half[row]);
      double constant = -double(part.middle[row]);
      for (int axis = 0; axis < 3; ++axis) {
        record.to_box[4 * row + axis] = static_cast<float>(per_metre * to_part[axis][row]);
        record.axes[4 * row + axis] = static_cast<float>(linear[axis][row] / scale);
        constant -= to_part[axis][row] * to_scene[3][axis];
      }
      record.to_box[4 * row + 3] = static_cast<float>(per_metre * constant);
    }
    records.push_back(record);
  }
  return records;
}

void OccluderGrids::run(const Pose& pose, const FragmentPlanes& planes, const OwnerTables& owners,
                        Buffer<float>& visibility) {
  table_->place(records_at(pose));
  if (cone_)
    cone_->run(planes, owners, *table_, visibility, cones_.get());
  else
    scalar_->run(planes, owners, *table_, visibility);
}

}  // namespace understory
