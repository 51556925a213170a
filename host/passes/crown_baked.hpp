// kernels/crown_baked.cl: `crown-baked`, visibility traced once on the faces of each plant at rest.
#pragma once
#include <array>

#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"

namespace understory {

/// Texels of a scene's prototypes; layout in kernels/shared/crown_baked.h.
struct CrownBakedTables {
  Buffer<std::array<std::uint32_t, 2>> faces;  // per entry of TriangleTables::index_a; resolve reads it
  Buffer<std::uint32_t> texels;
};

class CrownBakedPass {
 public:
  explicit CrownBakedPass(Device& device, int lanes = 0);
  /// Reads texel and texel_place of the planes. `visibility`: [0, 1], 1 without a texel; sized like the planes.
  void run(const FragmentPlanes& planes, const Buffer<std::uint32_t>& texels, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
