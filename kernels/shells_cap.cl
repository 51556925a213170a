// Visibility of foliage inside the nearest of its crown's clustered spheres (Hegeman et al. 2006, section 5): the sphere
// with the closest centre owns the fragment, eq. 4-6 as in shared/sphere_cap.h. Crown i is
// shells[first[i]] up to shells[first[i + 1]]: the sphere around all of it, then the clustered ones. LEVELS: the levels
// multiply, the whole crown's visibility times that of the nearest sphere (the hierarchy that section 5 looks out to).
// Fragments without a crown get 1. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/sphere_cap.h"
#include "kernels/shared/validity.h"

kernel void shade_shells_cap(global const float* position_x, global const float* position_y,
                             global const float* position_z, global const float* normal_x, global const float* normal_y,
                             global const float* normal_z, global const uint* owner, global const int* owner_crown,
                             uint owners, global const uint* first, uint crown_count, global const CrownRecord* shells,
                             uint shell_count, uint items, global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  fetch_planes(position_x, position_y, position_z, i);
  fetch_planes(normal_x, normal_y, normal_z, i);
  fetch_plane(owner, i);
  const whole crowns_here = signed_owner_column(owner_crown, owner_row(LOAD(owner, i), owners));
  real v = REAL(1.0);
  truth outside = (truth)(0);
  for (truth left = (crowns_here >= 0) & (crowns_here < (whole)((int)crown_count)); ANY(left);) {
    const uint crown = next_owner(TO_BITS(crowns_here), left);
    const truth lanes = left & (crowns_here == (whole)((int)crown));
    left &= NOT(lanes);
    const uint begin = first[crown], end = min(first[crown + 1], shell_count);
    if (begin >= end) continue;
    const real x = LOAD(position_x, i), y = LOAD(position_y, i), z = LOAD(position_z, i);
    const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
    global const CrownRecord* whole_crown = shells + begin;
    // Of a crown without clusters the only sphere owns all.
    real px = x - whole_crown->x, py = y - whole_crown->y, pz = z - whole_crown->z;
    real radius = (real)(whole_crown->radius), alpha_rho = (real)(whole_crown->alpha_rho);
    real of_crown = REAL(1.0);
#ifdef LEVELS
    if (end - begin > 1) of_crown = sphere_cap(px, py, pz, a, b, c, radius, alpha_rho);
#endif
    real least = REAL(3e38);
    for (uint j = begin + 1; j < end; ++j) {
      global const CrownRecord* shell = shells + j;
      const real sx = x - shell->x, sy = y - shell->y, sz = z - shell->z;
      const real square = fma(sx, sx, fma(sy, sy, sz * sz));
      const truth nearer = square < least;
      least = PICK(nearer, square, least);
      px = PICK(nearer, sx, px);
      py = PICK(nearer, sy, py);
      pz = PICK(nearer, sz, pz);
      radius = PICK(nearer, (real)(shell->radius), radius);
      alpha_rho = PICK(nearer, (real)(shell->alpha_rho), alpha_rho);
    }
    v = PICK(lanes, of_crown * sphere_cap(px, py, pz, a, b, c, radius, alpha_rho), v);
    outside |= lanes & outside_sphere(px, py, pz, radius);
  }
  STORE(v, visibility, i);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
