// Ambient light from an environment map: V coloured by where the sky is still open (shared/environment.h). Glossy
// classes receive the cone about the mirrored view instead of what the normal faces, less the share of it that lies in
// the occluded cone: its own mean counts, for the occluded cone is mostly the wider one. Background receives nothing. One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/cone.h"
#include "kernels/shared/environment.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/validity.h"

typedef struct {
  real red, green, blue;
} Light;

// Four floats a node.
static inline Light node_light(global const float* table, whole node) {
  const whole at = node * (whole)(4);
  const Light light = {GATHER(real, table, at, ), GATHER(real, table, (at + (whole)(1)), ),
                       GATHER(real, table, (at + (whole)(2)), )};
  return light;
}

static inline Light blend(Light a, Light b, real share) {
  const Light light = {fma(share, b.red - a.red, a.red), fma(share, b.green - a.green, a.green),
                       fma(share, b.blue - a.blue, a.blue)};
  return light;
}

// Bilinear in a square of `nodes` x `nodes`, the first of which is node `first`.
static inline Light in_square(global const float* table, whole first, uint nodes, OctahedralPlace place) {
  const float cells = (float)(nodes - 1u);
  const real x = place.u * cells, y = place.v * cells;
  const real column = at_most(floor(x), (real)(cells - 1.0f)), row = at_most(floor(y), (real)(cells - 1.0f));
  const whole node = first + TO_WHOLE(row) * (whole)((int)nodes) + TO_WHOLE(column);
  const whole below = node + (whole)((int)nodes);
  return blend(blend(node_light(table, node), node_light(table, node + (whole)(1)), x - column),
               blend(node_light(table, below), node_light(table, below + (whole)(1)), x - column), y - row);
}

// Mean radiance in a cone: between two levels, which are even in the square root of the aperture.
static inline Light in_cone(global const float* cones, uint nodes, uint levels, real x, real y, real z, real aperture) {
  const OctahedralPlace place = octahedral_place(x, y, z);
  const float steps = (float)(levels - 1u);
  const real level = sqrt(at_most(at_least(aperture, REAL(0.0)), REAL(1.0))) * steps;
  const real lower = at_most(floor(level), (real)(steps - 1.0f));
  const whole square = (whole)((int)(nodes * nodes)), first = TO_WHOLE(lower) * square;
  return blend(in_square(cones, first, nodes, place), in_square(cones, first + square, nodes, place), level - lower);
}

kernel void light_from_environment(
    global const float* position_x, global const float* position_y, global const float* position_z,
    global const float* normal_x, global const float* normal_y, global const float* normal_z, global const uint* owner,
    global const uint* owner_class, uint owners, global const uint* validity, global const float* visibility,
    uint has_cones, global const float* cone_x, global const float* cone_y, global const float* cone_z,
    global const float* cone_aperture, global const float* cone_share, float eye_x, float eye_y, float eye_z,
    uint glossy_classes, float gloss, uint dome, global const float* normals, uint normal_nodes,
    global const float* cones, uint cone_nodes, uint cone_levels, uint items, global float* red, global float* green,
    global float* blue) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const truth drawn =
      (LOAD(validity, i) & (bits)(VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) == (bits)(0u);
  const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
  Light open_sky = in_square(normals, (whole)(0), normal_nodes, octahedral_place(a, b, c));
  real v = PICK(drawn, as_visibility(LOAD(visibility, i)), REAL(0.0)), occluded = REAL(0.0);
  Light cone_light = open_sky;
  real x = REAL(0.0), y = REAL(0.0), z = REAL(0.0), aperture = REAL(0.0);
  if (has_cones) {
    x = LOAD(cone_x, i), y = LOAD(cone_y, i), z = LOAD(cone_z, i);
    aperture = at_most(at_least(LOAD(cone_aperture, i), REAL(0.0)), REAL(1.0));
    occluded = at_most(at_least(LOAD(cone_share, i), REAL(0.0)), REAL(1.0));
    if (ANY(occluded > REAL(0.0))) cone_light = in_cone(cones, cone_nodes, cone_levels, x, y, z, aperture);
  }

  truth glossy = (truth)(0);
  if (glossy_classes != 0u) {
    const bits surface = owner_column(owner_class, owner_row(LOAD(owner, i), owners));
    glossy = drawn & (((bits)(glossy_classes) >> surface & (bits)(1u)) != (bits)(0u));
  }
  if (ANY(glossy)) {
    const real p = LOAD(position_x, i) - eye_x, q = LOAD(position_y, i) - eye_y, r = LOAD(position_z, i) - eye_z;
    const real away = REAL(2.0) * fma(p, a, fma(q, b, r * c));
    const real mx = fma(-away, a, p), my = fma(-away, b, q), mz = fma(-away, c, r);
    const real inverse = REAL(1.0) / at_least(sqrt(fma(mx, mx, fma(my, my, mz * mz))), REAL(1e-30));
    const Light mirrored = in_cone(cones, cone_nodes, cone_levels, mx, my, mz, (real)(gloss));
    // Of V only what the other models leave counts; the mirrored cone is dark where it dips below the horizon.
    const real rest = at_most(v / at_least(REAL(1.0) - occluded, REAL(1e-4)), REAL(1.0));
    const real above = dome ? clip_solid_angle((real)(gloss), at_most(at_least(mz * inverse, REAL(-1.0)), REAL(1.0)))
                            : (real)(gloss);
    const real facing = at_most(at_least(fma(x, mx, fma(y, my, z * mz)) * inverse, REAL(-1.0)), REAL(1.0));
    const real shared = PICK(aperture > REAL(0.0), overlap_of_apertures((real)(gloss), aperture, facing), REAL(0.0));
    const real hidden = at_most(at_least(shared / gloss, REAL(0.0)), REAL(1.0));
    open_sky.red = PICK(glossy, mirrored.red, open_sky.red);
    open_sky.green = PICK(glossy, mirrored.green, open_sky.green);
    open_sky.blue = PICK(glossy, mirrored.blue, open_sky.blue);
    v = PICK(glossy, rest * (above / gloss) * (REAL(1.0) - hidden), v);
    occluded = PICK(glossy, REAL(0.0), occluded);
  }
  STORE(light_beside_cone(v, occluded, open_sky.red, cone_light.red), red, i);
  STORE(light_beside_cone(v, occluded, open_sky.green, cone_light.green), green, i);
  STORE(light_beside_cone(v, occluded, open_sky.blue, cone_light.blue), blue, i);
}
