// What all distant spheres together do to the fragments of a tile, as a quadratic in the normal n (far_sphere.h):
//   V_far = exp(-E(n)),  E(n) = level + g.n + n.M n
#ifndef UNDERSTORY_TILE_OCCLUSION_H
#define UNDERSTORY_TILE_OCCLUSION_H

#include "kernels/shared/exp_minus.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
typedef std::uint32_t list_length;
#else
typedef uint list_length;
#endif

#define ALL_SPHERES 0xffffffffu  // the list was too short: every sphere must be tried as a near one, and E is 0

typedef struct {
  float level, x, y, z;          // 1; g
  float xx, yy, zz, xy, xz, yz;  // M, off-diagonal entries doubled
  list_length distant;           // spheres at least 4 radii from all fragments
  list_length close;             // at least 1.5 radii
  list_length near;              // nearer, or perhaps of a fragment's own group; or ALL_SPHERES
  list_length own;               // 1: a sphere of `near` may be of a fragment's own group
  float error;                   // bound of what E changes V by
  float padding_[1];
} TileOcclusion;                 // 64 bytes

#ifdef __OPENCL_C_VERSION__

/// V_far of W fragments with unit normals (a, b, c).
SHARED real far_visibility(const TileOcclusion tile, real a, real b, real c) {
  real e = fma((real)(tile.x), a, fma((real)(tile.y), b, fma((real)(tile.z), c, (real)(tile.level))));
  e = fma(a, fma((real)(tile.xx), a, fma((real)(tile.xy), b, (real)(tile.xz) * c)), e);
  e = fma(b, fma((real)(tile.yy), b, (real)(tile.yz) * c), e);
  e = fma((real)(tile.zz) * c, c, e);
  return exp_minus(at_least(e, REAL(0.0)));
}

#else
static_assert(sizeof(TileOcclusion) == 64);
}  // namespace understory
#endif
#endif
