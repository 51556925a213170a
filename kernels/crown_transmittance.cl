// Visibility in crowns of even foliage (shared/crown_transmittance.h). Each fragment finds its crown through its owner,
// a crown is shells[first[crown]] up to shells[first[crown + 1]]; fragments without a crown get 1. With several shells
// the visibilities multiply: light passes all of them. Under SKY_DOME V holds the horizon, once.
// One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/crown_transmittance.h"
#include "kernels/shared/fetch_ahead.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/validity.h"

/// V of one shell, of `open` light. `out`: lanes outside it.
SHARED real shell_visibility(global const TransmittanceShell* shell, Direction position, Direction normal, real open,
                             PRIVATE truth* out) {
  const Direction offset = {position.x - shell->x, position.y - shell->y, position.z - shell->z};
  ShellPlace place;
  if (shell->sphere > 0)
    place = place_in_sphere(offset, normal, shell->sphere);
  else
    place = place_in_shell(offset, normal, shell->to_unit, shell->radius);
#ifdef SKY_DOME
  real v = transmittance_under_dome(place, normal.z, shell->optical, shell->bend, shell->within);
#else
  real v = transmittance_within(place, shell->optical, shell->bend, shell->within);
#endif
  v = at_least(v, REAL(0.0));
  *out = place.square > REAL(1.00001);  // a little is rounding, not outside
  const truth beyond = place.square > REAL(1.0);
  if (ANY(beyond)) {
#ifdef SKY_DOME
    const real blocked = blocked_under_dome(place, normal.z, open, shell->opacity, shell->within, shell->outside);
#else
    const real blocked = blocked_outside(place, shell->opacity, shell->outside);
#endif
    v = PICK(beyond, at_least(open - blocked, REAL(0.0)), v);
  }
  return v;
}

/// V of the lanes of one crown, `shells` up to `end`. `outside`: those beyond all of them.
static inline real shade(global const TransmittanceShell* shells, global const TransmittanceShell* end,
                         Direction position, Direction normal, PRIVATE truth* outside) {
#ifdef SKY_DOME
  const real open = open_dome(normal.z);
#else
  const real open = REAL(1.0);
#endif
  *outside = ALL_LANES;
  real product = open;
  for (global const TransmittanceShell* shell = shells; shell < end; ++shell) {
    truth out_of_this;
    const real through = shell_visibility(shell, position, normal, open, &out_of_this);
    *outside &= out_of_this;
    product = shell == shells ? through : product * (through / at_least(open, REAL(1e-6)));
  }
  if (shells < end) product *= (real)(shells->near_share);
  return as_visibility(product);
}

kernel void shade_crown_transmittance(global const float* position_x, global const float* position_y,
                                      global const float* position_z, global const float* normal_x,
                                      global const float* normal_y, global const float* normal_z,
                                      global const uint* owner, global const int* owner_crown, uint owners,
                                      global const uint* first, uint crown_count,
                                      global const TransmittanceShell* shells, uint shell_count, uint items,
                                      global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  fetch_planes(position_x, position_y, position_z, i);
  fetch_planes(normal_x, normal_y, normal_z, i);
  fetch_plane(owner, i);
  const bits rows = owner_row(LOAD(owner, i), owners);
  const Direction position = {LOAD(position_x, i), LOAD(position_y, i), LOAD(position_z, i)};
  const Direction normal = {LOAD(normal_x, i), LOAD(normal_y, i), LOAD(normal_z, i)};
  const whole crowns_here = signed_owner_column(owner_crown, rows);
  const int one_owner = ONE_OWNER(rows);
  real v = REAL(1.0);
  truth outside = (truth)(0);
  // One place that calls `shade`: with two, compilers call it through memory, which takes as long as the model itself.
  for (truth left = (crowns_here >= 0) & (crowns_here < (whole)((int)crown_count)); ANY(left);) {
    const uint crown = one_owner ? (uint)FIRST_LANE(crowns_here) : next_owner(TO_BITS(crowns_here), left);
    const truth lanes = left & (crowns_here == (whole)((int)crown));
    left &= NOT(lanes);
    truth out;
    const uint end = min(first[crown + 1], shell_count);
    const real through = shade(shells + first[crown], shells + end, position, normal, &out);
    v = PICK(lanes, through, v);
    outside |= lanes & out;
  }
  STORE(v, visibility, i);
  if (ANY(outside)) add_validity(validity, i, outside, VALIDITY_OUTSIDE_MODEL);
}
