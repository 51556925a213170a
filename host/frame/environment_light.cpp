#include "host/frame/environment_light.hpp"

#include "host/passes/ambient.hpp"

namespace understory {

EnvironmentLight::EnvironmentLight(Device& device, const World& world, std::size_t padded_fragments)
    : EnvironmentLight(device, world, padded_fragments,
                       prefilter(*world.environment, world.scene.environment.turn, world.scene.sky)) {}

EnvironmentLight::EnvironmentLight(Device& device, const World& world, std::size_t padded_fragments,
                                   const PrefilteredEnvironment& prefiltered)
    : mean_(prefiltered.mean),
      tables_(device, prefiltered, world.scene.sky),
      pass_(device),
      light_{Buffer<float>(device, padded_fragments, "red light"),
             Buffer<float>(device, padded_fragments, "green light"),
             Buffer<float>(device, padded_fragments, "blue light")} {
  if (world.scene.environment.gloss > 0)
    gloss_ = {class_bit(SurfaceClass::occluder), world.scene.environment.gloss, glm::vec3(0)};
}

void EnvironmentLight::run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<float>& visibility,
                           const ConePlanes* cones, glm::vec3 eye) {
  gloss_.eye = eye;
  pass_.run(planes, owners, visibility, cones, tables_, gloss_, light_);
}

}  // namespace understory
