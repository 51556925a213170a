// One maths text, several widths: `real` is float or a vector of W floats in OpenCL C, double in C++.
// Shared functions take and return `real`, and select with PICK where lanes differ instead of branching.
// FP_CONTRACT is off in every kernel; `fma` is written where it is wanted, so that all widths give the same bits.
#ifndef UNDERSTORY_REAL_H
#define UNDERSTORY_REAL_H

#ifdef __OPENCL_C_VERSION__

#ifndef W
#define W 1
#endif
#ifdef __OPTIMIZE__
// Of a function that is called twice PoCL would else make a call, with every vector through memory.
#define SHARED static inline __attribute__((always_inline))
#else
#define SHARED static inline  // -O0 is oclgrind's (under_oclgrind.sh), which lacks an intrinsic of inlined calls
#endif
#define PRIVATE private
#define MATRIX global const float*  // rows of a record's matrix
#define ELEMENT float               // one number of a record

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define REAL(literal) ((real)(literal##f))

// truth: result of a comparison; whole, bits: integers, one per lane.
// LOAD, STORE: the i-th group of W elements of a plane.
#if W == 1
typedef float real;
typedef int truth;
typedef int whole;
typedef uint bits;
#define PICK(condition, yes, no) ((condition) ? (yes) : (no))
#define NOT(condition) (!(condition))
#define ANY(condition) (condition)
#define LOAD(plane, i) (plane)[i]
#define STORE(value, plane, i) (plane)[i] = (value)
#define LOAD_BYTE(plane, i) convert_float((plane)[i])
#define AS_REAL(value) as_float(value)
#define TO_WHOLE(value) convert_int(value)
#define TO_REAL(value) convert_float(value)
#define BYTES uchar
#define TO_BYTES(value) convert_uchar(value)
#define TO_BITS(value) convert_uint(value)
#define AS_WHOLE(value) as_int(value)
#else
typedef JOIN(float, W) real;
typedef JOIN(int, W) truth;
typedef JOIN(int, W) whole;
typedef JOIN(uint, W) bits;
#define PICK(condition, yes, no) select(no, yes, condition)
#define NOT(condition) (~(condition))
#define ANY(condition) any_lane(condition)
#define LOAD(plane, i) load_lanes(i, plane)
#define STORE(value, plane, i) store_lanes(value, i, plane)
#define LOAD_BYTE(plane, i) JOIN(convert_float, W)(load_bytes(i, plane))
#define AS_REAL(value) JOIN(as_float, W)(value)
#define TO_WHOLE(value) JOIN(convert_int, W)(value)
#define TO_REAL(value) JOIN(convert_float, W)(value)
#define BYTES JOIN(uchar, W)
#define TO_BYTES(value) JOIN(convert_uchar, W)(value)
#define TO_BITS(value) JOIN(convert_uint, W)(value)
#define AS_WHOLE(value) JOIN(as_int, W)(value)
#endif

// 0, 1, ..., W - 1.
#if W == 1
#define LANE_NUMBERS 0
#elif W == 4
#define LANE_NUMBERS ((int4)(0, 1, 2, 3))
#elif W == 8
#define LANE_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#else
#define LANE_NUMBERS ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#endif

#if W > 1
// W elements of a plane as one access, aligned like its elements. PoCL splits vload16 and vstore16 into two to four:
// a quarter of the time of a short kernel.
#ifdef __clang__
#define LANES_IN(space, element, vector)                                                                     \
  typedef vector JOIN(JOIN(space, _), vector) __attribute__((aligned(4)));                                   \
  SHARED vector __attribute__((overloadable)) load_lanes(size_t i, space const element* plane) {             \
    return *(space const JOIN(JOIN(space, _), vector)*)(plane + i * W);                                      \
  }                                                                                                          \
  SHARED void __attribute__((overloadable)) store_lanes(vector value, size_t i, space element* plane) {      \
    *(space JOIN(JOIN(space, _), vector)*)(plane + i * W) = value;                                           \
  }
#define LANES_OF(element, vector)    \
  LANES_IN(global, element, vector)  \
  LANES_IN(private, element, vector) \
  LANES_IN(local, element, vector)
LANES_OF(float, real)
LANES_OF(int, whole)
LANES_OF(uint, bits)

#define BYTES_OF(element)                                                                                 \
  typedef JOIN(element, W) JOIN(loose_, element) __attribute__((aligned(1)));                             \
  SHARED JOIN(element, W) __attribute__((overloadable)) load_bytes(size_t i, global const element* plane) { \
    return *(global const JOIN(loose_, element)*)(plane + i * W);                                         \
  }
BYTES_OF(char)
BYTES_OF(uchar)
#else
#define load_lanes JOIN(vload, W)
#define store_lanes JOIN(vstore, W)
#define load_bytes JOIN(vload, W)
#endif

// All lanes' bits, or-ed.
SHARED int or_lanes(whole lanes) {
#if W == 16
  const int8 eight = lanes.lo | lanes.hi;
  const int4 four = eight.lo | eight.hi;
#elif W == 8
  const int4 four = lanes.lo | lanes.hi;
#else
  const int4 four = lanes;
#endif
  const int2 two = four.lo | four.hi;
  return two.x | two.y;
}

// LANE_MASK: which lanes are true, lane 0 the lowest bit, where the processor has an instruction for it: the compiler
// finds no way from comparisons to bits that is shorter than or-ing all lanes.
#if W == 16 && defined(__AVX512DQ__) && __has_builtin(__builtin_ia32_cvtd2mask512)
#define LANE_MASK(lanes) ((uint)(ushort)__builtin_ia32_cvtd2mask512(lanes))
#elif W == 8 && defined(__AVX__) && __has_builtin(__builtin_ia32_movmskps256)
#define LANE_MASK(lanes) ((uint)__builtin_ia32_movmskps256(as_float8(lanes)))
#elif W == 4 && defined(__SSE__) && __has_builtin(__builtin_ia32_movmskps)
#define LANE_MASK(lanes) ((uint)__builtin_ia32_movmskps(as_float4(lanes)))
#endif

// PoCL's own `any` tests pair after pair with a branch each: three times the instructions.
SHARED int any_lane(truth condition) {
#ifdef LANE_MASK
  return LANE_MASK(condition) != 0u;
#else
  return or_lanes(condition);
#endif
}
#endif

// GATHER(real, table, index, .member): a member of table[index] for every lane of the `whole` or `bits` index.
#define LANE(table, index, member, lane) (table)[(index).s##lane] member
#define LANES_4(table, index, member)                                                                     \
  LANE(table, index, member, 0), LANE(table, index, member, 1), LANE(table, index, member, 2),            \
      LANE(table, index, member, 3)
#define LANES_8(table, index, member)                                                                     \
  LANES_4(table, index, member), LANE(table, index, member, 4), LANE(table, index, member, 5),            \
      LANE(table, index, member, 6), LANE(table, index, member, 7)
#define LANES_16(table, index, member)                                                                    \
  LANES_8(table, index, member), LANE(table, index, member, 8), LANE(table, index, member, 9),            \
      LANE(table, index, member, a), LANE(table, index, member, b), LANE(table, index, member, c),        \
      LANE(table, index, member, d), LANE(table, index, member, e), LANE(table, index, member, f)
#if W == 1
#define GATHER(type, table, index, field) ((type)((table)[index] field))
#else
#define GATHER(type, table, index, field) ((type)(JOIN(LANES_, W)(table, index, field)))
#endif

#else  // C++

#include <bit>
#include <cmath>
#include <cstdint>

#define SHARED inline
#define PRIVATE
#define MATRIX const float*
#define ELEMENT float
#define REAL(literal) (literal)
#define PICK(condition, yes, no) ((condition) ? (yes) : (no))
#define ANY(condition) (condition)

namespace understory {
typedef double real;
typedef bool truth;
}  // namespace understory

#endif
#endif
