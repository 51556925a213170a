// A shell of `crown-transmittance`: where it is, how dense, and the fit of its visibility (shared/crown_transmittance.h).
#ifndef UNDERSTORY_TRANSMITTANCE_SHELL_H
#define UNDERSTORY_TRANSMITTANCE_SHELL_H

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

typedef struct {
  float to_unit[12];    // 3x3 rows padded to 4: to the frame where the shell is the unit sphere, 1/m
  float x, y, z;        // centre, camera-relative m
  float radius;         // geometric mean of the radii, m
  float sphere;         // 1/radius where it is a sphere, else 0, 1/m
  float optical;        // k times radius
  float bend;           // of the variable z
  float near_share;     // what leaves next to a fragment let through, (0, 1]; counts once, of a crown's first shell
  float opacity;        // 1 - mean transmittance of the shell's disc
  float within[25];     // P0, P1, P2, P4, P6: five coefficients each, rising
  float outside[25];    // of s^0, s^2, ..., s^8: five coefficients each, rising
  float padding_;
} TransmittanceShell;   // 288 bytes

#ifndef __OPENCL_C_VERSION__
static_assert(sizeof(TransmittanceShell) == 288);
}  // namespace understory
#endif
#endif
