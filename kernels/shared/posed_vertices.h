// Posed vertices are records of four floats: x, y, z, unused. Triangles take theirs from anywhere: one load per corner
// costs a third of gathering three planes, on a CPU and on a GPU.
#ifndef UNDERSTORY_POSED_VERTICES_H
#define UNDERSTORY_POSED_VERTICES_H

#include "kernels/shared/real.h"

typedef struct {
  real x, y, z;  // camera-relative m, world axes
} PosedLanes;

#if W == 16
// Four records per vector, those of lanes k, k + 4, k + 8, k + 12: a 4x4 transposition within each quarter of the
// vector then gives x, y and z in the order of the lanes.
static inline float16 quarters_first(float16 p, float16 q) {  // p0 q0 p1 q1 of every quarter
  return (float16)(p.s0, q.s0, p.s1, q.s1, p.s4, q.s4, p.s5, q.s5, p.s8, q.s8, p.s9, q.s9, p.sc, q.sc, p.sd, q.sd);
}
static inline float16 quarters_last(float16 p, float16 q) {  // p2 q2 p3 q3
  return (float16)(p.s2, q.s2, p.s3, q.s3, p.s6, q.s6, p.s7, q.s7, p.sa, q.sa, p.sb, q.sb, p.se, q.se, p.sf, q.sf);
}
static inline float16 halves_first(float16 p, float16 q) {  // p0 p1 q0 q1
  return (float16)(p.s01, q.s01, p.s45, q.s45, p.s89, q.s89, p.scd, q.scd);
}
static inline float16 halves_last(float16 p, float16 q) {  // p2 p3 q2 q3
  return (float16)(p.s23, q.s23, p.s67, q.s67, p.sab, q.sab, p.sef, q.sef);
}

static inline PosedLanes transposed(float16 r0, float16 r1, float16 r2, float16 r3) {
  const float16 xy01 = quarters_first(r0, r1), xy23 = quarters_first(r2, r3);
  PosedLanes lanes;
  lanes.x = halves_first(xy01, xy23);
  lanes.y = halves_last(xy01, xy23);
  lanes.z = halves_first(quarters_last(r0, r1), quarters_last(r2, r3));
  return lanes;
}

#define RECORDS(i, j, k, l) (float16)(posed[i], posed[j], posed[k], posed[l])

// The corners that 16 consecutive entries of an index plane name.
static inline PosedLanes gather_posed(global const float4* posed, uint first, global const uint* index) {
#define AT(lane) first + index[lane]
  return transposed(RECORDS(AT(0), AT(4), AT(8), AT(12)), RECORDS(AT(1), AT(5), AT(9), AT(13)),
                    RECORDS(AT(2), AT(6), AT(10), AT(14)), RECORDS(AT(3), AT(7), AT(11), AT(15)));
#undef AT
}

static inline PosedLanes load_posed(global const float4* posed, uint vertex) {
  posed += vertex;
  return transposed(RECORDS(0, 4, 8, 12), RECORDS(1, 5, 9, 13), RECORDS(2, 6, 10, 14), RECORDS(3, 7, 11, 15));
}

// Four vectors of four records: lanes 0 to 3, 4 to 7, and so on.
typedef struct {
  float16 first, second, third, fourth;
} PosedRecords;

// With every fourth lane side by side, the transpositions of the quarters leave records in the order of the lanes.
static inline float16 every_fourth(float16 p) { return (float16)(p.s048c, p.s159d, p.s26ae, p.s37bf); }

static inline PosedRecords posed_records(PosedLanes lanes) {
  const float16 none = (float16)(0.0f);
  const float16 x = every_fourth(lanes.x), y = every_fourth(lanes.y), z = every_fourth(lanes.z);
  const float16 xy_first = quarters_first(x, y), xy_last = quarters_last(x, y);
  const float16 z_first = quarters_first(z, none), z_last = quarters_last(z, none);
  PosedRecords records;
  records.first = halves_first(xy_first, z_first);
  records.second = halves_last(xy_first, z_first);
  records.third = halves_first(xy_last, z_last);
  records.fourth = halves_last(xy_last, z_last);
  return records;
}

static inline PosedRecords moved_by(PosedRecords from, float share, PosedRecords way) {
  PosedRecords to;
  to.first = fma((real)(share), way.first, from.first);
  to.second = fma((real)(share), way.second, from.second);
  to.third = fma((real)(share), way.third, from.third);
  to.fourth = fma((real)(share), way.fourth, from.fourth);
  return to;
}

// All that is posed is more than caches hold: stores past them spare the reading of what is overwritten. `vertex` is a
// multiple of 16, and OpenCL aligns buffers for any vector.
#if __has_builtin(__builtin_nontemporal_store)
#define STORE_PAST_CACHES(value, place) __builtin_nontemporal_store(value, place)
#else
#define STORE_PAST_CACHES(value, place) *(place) = (value)
#endif

static inline void store_records(PosedRecords records, global float4* posed, size_t vertex) {
  global float16* at = (global float16*)(posed + vertex);
  STORE_PAST_CACHES(records.first, at);
  STORE_PAST_CACHES(records.second, at + 1);
  STORE_PAST_CACHES(records.third, at + 2);
  STORE_PAST_CACHES(records.fourth, at + 3);
}

#else
static inline PosedLanes gather_posed(global const float4* posed, uint first, global const uint* index) {
  const bits at = (bits)(first) + LOAD(index, 0);
  PosedLanes lanes;
  lanes.x = GATHER(real, posed, at, .x);
  lanes.y = GATHER(real, posed, at, .y);
  lanes.z = GATHER(real, posed, at, .z);
  return lanes;
}

static inline PosedLanes load_posed(global const float4* posed, uint vertex) {
  PosedLanes lanes;
 private
  float x[W], y[W], z[W];
  for (uint lane = 0; lane < W; ++lane) {
    const float4 p = posed[vertex + lane];
    x[lane] = p.x;
    y[lane] = p.y;
    z[lane] = p.z;
  }
  lanes.x = LOAD(x, 0);
  lanes.y = LOAD(y, 0);
  lanes.z = LOAD(z, 0);
  return lanes;
}

typedef PosedLanes PosedRecords;

static inline PosedRecords posed_records(PosedLanes lanes) { return lanes; }

static inline PosedRecords moved_by(PosedRecords from, float share, PosedRecords way) {
  PosedRecords to;
  to.x = fma((real)(share), way.x, from.x);
  to.y = fma((real)(share), way.y, from.y);
  to.z = fma((real)(share), way.z, from.z);
  return to;
}

static inline void store_records(PosedRecords records, global float4* posed, size_t vertex) {
 private
  float x[W], y[W], z[W];
  STORE(records.x, x, 0);
  STORE(records.y, y, 0);
  STORE(records.z, z, 0);
  for (uint lane = 0; lane < W; ++lane) posed[vertex + lane] = (float4)(x[lane], y[lane], z[lane], 0.0f);
}
#endif

#endif
