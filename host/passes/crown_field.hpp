// kernels/crown_field.cl: `crown-field`, each plant's own visibility field baked at rest.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/crown_field.h"

namespace understory {

/// The fields of a scene's prototypes, one after another.
struct CrownFieldTables {
  Buffer<std::int32_t> owner_field;  // per row of the owner table: its row of `grids`; -1: none
  Buffer<CrownFieldGrid> grids;
  Buffer<std::uint32_t> cells;  // FIELD_WORDS per cell
};

class CrownFieldPass {
 public:
  explicit CrownFieldPass(Device& device, int lanes = 0);
  /// Reads rest_position and rest_normal of the planes. `visibility`: [0, 1], 1 without a field; sized like the planes.
  /// Adds validity code 8 to fragments outside their grid; they get the nearest cell.
  void run(const FragmentPlanes& planes, const CrownFieldTables& fields, Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
