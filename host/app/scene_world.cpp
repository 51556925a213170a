#include "host/app/scene_world.hpp"

#include <spdlog/spdlog.h>

#include "host/trace/calibrated_world.hpp"
#include "viz/exr/environment.hpp"

namespace understory {

World read_world(const Scene& scene, bool all_methods) {
  std::shared_ptr<const EnvironmentMap> environment;  // first, since it is quickly refused
  if (!scene.environment.map.empty())
    environment = std::make_shared<const EnvironmentMap>(read_environment(scene.environment.map));
  World world = build_world(scene);
  world.environment = std::move(environment);
  if (all_methods || reads_calibration(scene.methods))
    for (const std::string& species : calibrate_world(world))
      spdlog::info("calibrated species {}; kept for later runs", species);
  return world;
}

}  // namespace understory
