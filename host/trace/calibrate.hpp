// The constants of the crown models of one plant, fitted to the traced truth of its own triangles at rest, and how far
// each model is off on points that were not used to fit.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "sim/prototype.hpp"
#include "sim/world.hpp"

namespace understory {

struct CalibrationOptions {
  std::size_t points = 2000;  // half of them to fit, half held out
  int rays = 256;             // per point
  std::size_t lines = 16384;  // through the crown
  std::uint32_t seed = 1;
};

/// Plant area density (leaf area plus half the wood's surface) in cells of a box, 1/m.
struct DensityGrid {
  glm::vec3 low{0}, high{0};  // m
  glm::ivec3 cells{0};
  std::vector<float> density;  // x fastest
};

struct Calibration {
  double leaf_area = 0, plant_area = 0;  // one-sided leaf area; with half the wood's surface, m^2
  double lad_mean = 0, pad_mean = 0;     // both over the volume of the crown's ellipsoid, 1/m
  /// Extinction in the ellipsoid from lines through it: mean of exp(-k chord) = share that is open, 1/m. `clumping`:
  /// k / (PAD/2), 1 for random leaves. `open_error`: of the mean open share, on lines not used to fit.
  double k = 0, clumping = 0, open_error = 0;
  double ambient = 1;  // the best constant
  CrownModel model;    // what a run takes; shape: of least held-out error
  /// Of crown-transmittance in each shape: k, 1/m, near share, and the shell's scale.
  std::map<std::string, std::array<double, 3>> transmittance;
  /// V_c under `sky: sphere`, by method; crown-transmittance has an entry for each shape too,
  /// crown-transmittance/sphere.
  std::map<std::string, double> rmse_heldout;
  std::size_t points = 0;
  DensityGrid density;
};

/// `ambient_of_reeves_blau`: A where the user gave one, else 0: fitted. Deterministic for any number of threads.
/// Everything 0 and open for a prototype without a crown.
Calibration calibrate(const Prototype& prototype, double ambient_of_reeves_blau = 0,
                      const CalibrationOptions& options = {});

}  // namespace understory
