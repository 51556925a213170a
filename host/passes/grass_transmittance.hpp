// kernels/grass_transmittance.cl: `grass-transmittance`, the light among grass by place, height and normal.
#pragma once
#include <glm/glm.hpp>

#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/grass_transmittance.h"
#include "sim/grass_layer.hpp"

namespace understory {

/// A layer on the device, at least two columns and rows.
class GrassLayerTable {
 public:
  /// `open_below`: with the light from below the horizon.
  GrassLayerTable(Device& device, const GrassLayer& layer, bool open_below);
  /// The grid as seen from `eye`, m relative to the origin.
  GrassLayerGrid grid(glm::dvec3 eye) const;
  const Buffer<float>& ground() const { return ground_; }  // of each column and of the one a row higher
  const Buffer<float>& nodes() const { return nodes_; }    // four numbers each
  const Buffer<float>& below() const { return below_; }    // four each; empty unless open_below
  bool open_below() const { return below_.size() > 0; }

 private:
  Region extent_;
  std::uint32_t columns_, rows_, levels_;
  double level_height_, datum_;
  Buffer<float> ground_, nodes_, below_;
};

class GrassTransmittancePass {
 public:
  /// `open_below`: as the tables it will run with.
  GrassTransmittancePass(Device& device, bool open_below, int lanes = 0);
  /// Fragments of every class. `visibility`: [0, 1], V_c over the open dome's factor, or V_c itself if `open_below`; 1
  /// above the grass and beside it; sized like the planes. `eye`: camera, m relative to the origin.
  void run(const FragmentPlanes& planes, const GrassLayerTable& layer, glm::dvec3 eye, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  bool open_below_;
  Kernel kernel_;
};

}  // namespace understory
