// `screen-rays`: the share of rays from each fragment, cosine-weighted and `radius` long, that get past what the depth
// plane shows. Two guesses of our own stand in for what it does not show, which in vegetation is most: a surface is as
// deep as it is wide, so that a ray gets past behind a twig and not behind a trunk; and where rays are behind things
// there are more of them unseen, so that such stretches dim as much as the share of them tells. A flat surface is open
// at any tilt below 80 degrees. One work-item per W fragments; planes are padded.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/exp_minus.h"
#include "kernels/shared/screen_ray.h"

/// What is farther behind a surface than this tells nothing of how dense things are around it, m.
#define CLUTTER_REACH REAL(1.0)
/// What a metre behind things blocks of a ray where all rays are behind things, 1/m. Chosen, as CLUTTER_REACH, by the
/// error on meadow, ecosystem, real plants and black oak, traced 1 m and 3 m far, in a study that is not kept; what the
/// method errs with it is in bench/obscurance.md.
#define BLOCKED_PER_METRE REAL(3.0)

/// Of rays up to where they are blocked; of one by itself shares of its length, of several together metres.
typedef struct {
  real behind;   // anything
  real clutter;  // anything, by less than CLUTTER_REACH
  real clear;    // nothing
} Stretches;

typedef struct {
  Stretches along;
  real open;  // 1; 0 where something blocks it
} Passage;

/// Through the part of the image that the ray crosses.
SHARED Passage passage_of(global const float* depth, Pixels at, Receiver to, truth drawn, ScreenRay ray,
                          const ObscuranceSetting* setting) {
  const real thickness = (real)(setting->thickness);
  const real rounding = rounding_of(to, setting), end = PICK(drawn, ray.inside, REAL(0.0));
  // A ray may have been on a surface anywhere in a step: half of what its depth changes by, on either side.
  const real slant = REAL(0.5) * fabs(ray.end.z);
  Passage passage = {{REAL(0.0), REAL(0.0), REAL(0.0)}, REAL(1.0)};
  SurfaceRun run = {REAL(0.0), REAL(-1e30)};
  real from = FIRST_STEP, share = share_at(ray, from), looked = from;
  // Nothing ends a ray early: steps that depend on no gather overlap, which takes two thirds of the time.
  for (truth on = from < end; ANY(on); on = from < end) {
    const real next = at_most(from + at_least(GROWTH * from, REAL(1.0)), end), step = next - from;
    const real place = fma(step, ray.jitter, from), next_share = share_at(ray, next);
    const SeenPixel seen = seen_pixel(depth, at, to, ray, place, setting);
    const real behind = fma(ray.end.z, share_at(ray, place), to.depth) - seen.depth;
    const truth is_behind = (behind > fma(seen.width, ON_SURFACE, rounding)) & (seen.width > REAL(0.0));
    run = next_of_run(run, is_behind, seen, place - looked);
    const real passed = next_share - share, deep = at_least(run.width, thickness) + rounding;
    const truth stops =
        is_behind & (fma(-slant, passed, behind) < fma(seen.width, at_least(step - REAL(1.0), REAL(0.0)), deep));
    passage.open = PICK(on & stops, REAL(0.0), passage.open);
    const real stretch = PICK(on, passed * passage.open, REAL(0.0)), hidden = PICK(is_behind, stretch, REAL(0.0));
    passage.along.behind += hidden;
    passage.along.clutter += PICK(behind < CLUTTER_REACH, hidden, REAL(0.0));
    passage.along.clear += stretch - hidden;
    looked = place;
    from = next;
    share = next_share;
  }
  return passage;
}

SHARED real open_share_of_rays(global const float* depth, global const float* normal_x, global const float* normal_y,
                               global const float* normal_z, global uint* validity, uint item, uint rays, Pixels at,
                               Receiver to, truth drawn, const ObscuranceSetting* setting) {
  const Ball ball = ball_around(to, (real)(setting->radius), (real)(setting->focal));
  Stretches all = {REAL(0.0), REAL(0.0), REAL(0.0)};
  real open = REAL(0.0);
  truth left = (truth)(0);
  for (uint i = 0; i < rays; ++i) {
    const ScreenRay ray = screen_ray(to, ball, at, i, rays, setting);
    Passage passage = passage_of(depth, at, to, drawn, ray, setting);
    const truth leaves = drawn & (ray.inside < ray.pixels);
    if (ANY(leaves)) {
      const truth ends = leaves & ends_behind(depth, normal_x, normal_y, normal_z, at, to, ray, setting);
      passage.open = PICK(ends, REAL(0.0), passage.open);
    }
    left |= leaves;
    open += passage.open;
    all.behind = fma(passage.open * ray.length, passage.along.behind, all.behind);
    all.clutter = fma(ray.length, passage.along.clutter, all.clutter);
    all.clear = fma(ray.length, passage.along.clear, all.clear);
  }
  flag_samples(validity, item, ball, left, drawn, setting);
  // Open rays as one of their mean length behind things: over all of them the error is less than with each by itself.
  const real density = BLOCKED_PER_METRE * all.clutter / at_least(all.clutter + all.clear, REAL(1e-30));
  const real dimmed = exp_minus(density * all.behind / at_least(open, REAL(1.0)));
  return as_visibility(open * (real)(1.0f / (float)(rays)) * dimmed);
}

kernel void shade_screen_rays(global const float* depth, global const float* normal_x, global const float* normal_y,
                              global const float* normal_z, const ObscuranceSetting setting, uint rays, uint items,
                              global float* visibility, global uint* validity) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const truth drawn = drawn_lanes(validity, i);
  if (!ANY(drawn)) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  const Pixels at = pixels_of(i, &setting);
  const Receiver to =
      receiver_of(at, LOAD(depth, i), LOAD(normal_x, i), LOAD(normal_y, i), LOAD(normal_z, i), &setting);
  const real v = open_share_of_rays(depth, normal_x, normal_y, normal_z, validity, i, rays, at, to, drawn, &setting);
  STORE(PICK(drawn, v, REAL(1.0)), visibility, i);
}
