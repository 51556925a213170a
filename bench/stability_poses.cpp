// The stability of posing: plants and grass at times and in winds far from the usual, vertex by vertex beside the same
// poses in double.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/stability_case.hpp"
#include "host/frame/geometry.hpp"
#include "host/passes/pose_grass.hpp"
#include "host/passes/pose_mesh.hpp"
#include "sim/grass_wind.hpp"
#include "sim/pose.hpp"
#include "tests/reference/pose_grass.hpp"
#include "tests/reference/pose_mesh.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

constexpr glm::dvec3 eye(-12, -5, 2);
constexpr int blade_vertices = 7;

using PoseErrors = std::function<std::vector<float>(Device&, const World&, double time)>;

/// Distance of a posed vertex from where it should be, m, as a share of what its distance from the eye (at least 1 m)
/// is: what a float of that distance can hold. 1 where it is no number.
float error_of(const std::array<float, 4>& posed, glm::dvec3 expected) {
  const double distance = glm::distance(glm::dvec3(posed[0], posed[1], posed[2]), expected);
  return static_cast<float>(std::isfinite(distance) ? std::min(distance / std::max(glm::length(expected), 1.0), 1.0)
                                                    : 1.0);
}

std::vector<float> mesh_errors(Device& device, const World& world, double time) {
  Geometry geometry = upload_geometry(device, world);
  const Pose pose = pose_at(world, time, eye);
  const Buffer<LimbPose> limbs(device, std::span<const LimbPose>(pose.limbs), "limbs");
  PoseMeshPass(device).run(geometry.rest, geometry.blocks, limbs, geometry.posed);
  const auto posed = geometry.posed.points.read();
  std::vector<float> errors;
  for (std::size_t i = 0; i < world.instances.size(); ++i) {
    const Prototype& prototype = world.prototypes[world.instances[i].prototype];
    for (std::size_t v = 0; v < prototype.vertices.x.size(); ++v)
      errors.push_back(error_of(posed[errors.size()], reference::posed_vertex(prototype, pose, pose.first_limb[i], v)));
  }
  return errors;
}

std::vector<float> grass_errors(Device& device, const World& world, double time) {
  Geometry geometry = upload_geometry(device, world);
  const Wind wind(world.scene.wind, world.scene.seed);
  PoseGrassPass pass(device);
  std::vector<float> errors;
  for (std::size_t field = 0; field < world.grass.size(); ++field) {
    const ModalSeries response = grass_response(wind, world.scene.grass[field]);
    const GrassWind at = grass_wind_at(wind, world.scene.grass[field], response, time, eye);
    std::vector<std::array<float, 2>> pairs;
    for (const glm::vec2 pair : interleaved(response)) pairs.push_back({pair.x, pair.y});
    const SwaySeries series(device, std::span<const std::array<float, 2>>(pairs), "sway");
    const FieldRange& range = geometry.fields[field];
    pass.run(geometry.blades, at, series, range.first_blade, range.blades, range.first_vertex, geometry.posed);
    const auto posed = geometry.posed.points.read();
    const GrassBlades& b = world.grass[field];
    for (std::size_t i = 0; i < b.size(); ++i) {
      const glm::dvec2 bend = grass_bend(
          at, response, {{b.root_x[i], b.root_y[i]}, {b.bend_x[i], b.bend_y[i]}, b.flexibility[i], b.phase[i]});
      const auto blade = reference::posed_blade(glm::dvec3(b.root_x[i], b.root_y[i], b.root_z[i]) - eye, b.length[i],
                                                b.half_width[i], b.facing[i], bend);
      for (std::size_t k = 0; k < blade_vertices; ++k)
        errors.push_back(error_of(posed[range.first_vertex + i / blades_per_group * blade_vertices * blades_per_group +
                                        k * blades_per_group + i % blades_per_group],
                                  blade[k]));
    }
  }
  return errors;
}

}  // namespace

std::vector<StabilityCase> pose_stability() {
  struct Kind {
    const char* kernel;
    PoseErrors errors;
  };
  const Kind kinds[] = {{"pose-mesh", mesh_errors}, {"pose-grass", grass_errors}};
  struct Weather {
    const char* name;
    double time, speed;  // s, m/s
  };
  constexpr Weather weathers[] = {{"in a breeze", 3.7, 5}, {"at 0 s", 0, 5},     {"at -5 s", -5, 5},
                                  {"at 1e9 s", 1e9, 5},    {"in no wind", 1, 0}, {"in a hurricane", 1, 60}};
  std::vector<StabilityCase> all;
  for (const Kind& kind : kinds)
    for (const Weather& weather : weathers) {
      Scene scene = small_meadow();
      scene.wind.speed = weather.speed;
      const auto world = std::make_shared<const World>(build_world(scene));
      StabilityCase one;
      one.kernel = kind.kernel;
      one.name = weather.name;
      one.extreme = &weather != &weathers[0];
      one.shade = [=, errors = kind.errors, time = weather.time](Device& device) {
        Shaded shaded{errors(device, *world, time), {}};
        shaded.validity.resize(shaded.visibility.size());
        return shaded;
      };
      one.exact = [](std::size_t) { return 0.0; };
      all.push_back(std::move(one));
    }
  return all;
}

}  // namespace understory
