// The environment's light of a frame: tables uploaded once, the pass, and its three planes.
#pragma once
#include <array>

#include "host/passes/environment.hpp"
#include "sim/world.hpp"

namespace understory {

class EnvironmentLight {
 public:
  /// `world.environment` is there. Prefilters it.
  EnvironmentLight(Device& device, const World& world, std::size_t padded_fragments);
  /// `eye`: the camera in the planes' coordinates, m; `cones`: see EnvironmentPass.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<float>& visibility,
           const ConePlanes* cones, glm::vec3 eye);
  const std::array<Buffer<float>, 3>& planes() const { return light_; }
  /// Mean radiance over the sky that a level surface faces.
  glm::vec3 mean() const { return mean_; }

 private:
  EnvironmentLight(Device& device, const World& world, std::size_t padded_fragments,
                   const PrefilteredEnvironment& prefiltered);

  glm::vec3 mean_;
  Gloss gloss_;
  EnvironmentTables tables_;
  EnvironmentPass pass_;
  std::array<Buffer<float>, 3> light_;
};

}  // namespace understory
