// The crown models at points of a plant, as calibration fits them: eq. 6's caps and the transmittance of chords.
#pragma once
#include <cstddef>
#include <vector>

#include "host/trace/calibrate.hpp"
#include "host/trace/crown_points.hpp"

namespace understory {

enum class CapShell { sphere, ellipsoid, nearest, levels };

/// f V_cap of eq. 4 and 5 (Hegeman et al. 2006) of each point, m^3: V = exp(-alpha rho weight).
std::vector<double> cap_weights(const CrownShell& crown, const CrownPoints& points, CapShell shell);

/// An ellipsoid, as the map to the frame where it is the unit sphere.
struct UnitShell {
  glm::dvec3 centre{0};
  glm::dmat3 to_unit{1};
};

/// `scale`: times their radii.
std::vector<UnitShell> shells_of(const CrownShell& crown, CrownShape shape, double scale = 1);

/// Ways through shells from points of a plant, cosine-weighted: what crown-transmittance is the mean over.
class ShellChords {
 public:
  ShellChords(const std::vector<UnitShell>& shells, const CrownPoints& points);
  /// V_c of each point, `sky: sphere`: the product over the shells of the mean of exp(-k chord). `k`: 1/m.
  std::vector<double> visibility(double k) const;

 private:
  static constexpr std::size_t directions = 64;
  std::size_t points_ = 0, shells_ = 0;
  std::vector<float> chords_;  // m; [point][shell][direction]
};

/// Where a line is within the ellipsoid, m along it.
struct Chord {
  std::size_t line = 0;
  float enter = 0, leave = 0;
};

/// Of the lines that cross the crown's ellipsoid.
std::vector<Chord> ellipsoid_chords(const CrownShell& crown, const std::vector<CrownLine>& lines);

/// Plant area density of a prototype, 16 cells along its longest side.
DensityGrid density_grid(const Prototype& prototype);

}  // namespace understory
