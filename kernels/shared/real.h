// One maths text, several widths: `real` is float or a vector of W floats in OpenCL C, double in C++.
// Shared functions take and return `real`, and select with PICK where lanes differ instead of branching.
// FP_CONTRACT is off in every kernel; `fma` is written where it is wanted, so that all widths give the same bits.
#ifndef UNDERSTORY_REAL_H
#define UNDERSTORY_REAL_H

#ifdef __OPENCL_C_VERSION__

#ifndef W
#define W 1
#endif
#define SHARED static inline
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
#define ANY(condition) (condition)
#define LOAD(plane, i) (plane)[i]
#define STORE(value, plane, i) (plane)[i] = (value)
#define LOAD_BYTE(plane, i) convert_float((plane)[i])
#define AS_REAL(value) as_float(value)
#define TO_WHOLE(value) convert_int(value)
#define TO_REAL(value) convert_float(value)
#else
typedef JOIN(float, W) real;
typedef JOIN(int, W) truth;
typedef JOIN(int, W) whole;
typedef JOIN(uint, W) bits;
#define PICK(condition, yes, no) select(no, yes, condition)
#define ANY(condition) any(condition)
#define LOAD(plane, i) JOIN(vload, W)(i, plane)
#define STORE(value, plane, i) JOIN(vstore, W)(value, i, plane)
#define LOAD_BYTE(plane, i) JOIN(convert_float, W)(JOIN(vload, W)(i, plane))
#define AS_REAL(value) JOIN(as_float, W)(value)
#define TO_WHOLE(value) JOIN(convert_int, W)(value)
#define TO_REAL(value) JOIN(convert_float, W)(value)
#endif

// GATHER(real, table, index, .field): a member of table[index] for every lane of the `whole` or `bits` index.
#define LANE(t, i, f, lane) (t)[(i).s##lane] f
#define LANES_4(t, i, f) LANE(t, i, f, 0), LANE(t, i, f, 1), LANE(t, i, f, 2), LANE(t, i, f, 3)
#define LANES_8(t, i, f) LANES_4(t, i, f), LANE(t, i, f, 4), LANE(t, i, f, 5), LANE(t, i, f, 6), LANE(t, i, f, 7)
#define LANES_16(t, i, f)                                                                                     \
  LANES_8(t, i, f), LANE(t, i, f, 8), LANE(t, i, f, 9), LANE(t, i, f, a), LANE(t, i, f, b), LANE(t, i, f, c), \
      LANE(t, i, f, d), LANE(t, i, f, e), LANE(t, i, f, f)
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
