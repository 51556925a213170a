// Obscurance from half to full resolution: the mean of up to four small pixels around each fragment, weighted by how well
// they lie on its surface; where none does, the one whose surface is nearest. Validity codes come along.
// One work-item per W fragments; planes are padded.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/obscurance_fragments.h"
#include "kernels/shared/surface_weight.h"

#define CODES (VALIDITY_RADIUS_OUT_OF_RANGE | VALIDITY_LEFT_IMAGE)

kernel void upsample_obscurance(global const float* half_visibility, global const float* half_depth,
                                global const float* half_normal_x, global const float* half_normal_y,
                                global const float* half_normal_z, global const uint* half_validity, int half_width,
                                int half_height, global const float* depth, global const float* normal_x,
                                global const float* normal_y, global const float* normal_z,
                                const ObscuranceSetting setting, float reach, uint items, global float* visibility,
                                global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const truth drawn = (LOAD(validity, i) & (bits)(VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) == (bits)(0u);
  if (!ANY(drawn)) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  const Pixels at = pixels_of(i, &setting);
  const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
  const Receiver to = receiver_of(at, LOAD(depth, i), a, b, c, &setting);
  const real per_focal = (real)(1.0f / setting.focal), per_reach = (real)(1.0f / reach);
  TangentPlane plane = {to.depth, to.facing, to.normal_x * per_focal, to.normal_y * per_focal, to.scale, to.perspective};

  const whole x = TO_WHOLE(at.x), y = TO_WHOLE(at.y);
  real sum = REAL(0.0), weights = REAL(0.0), nearest = REAL(3e38), fallback = REAL(1.0);
  bits codes = (bits)(0u);
  for (int corner = 0; corner < 4; ++corner) {
    // Odd pixels lie between two small ones, even ones on one.
    const whole small_x = clamp((x + (whole)(corner & 1)) >> 1, (whole)(0), (whole)(half_width - 1));
    const whole small_y = clamp((y + (whole)(corner >> 1)) >> 1, (whole)(0), (whole)(half_height - 1));
    const whole from = small_y * (whole)(half_width) + small_x;
    const real v = GATHER(real, half_visibility, from, ), z = GATHER(real, half_depth, from, );
    const bits known = GATHER(bits, half_validity, from, );
    const real step_x = TO_REAL(small_x * 2 - x), step_y = TO_REAL(small_y * 2 - y);
    const real height = fabs(height_over(plane, step_x, step_y, z));
    const real cosine = fma(a, GATHER(real, half_normal_x, from, ),
                            fma(b, GATHER(real, half_normal_y, from, ), c * GATHER(real, half_normal_z, from, )));
    const truth usable = (known & (bits)(VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) == (bits)(0u);
    const real weight = PICK(usable, surface_weight(height, per_reach, cosine), REAL(0.0));
    sum = fma(weight, v, sum);
    weights += weight;
    const truth nearer = usable & (height < nearest);
    nearest = PICK(nearer, height, nearest);
    fallback = PICK(nearer, v, fallback);
    codes |= PICK(usable, known & (bits)(CODES), (bits)(0u));
  }
  const real v = PICK(weights > REAL(1e-3), sum / weights, fallback);
  STORE(PICK(drawn, as_visibility(v), REAL(1.0)), visibility, i);
  codes = PICK(drawn, codes, (bits)(0u));
  if (ANY(codes != (bits)(0u))) STORE(LOAD(validity, i) | codes, validity, i);
}
