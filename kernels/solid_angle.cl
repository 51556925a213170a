// How spheres (crowns of other plants, pieces of moving occluders) shade fragments: the product of 1 - opacity times
// the blocked share over the spheres listed for the fragment's tile, times the tile's far occlusion (tile_spheres.cl).
// -DSHARE=unit_solid_angle, unit_solid_angle_exact or unit_solid_angle_cosine chooses the share. A fragment is not
// shaded by spheres of its own group. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fragment_tiles.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/shading_sphere.h"
#include "kernels/shared/solid_angle.h"
#include "kernels/shared/tile_occlusion.h"
#include "kernels/shared/validity.h"

kernel void shade_by_spheres(global const float* position_x, global const float* position_y,
                             global const float* position_z, global const float* normal_x, global const float* normal_y,
                             global const float* normal_z, global const uint* owner, global const int* owner_group,
                             uint owners, global const ShadingSphere* spheres, uint sphere_count,
                             global const TileOcclusion* tiles, global const uint* lists, uint slots, uint row_length,
                             uint items, global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const uint tile = tile_of_unit(i * W / UNIT, row_length);
  const TileOcclusion far = tiles[tile];
  const bits codes = LOAD(validity, i);
  const real x = LOAD(position_x, i), y = LOAD(position_y, i), z = LOAD(position_z, i);
  const truth drawn = ((codes & (bits)(VALIDITY_BACKGROUND)) == (bits)(0u)) & in_reach(x, y, z);
  if (!ANY(drawn)) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
  whole group = (whole)(-1);
  if (far.own) group = signed_owner_column(owner_group, owner_row(LOAD(owner, i), owners));

  real v = far_visibility(far, a, b, c);
  global const uint* list = lists + 2 * tile * (LISTS * slots);
  for (uint j = 0; j < far.distant; ++j) {
    const ShadingSphere sphere = spheres[list[2 * j]];
    const SphereView view = view_sphere(sphere, as_float(list[2 * j + 1]), x, y, z, a, b, c);
    v = fma(-v, (real)(fmin(sphere.opacity, 1.0f)) * JOIN(distant_, SHARE)(view.height, view.square), v);
  }
  list += 2 * slots;
  for (uint j = 0; j < far.close; ++j) {
    const ShadingSphere sphere = spheres[list[2 * j]];
    const SphereView view = view_sphere(sphere, as_float(list[2 * j + 1]), x, y, z, a, b, c);
    v = fma(-v, (real)(fmin(sphere.opacity, 1.0f)) * JOIN(close_, SHARE)(view.height, view.square), v);
  }
  list += 2 * slots;
  truth too_close = (truth)(0);
  const int all = far.near == ALL_SPHERES;
  const uint count = all ? sphere_count : far.near;
  for (uint j = 0; j < count; ++j) {
    const ShadingSphere sphere = spheres[all ? j : list[2 * j]];
    if (all && !sphere_shades(sphere)) continue;
    const float scale = all ? 1.0f / sphere.radius : as_float(list[2 * j + 1]);
    SphereView view = view_sphere(sphere, scale, x, y, z, a, b, c);
    // A fragment's own spheres are too far to be seen, yet near enough for 1/d^3 to be a normal number: subnormal ones
    // take a tenth of the shading's time.
    if (sphere.group >= 0) view.square = PICK(group == (whole)(sphere.group), REAL(1e12), view.square);
    v = fma(-v, (real)(fmin(sphere.opacity, 1.0f)) * SHARE(view.height, view.square), v);
    too_close |= view.square <= REAL(1.0);
  }
  STORE(PICK(drawn, as_visibility(v), REAL(1.0)), visibility, i);
  if (ANY(drawn & too_close)) add_validity(validity, i, drawn & too_close, VALIDITY_OCCLUDER_TOO_CLOSE);
}
