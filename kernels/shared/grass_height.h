// Hegeman et al. 2006 eq. 9: V = Pz/(2h) (1 + cos t), Pz the height above the root, h the grass' total height, t the
// angle between normal and up. This is Pz/h alone: (1 + cos t)/2 is the open-dome factor of V_c, and the dome brings it.
#ifndef UNDERSTORY_GRASS_HEIGHT_H
#define UNDERSTORY_GRASS_HEIGHT_H

#include "kernels/shared/limits.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// `height`: above the root, m; `total`: of the grass, m. Grass of no height covers nothing: 1.
SHARED real grass_height(real height, real total) {
  return as_visibility(PICK(total > REAL(0.0), height / total, REAL(1.0)));
}

#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
