#include "host/app/scene_world.hpp"

#include "viz/exr/environment.hpp"

namespace understory {

World read_world(const Scene& scene) {
  std::shared_ptr<const EnvironmentMap> environment;  // first, since it is quickly refused
  if (!scene.environment.map.empty())
    environment = std::make_shared<const EnvironmentMap>(read_environment(scene.environment.map));
  World world = build_world(scene);
  world.environment = std::move(environment);
  return world;
}

}  // namespace understory
