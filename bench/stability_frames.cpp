// The stability of whole frames: posing, wind and drawing at times and cameras far from the usual.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/stability_case.hpp"
#include "host/frame/runner.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

Scene meadow() {
  Scene scene = small_meadow();
  scene.image = {80, 50};
  scene.camera.position = {-4.5, -7.5, 1.6};
  scene.camera.target = {-7, 2, 1.5};
  scene.camera.vertical_fov = 1;
  return scene;
}

/// Level ground from far away to right before the camera.
Scene wide_ground() {
  Scene scene;
  scene.image = {80, 50};
  scene.terrain.extent = {glm::dvec2(-1e7), glm::dvec2(1e7)};
  scene.camera.position = {1, -6, 1.7};
  scene.camera.target = {0, 0, 1.2};
  return scene;
}

Frame frame_at(Device& device, const World& world, double time) { return FrameRunner(device, world).render(0, time); }

/// V of a frame; NaN also where a position or normal is none.
Shaded shaded_frame(const Frame& frame) {
  Shaded shaded{frame.visibility, frame.validity};
  for (std::size_t i = 0; i < frame.pixels(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!std::isfinite(frame.position[axis][i]) || !std::isfinite(frame.normal[axis][i])) shaded.visibility[i] = NAN;
  return shaded;
}

StabilityCase scene_case(const std::string& kernel, const std::string& name, const Scene& scene,
                         const std::function<Shaded(Device&, const World&)>& shade) {
  StabilityCase one;
  one.kernel = kernel;
  one.name = name;
  const auto world = std::make_shared<const World>(build_world(scene));
  one.shade = [world, shade](Device& device) { return shade(device, *world); };
  return one;
}

/// How far vertices go within a millisecond, m; 1 where one is no number.
std::vector<float> steps_of(Device& device, const World& world, double time) {
  FrameRunner runner(device, world);
  runner.render(0, time);
  const std::vector<float> before = runner.posed_geometry().positions;
  runner.render(0, time + 1e-3);
  const std::vector<float> after = runner.posed_geometry().positions;
  std::vector<float> steps;
  for (std::size_t i = 0; i + 2 < before.size(); i += 3) {
    const glm::vec3 step(after[i] - before[i], after[i + 1] - before[i + 1], after[i + 2] - before[i + 2]);
    steps.push_back(std::isfinite(glm::dot(step, step)) ? glm::length(step) : 1);
  }
  return steps;
}

}  // namespace

std::vector<StabilityCase> frame_stability() {
  std::vector<StabilityCase> all;
  for (const double time : {0.0, -5.0, 1e9}) {
    all.push_back(
        scene_case("frame", "wind and bodies at " + text(time) + " s", meadow(),
                   [time](Device& device, const World& world) { return shaded_frame(frame_at(device, world, time)); }));
    all.push_back(scene_case("pose", "way in a millisecond at " + text(time) + " s, m", meadow(),
                             [time](Device& device, const World& world) {
                               const std::vector<float> steps = steps_of(device, world, time);
                               return Shaded{steps, std::vector<std::uint32_t>(steps.size())};
                             }));
    all.back().exact = [](std::size_t) { return 0.0; };
    all.back().stated_error = 0.05;
    all.back().note = "bodies and blades move: at most 50 m/s";
  }
  for (const double degrees : {1.0, 60.0, 170.0})
    for (const double near : {1e-4, 0.05}) {
      Scene scene = wide_ground();
      scene.camera.vertical_fov = degrees * 3.141592653589793 / 180;
      scene.camera.near_plane = near;
      const std::string name = "field of view " + text(degrees) + " degrees, near " + text(near) + " m, far 1e7 m";
      // Values are heights over the level ground by the distance: 0, and 0 where there is no ground.
      const glm::dvec3 eye = scene.camera.position;
      all.push_back(scene_case("draw", name, scene, [eye](Device& device, const World& world) {
        const Frame frame = frame_at(device, world, 0);
        Shaded shaded = shaded_frame(frame);
        for (std::size_t i = 0; i < frame.pixels(); ++i) {
          if (std::isnan(shaded.visibility[i])) continue;
          const glm::dvec3 p(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
          shaded.visibility[i] =
              frame.owner[i] == 0 ? 0 : static_cast<float>(std::abs(p.z) / std::max(glm::distance(p, eye), 1e-3));
        }
        return shaded;
      }));
      all.back().exact = [](std::size_t) { return 0.0; };
    }
  Scene far = meadow();
  for (const double degrees : {1.0, 170.0}) {
    far.camera.vertical_fov = degrees * 3.141592653589793 / 180;
    all.push_back(
        scene_case("frame", "field of view " + text(degrees) + " degrees", far,
                   [](Device& device, const World& world) { return shaded_frame(frame_at(device, world, 1)); }));
  }
  return all;
}

}  // namespace understory
