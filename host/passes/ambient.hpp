// kernels/ambient.cl: `ambient`, one constant for plants, and the mean visibility of the ground under grass for
// terrain.
#pragma once
#include <glm/glm.hpp>

#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/ground_cover.h"

namespace understory {

/// The bit of a class in a set of classes.
constexpr std::uint32_t class_bit(SurfaceClass surface) { return 1u << static_cast<std::uint32_t>(surface); }

/// Ground visibility under grass on the device; without grass a grid of no cells.
class GroundCoverTable {
 public:
  GroundCoverTable(Device& device, const GroundCover& cover);
  /// The grid as seen from `eye`, m relative to the origin.
  GroundCoverGrid grid(glm::dvec3 eye) const;
  const Buffer<float>& visibility() const { return visibility_; }

 private:
  Region extent_;
  std::uint32_t columns_, rows_;
  Buffer<float> visibility_;
};

class AmbientPass {
 public:
  explicit AmbientPass(Device& device, int lanes = 0);
  /// Fragments of the classes in `constant_classes` (class_bit) get `constant`; terrain within the grid its ground
  /// visibility; all others 1. `eye`: camera, m relative to the origin. `visibility`: sized like the planes.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, double constant, std::uint32_t constant_classes,
           const GroundCoverTable& cover, glm::dvec3 eye, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
