// `grid-cone`: the cone of directions that each body near a fragment occludes, looked up in its grid, clipped by the
// fragment's tangent plane and put together with the others' (Malmer et al. 2005 section 5). V_c. What a body takes from
// its own surface, sim/own_shadow.hpp, is a factor of its own: convex bodies take nothing. -DPAPER_CONE: every cone is
// opaque, as in the paper, and clips itself on its own body.
// -DCOMBINE=multiply, simple or merge (shared/running_cone.h); -DUNION: V is what the cones leave of some directions
// (shared/seen_directions.h), whatever the running cone is.
// -DCONES: stores the running cone as well, for the light of an environment (section 5.3).
// One work-item per W fragments; planes are padded (host/passes/planes.hpp).
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/grid_lookup.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/running_cone.h"
#include "kernels/shared/seen_directions.h"
#include "kernels/shared/shading_sphere.h"
#include "kernels/shared/tile_grids.h"
#include "kernels/shared/validity.h"

#ifdef PAPER_CONE
#define cone_of opaque_cone
#else
#define cone_of spread_cone
#endif

#ifdef CONES
#define CONE_PLANES                                                                                                   \
  , global float *axis_x, global float *axis_y, global float *axis_z, global float *aperture, global float *share
#define STORE_CONE(cone, blocked)                                                                                     \
  STORE((cone).x, axis_x, i), STORE((cone).y, axis_y, i), STORE((cone).z, axis_z, i);                                  \
  STORE((cone).aperture, aperture, i), STORE(blocked, share, i)
#else
#define CONE_PLANES
#define STORE_CONE(cone, blocked)
#endif

#ifdef UNION
#define SEE_ALL(a, b, c)   \
  SeenDirections seen;     \
  see_all(&seen);          \
  const Tangents tangents = tangents_of(a, b, c)
#define COVER(cone, share) cover(&seen, tangents, a, b, c, cone, share)
#define VISIBILITY(running) share_seen(&seen)
#else
#define SEE_ALL(a, b, c)
#define COVER(cone, share)
#define VISIBILITY(running) JOIN(visibility_, COMBINE)(running, a, b, c)
#endif

kernel void shade_grid_cone(global const float* position_x, global const float* position_y,
                            global const float* position_z, global const float* normal_x, global const float* normal_y,
                            global const float* normal_z, global const uint* owner, global const int* owner_group,
                            uint owners, global const GridRecord* grids, uint grid_count, global const uchar* samples,
                            global const uint* listed, global const uint* lists, uint capacity, uint row_length,
                            uint items, global float* visibility, global uint* validity CONE_PLANES) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const TileGrids here = grids_of_item(listed, capacity, row_length, grid_count, i);
  const real x = LOAD(position_x, i), y = LOAD(position_y, i), z = LOAD(position_z, i);
  const truth drawn =
      ((LOAD(validity, i) & (bits)(VALIDITY_BACKGROUND)) == (bits)(0u)) & in_reach(x, y, z);
  if (here.count == 0 || !ANY(drawn)) {
    STORE(REAL(1.0), visibility, i);
    STORE_CONE(no_cone(), REAL(0.0));
    return;
  }
  const real a = LOAD(normal_x, i), b = LOAD(normal_y, i), c = LOAD(normal_z, i);
#ifndef PAPER_CONE
  const whole group = signed_owner_column(owner_group, owner_row(LOAD(owner, i), owners));
#endif
  RunningCone running = no_cone();
  SEE_ALL(a, b, c);
  truth border = (truth)(0), solid = (truth)(0);
  real own_shadow = REAL(0.0);
  for (uint j = 0; j < here.count; ++j) {
    global const GridRecord* grid = grids + grid_of_tile(here, lists, j);
    const GridPoint p = grid_point(grid, x, y, z);
    truth inside = p.inside & drawn;
#ifndef PAPER_CONE
    const truth own = inside & (group == (whole)(grid->group)) & (group >= 0);
    if (grid->own_size != 0 && ANY(own))
      own_shadow = PICK(own, look_up_own(grid, samples, x, y, z, a, b, c), own_shadow);
    inside &= ~own;
#endif
    if (!ANY(inside)) continue;
    const Cone cone = cone_of(to_world(grid, look_up_cone(grid, samples, p, inside, &solid)));
    const RunningCone next = clip_cone(cone, a, b, c);
    const truth some = inside & (next.cosine > REAL(1e-6));
    COVER(cone, PICK(some, next.cosine, REAL(0.0)));
    RunningCone both = running;
    JOIN(combine_, COMBINE)(&both, next);
    running = pick_cone(some, both, running);
    border |= p.border & inside;
  }
  const real v = PICK(drawn, as_visibility(VISIBILITY(running)), REAL(1.0));
  STORE(v * (REAL(1.0) - own_shadow), visibility, i);
  STORE_CONE(running, REAL(1.0) - v);
  if (ANY(border)) add_validity(validity, i, border, VALIDITY_GRID_BORDER);
  if (ANY(solid)) add_validity(validity, i, solid, VALIDITY_OCCLUDER_TOO_CLOSE);
}
