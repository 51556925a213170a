// kernels/environment.cl: `environment`, ambient light of a fragment from an environment map.
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "host/opencl/kernel.hpp"
#include "host/passes/cone_planes.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "sim/environment.hpp"

namespace understory {

/// The tables of sim/environment.hpp on a device.
struct EnvironmentTables {
  EnvironmentTables(Device& device, const PrefilteredEnvironment& environment, Sky the_sky);
  Buffer<float> normals, cones;
  PrefilterSize size;
  Sky sky;
};

/// Receivers that mirror: their class bits (host/passes/ambient.hpp), and how wide a cone of the sky they mirror.
struct Gloss {
  std::uint32_t classes = 0;  // 0: none
  double half_angle = 0;      // radians, (0, pi/2]
  glm::vec3 eye{0};           // where the camera is in the planes' coordinates, m
};

class EnvironmentPass {
 public:
  explicit EnvironmentPass(Device& device, int lanes = 0);
  /// Red, green, blue of the light that arrives, in the map's unit of radiance: what a white surface would reflect.
  /// `visibility`: V of all terms. `cones`: null when nothing is occluded by cones: the open sky's light times V.
  /// 0 where validity says background or not finite.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const Buffer<float>& visibility,
           const ConePlanes* cones, const EnvironmentTables& tables, const Gloss& gloss,
           std::array<Buffer<float>, 3>& light);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
