// Four numbers that stand side by side in a table, read at one place for each lane and handed out one number after the
// other. Four lanes at a time make a row of 16 floats in a register; rows are turned into lanes by shuffles, which cost
// a fifth of writing number after number. OpenCL only.
#ifndef UNDERSTORY_FOUR_NUMBERS_H
#define UNDERSTORY_FOUR_NUMBERS_H

#include "kernels/shared/real.h"

typedef struct {
  real x, y, z, w;
} FourNumbers;

// PoCL splits vload4 and vload8 (real.h).
#ifdef __clang__
typedef float4 loose_float4 __attribute__((aligned(4)));
typedef float8 loose_float8 __attribute__((aligned(4)));
#define FOUR_AT(place) (*(global const loose_float4*)(place))
#define EIGHT_AT(place) (*(global const loose_float8*)(place))
#else
#define FOUR_AT(place) vload4(0, place)
#define EIGHT_AT(place) vload8(0, place)
#endif

// BY_FOURS(ROW): ROW(a, b, c, d) is the row of these lanes, the lanes' numbers in hexadecimal. Which lanes go together
// is so chosen that numbers move within 128 bits, the cheap kind of shuffle, and come out in order.
#if W == 16
SHARED FourNumbers by_number(float16 a, float16 b, float16 c, float16 d) {
#define LOW_PAIRS(p, q)                                                                                              \
  ((float16)((p).s0, (q).s0, (p).s1, (q).s1, (p).s4, (q).s4, (p).s5, (q).s5, (p).s8, (q).s8, (p).s9, (q).s9, (p).sc, \
             (q).sc, (p).sd, (q).sd))
#define HIGH_PAIRS(p, q)                                                                                             \
  ((float16)((p).s2, (q).s2, (p).s3, (q).s3, (p).s6, (q).s6, (p).s7, (q).s7, (p).sa, (q).sa, (p).sb, (q).sb, (p).se, \
             (q).se, (p).sf, (q).sf))
#define FIRST_HALVES(p, q) as_float16((ulong8)((p).s0, (q).s0, (p).s2, (q).s2, (p).s4, (q).s4, (p).s6, (q).s6))
#define SECOND_HALVES(p, q) as_float16((ulong8)((p).s1, (q).s1, (p).s3, (q).s3, (p).s5, (q).s5, (p).s7, (q).s7))
  const ulong8 ab_xy = as_ulong8(LOW_PAIRS(a, b)), ab_zw = as_ulong8(HIGH_PAIRS(a, b));
  const ulong8 cd_xy = as_ulong8(LOW_PAIRS(c, d)), cd_zw = as_ulong8(HIGH_PAIRS(c, d));
  const FourNumbers all = {FIRST_HALVES(ab_xy, cd_xy), SECOND_HALVES(ab_xy, cd_xy), FIRST_HALVES(ab_zw, cd_zw),
                           SECOND_HALVES(ab_zw, cd_zw)};
  return all;
}
#define BY_FOURS(ROW) by_number(ROW(0, 4, 8, c), ROW(1, 5, 9, d), ROW(2, 6, a, e), ROW(3, 7, b, f))
#elif W == 8
SHARED FourNumbers by_number(float16 a, float16 b) {
  const FourNumbers all = {(float8)(a.s0, b.s0, a.s4, b.s4, a.s8, b.s8, a.sc, b.sc),
                           (float8)(a.s1, b.s1, a.s5, b.s5, a.s9, b.s9, a.sd, b.sd),
                           (float8)(a.s2, b.s2, a.s6, b.s6, a.sa, b.sa, a.se, b.se),
                           (float8)(a.s3, b.s3, a.s7, b.s7, a.sb, b.sb, a.sf, b.sf)};
  return all;
}
#define BY_FOURS(ROW) by_number(ROW(0, 2, 4, 6), ROW(1, 3, 5, 7))
#elif W == 4
SHARED FourNumbers by_number(float16 a) {
  const FourNumbers all = {a.s048c, a.s159d, a.s26ae, a.s37bf};
  return all;
}
#define BY_FOURS(ROW) by_number(ROW(0, 1, 2, 3))
#endif

/// table[index] and the three numbers after it, of every lane.
SHARED FourNumbers four_numbers(global const float* table, private const uint* index) {
#if W == 1
  const float4 row = FOUR_AT(table + index[0]);
  const FourNumbers all = {row.x, row.y, row.z, row.w};
  return all;
#else
#define TABLE_ROW(a, b, c, d)                                                                             \
  ((float16)(FOUR_AT(table + index[0x##a]), FOUR_AT(table + index[0x##b]), FOUR_AT(table + index[0x##c]), \
             FOUR_AT(table + index[0x##d])))
  return BY_FOURS(TABLE_ROW);
#endif
}

#endif
