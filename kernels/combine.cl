// The terms of a frame into its visibility: V = V_own V_dome V_shade V_near (FORMULAS.md, "One fragment, several
// methods"), or with near_is_limit the lesser of V_near and the others' product.
// Own terms are 1 outside their classes, so that their product is the own model of each fragment. The dome factor goes
// to classes whose own model has no horizon in it. Background, and what is not finite, is open: 1.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/limits.h"
#include "kernels/shared/owner_table.h"
#include "kernels/shared/validity.h"

// Terms that exist, bits of `present`; buffers of the others are not read. Order of host/passes/combine.cpp.
#define TERM(bit, plane) ((present & (1u << (bit))) ? as_visibility(LOAD(plane, i)) : REAL(1.0))

kernel void combine(uint present, global const float* ambient, global const float* tree, global const float* grass,
                    global const float* crowns, global const float* occluders, global const float* dome,
                    global const float* near, uint near_is_limit, uint horizon_classes, global const uint* owner,
                    global const uint* owner_class, uint owners, uint items, global const uint* validity,
                    global float* visibility) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const truth open = (LOAD(validity, i) & (bits)(VALIDITY_BACKGROUND | VALIDITY_NOT_FINITE)) != (bits)(0u);
  if (!ANY(NOT(open))) {
    STORE(REAL(1.0), visibility, i);
    return;
  }
  real v = TERM(0, ambient) * TERM(1, tree) * TERM(2, grass) * TERM(3, crowns) * TERM(4, occluders);
  if (horizon_classes == 0u) {
    v *= TERM(5, dome);
  } else {
    const bits surface = owner_column(owner_class, owner_row(LOAD(owner, i), owners));
    const truth has_horizon = ((bits)(horizon_classes) >> surface & (bits)(1u)) != (bits)(0u);
    v *= PICK(has_horizon, REAL(1.0), TERM(5, dome));
  }
  const real v_near = TERM(6, near);
  v = near_is_limit ? at_most(v, v_near) : v * v_near;
  STORE(PICK(open, REAL(1.0), v), visibility, i);
}
