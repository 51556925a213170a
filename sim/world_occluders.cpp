// Moving occluders of a scene: every part a stiff limb, an owner and a few spheres.
#include <fmt/format.h>

#include <algorithm>

#include "sim/error.hpp"
#include "sim/files/mesh.hpp"
#include "sim/plants/species.hpp"
#include "sim/shapes.hpp"
#include "sim/terrain.hpp"
#include "sim/walker.hpp"
#include "sim/world_builder.hpp"

namespace understory {
namespace {

std::vector<RawMesh::Part> mesh_parts(const OccluderPart& part, const std::string& key) {
  RawMesh mesh = read_mesh(part.mesh, part.up);
  std::vector<RawMesh::Part> chosen;
  std::string names;
  for (RawMesh::Part& piece : mesh.parts) {
    names += (names.empty() ? "" : ", ") + piece.name;
    if (part.mesh_object.empty() || piece.name == part.mesh_object) chosen.push_back(std::move(piece));
  }
  if (chosen.empty())
    throw Error(ErrorKind::invalid_input, fmt::format("{}.object: `{}` is not in {} (allowed: {})", key,
                                                      part.mesh_object, part.mesh.string(), names));
  for (RawMesh::Part& piece : chosen)
    for (glm::vec3& position : piece.positions) position *= glm::vec3(part.scale * part.size);
  return chosen;
}

std::vector<RawMesh::Part> pieces_of(const OccluderPart& part, const std::string& key) {
  switch (part.shape) {
    case OccluderPart::Shape::box:
      return {box_part(part.size)};
    case OccluderPart::Shape::ellipsoid:
      return {ellipsoid_part(part.size)};
    case OccluderPart::Shape::capsule:
      return {capsule_part(part.size)};
    case OccluderPart::Shape::stacked:
      return {stacked_part(part.sections)};
    case OccluderPart::Shape::mesh:
      break;
  }
  return mesh_parts(part, key);
}

std::uint32_t limb_of_triangle(const Prototype& prototype, std::uint32_t triangle) {
  return prototype.vertices.block_limb[prototype.triangles[3 * triangle] / vertex_block];
}

/// Cuts the runs where another limb begins, so that each can have an owner of its own.
void split_runs_by_limb(Prototype& prototype) {
  std::vector<TriangleRun> runs;
  for (const TriangleRun& run : prototype.runs)
    for (std::uint32_t t = run.first; t < run.first + run.count; ++t) {
      if (t == run.first || limb_of_triangle(prototype, t) != limb_of_triangle(prototype, t - 1))
        runs.push_back({run.surface, t, 0});
      ++runs.back().count;
    }
  prototype.runs = std::move(runs);
}

}  // namespace

void add_occluders(World& world, Dynamics& dynamics) {
  for (std::size_t o = 0; o < world.scene.occluders.size(); ++o) {
    OccluderSource& source = world.scene.occluders[o];
    if (source.generator == "walker")
      source = make_walker(source, [&](glm::dvec2 at) { return world.terrain ? world.terrain->height_at(at) : 0.0; });
    MotionRecord record;
    if (!source.motion_record.empty()) record = read_motion_record(source.motion_record, source.motion_up);

    Instance instance;
    instance.role = Instance::Role::occluder;
    instance.prototype = static_cast<std::uint32_t>(world.prototypes.size());
    instance.occluder = static_cast<std::int32_t>(o);
    const auto instance_index = static_cast<std::uint32_t>(world.instances.size());

    RawMesh mesh;
    std::vector<std::uint32_t> part_owner;
    for (std::uint32_t p = 0; p < source.parts.size(); ++p) {
      Owner owner;
      owner.surface = SurfaceClass::occluder;
      owner.species = source.name;
      owner.instance = static_cast<std::int32_t>(instance_index);
      owner.albedo = source.albedo;
      owner.group = next_group(world);
      part_owner.push_back(add_owner(world, owner));
      std::vector<glm::vec3> points;
      for (RawMesh::Part& piece : pieces_of(source.parts[p], fmt::format("occluders.{}.parts.{}", o, p))) {
        points.insert(points.end(), piece.positions.begin(), piece.positions.end());
        piece.name = std::to_string(p);  // one limb for each part of the occluder
        piece.surface = SurfaceClass::occluder;
        mesh.parts.push_back(std::move(piece));
      }
      for (const Sphere& sphere : cover_with_spheres(points))
        world.occluder_spheres.push_back(
            {instance_index, p, glm::vec3(sphere.centre), static_cast<float>(sphere.radius), owner.group});
    }
    Prototype prototype = rigid_prototype(source.name, mesh);
    split_runs_by_limb(prototype);
    for (const TriangleRun& run : prototype.runs)
      instance.run_owner.push_back(part_owner[limb_of_triangle(prototype, run.first)]);
    world.prototypes.push_back(std::move(prototype));
    world.instances.push_back(std::move(instance));
    dynamics.records.push_back(std::move(record));
  }
}

}  // namespace understory
