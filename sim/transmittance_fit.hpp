// The mean transmittance of light through an even crown, fitted once per shell so that kernels evaluate a few
// polynomials (kernels/shared/crown_transmittance.h). The coefficients are those of least largest error for this very
// shell and density: nothing is set by hand, and no table covers densities that a scene does not have.
#pragma once
#include <glm/glm.hpp>

#include "kernels/shared/transmittance_shell.h"
#include "sim/world.hpp"

namespace understory {

/// A shell centred at the origin. `axes`: unit columns, at right angles; `radii`: m, along them; `k`: extinction, 1/m;
/// `dome`: fit for `sky: dome`. Error against quadrature: of a sphere below 1e-3 for k R in [0, 64] under
/// `sky: sphere`; others are stated in tests/kernels/crown_transmittance_test.cpp. No size or density, or what is not
/// finite: everything is open. k R beyond 1000 counts as 1000.
TransmittanceShell fit_transmittance(const glm::dmat3& axes, glm::dvec3 radii, double k, bool dome);

/// The shells that `model.shape` names, at rest, each with `model.extinction` and near share. None without a crown.
std::vector<TransmittanceShell> fit_shells(const CrownShell& crown, const CrownModel& model, bool dome);

}  // namespace understory
