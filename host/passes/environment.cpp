#include "host/passes/environment.hpp"

#include <cmath>

namespace understory {
namespace {

Buffer<float> upload(Device& device, const std::vector<float>& values, const char* what) {
  return Buffer<float>(device, std::span<const float>(values), what);
}

void require_size_of(const char* what, std::size_t size, std::size_t nodes, std::size_t levels) {
  require_size("environment", what, size, 4 * nodes * nodes * levels);
}

}  // namespace

EnvironmentTables::EnvironmentTables(Device& device, const PrefilteredEnvironment& environment, Sky the_sky)
    : normals(upload(device, environment.normals, "light on normals")),
      cones(upload(device, environment.cones, "light in cones")),
      size(environment.size),
      sky(the_sky) {}

EnvironmentPass::EnvironmentPass(Device& device, int lanes)
    : lanes_(device, lanes, "environment"),
      kernel_(device, "environment", "light_from_environment", "environment", lanes_.option()) {}

void EnvironmentPass::run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<float>& visibility,
                          const ConePlanes* cones, const EnvironmentTables& tables, const Gloss& gloss,
                          std::array<Buffer<float>, 3>& light) {
  require_planes("environment", planes, visibility);
  for (const Buffer<float>& channel : light)
    require_size("environment", "light", channel.size(), planes.padded_fragments);
  // Planes that are not read take the place of missing cones.
  const Buffer<float>& none = visibility;
  const Buffer<float>* order[] = {cones ? &cones->axis_x : &none, cones ? &cones->axis_y : &none,
                                  cones ? &cones->axis_z : &none, cones ? &cones->aperture : &none,
                                  cones ? &cones->share : &none};
  for (const Buffer<float>* plane : order) require_size("environment", "cone", plane->size(), planes.padded_fragments);
  require_size_of("light on normals", tables.normals.size(), tables.size.normal_nodes, 1);
  require_size_of("light in cones", tables.cones.size(), tables.size.cone_nodes, tables.size.cone_levels);
  const std::uint32_t items = lanes_.items(planes);
  const auto aperture = static_cast<float>((1 - std::cos(gloss.half_angle)) / 2);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                 planes.normal_y, planes.normal_z, planes.owner, owners.surface_class, owners.rows(), planes.validity,
                 visibility, std::uint32_t{cones != nullptr}, *order[0], *order[1], *order[2], *order[3], *order[4],
                 gloss.eye.x, gloss.eye.y, gloss.eye.z, gloss.classes, aperture, std::uint32_t{tables.sky == Sky::dome},
                 tables.normals, tables.size.normal_nodes, tables.cones, tables.size.cone_nodes,
                 tables.size.cone_levels, items, light[0], light[1], light[2]);
}

}  // namespace understory
