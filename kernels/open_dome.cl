// The open-dome factor of V_c from the normal alone (shared/open_dome.h). One work-item per W fragments; planes are
// padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/open_dome.h"

kernel void shade_open_dome(global const float* normal_z, uint items, global float* visibility) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  STORE(open_dome(LOAD(normal_z, i)), visibility, i);
}
