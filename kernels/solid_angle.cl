// How spheres (crowns of other plants, pieces of moving occluders) shade fragments: the product of 1 - opacity times the
// blocked share over the spheres listed for the fragment's tile, times the tile's far occlusion (tile_spheres.cl).
// -DSHARE=unit_solid_angle, unit_solid_angle_exact or unit_solid_angle_cosine chooses the share. A fragment is not
// shaded by spheres of its own group. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/fragment_tiles.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/records.h"
#include "kernels/shared/solid_angle.h"
#include "kernels/shared/tile_occlusion.h"
#include "kernels/shared/validity.h"

kernel void shade_by_spheres(global const float* position_x, global const float* position_y,
                             global const float* position_z, global const float* normal_x,
                             global const float* normal_y, global const float* normal_z, global const uint* owner,
                             global const int* owner_group, uint owners, global const ShadingSphere* spheres,
                             uint sphere_count, global const TileOcclusion* tiles, global const uint* lists,
                             uint capacity, uint row_length, uint items, global float* visibility,
                             global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const uint tile = tile_of_unit(i * W / UNIT, row_length);
  const TileOcclusion far = tiles[tile];
  const real x = LOAD(position_x, i), y = LOAD(position_y, i), z = LOAD(position_z, i);
  const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
  const whole group = signed_owner_column(owner_group, owner_row(LOAD(owner, i), owners));

  real v = far_visibility(far, a, b, c);
  truth too_close = (truth)(0);
  const uint count = far.listed == ALL_SPHERES ? sphere_count : far.listed;
  for (uint j = 0; j < count; ++j) {
    const ShadingSphere sphere = spheres[far.listed == ALL_SPHERES ? j : lists[tile * capacity + j]];
    const float opacity = sphere.radius > 0 ? clamp(sphere.opacity, 0.0f, 1.0f) : 0.0f;
    const float inverse_radius = 1.0f / fmax(sphere.radius, 1e-12f);
    const real dx = ((real)(sphere.x) - x) * inverse_radius, dy = ((real)(sphere.y) - y) * inverse_radius;
    const real dz = ((real)(sphere.z) - z) * inverse_radius;
    const truth other = (group != (whole)(sphere.group)) | (group < 0);
    const real blocked = PICK(other, (real)(opacity), REAL(0.0)) * SHARE(dx, dy, dz, a, b, c);
    v = fma(-v, blocked, v);
    too_close |= other & (distance_squared(dx, dy, dz) <= (real)(opacity > 0 ? 1.0f : 0.0f));
  }
  STORE(as_visibility(v), visibility, i);
  STORE(LOAD(validity, i) | PICK(too_close, (bits)(VALIDITY_OCCLUDER_TOO_CLOSE), (bits)(0u)), validity, i);
}
