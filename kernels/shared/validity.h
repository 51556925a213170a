// Validity codes that the visibility kernels set: bit flags of sim/frame.hpp (FORMULAS.md, "Validity codes").
#ifndef UNDERSTORY_VALIDITY_H
#define UNDERSTORY_VALIDITY_H

#define VALIDITY_BACKGROUND 1u
#define VALIDITY_NOT_FINITE 2u
#define VALIDITY_NOT_UNIT 4u
#define VALIDITY_OUTSIDE_MODEL 8u
#define VALIDITY_OCCLUDER_TOO_CLOSE 16u

#endif
