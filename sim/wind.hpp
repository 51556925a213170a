// Wind as a function of (scene, seed, t): a log profile, and gusts as one periodic series, synthetic or measured.
// Each way of swaying gets the series filtered once through its transfer function (FFT); poses only look up.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sim/scene.hpp"

namespace understory {

/// Velocities about the mean, equally spaced in time and periodic; the sample count is a power of two.
struct GustSeries {
  double rate = 32;                  // samples per second
  std::vector<double> along, across; // u', v', m/s, zero mean
};

/// Tip angle of one sway mode over time, radians at flexibility 1, periodic like the gusts that drive it.
struct ModalSeries {
  double rate = 32;                 // samples per second
  double mean = 0;                  // response to the mean wind, along the wind
  std::vector<float> along, across; // about the mean; sizes are equal powers of two

  /// (along, across) at time t, mean included; linear interpolation, periodic in t.
  glm::dvec2 at(double time) const;
};

class Wind {
 public:
  /// Synthetic gusts: von Karman spectrum with random phases from an integer hash of `seed`. Measured: the record,
  /// rotated into its mean direction, end cross-faded into the start. Throws Error(invalid_input) naming the file.
  Wind(const WindSource& source, std::uint64_t seed);

  /// Mean speed, m/s, at a height above ground: (u*/kappa) ln((z - d)/z0), 0 below d + z0.
  double mean_speed(double height) const;
  /// Unit, where the wind blows to.
  glm::dvec2 direction() const { return direction_; }
  /// Gusts travel with this speed (Taylor's frozen turbulence), m/s, never below a small positive bound.
  double convection_speed() const { return convection_speed_; }
  const GustSeries& gusts() const { return gusts_; }

  /// How a damped oscillator answers the drag of this wind at `height`: static angle deflection * (U/10)^2,
  /// its fluctuation 2 U u'/100 * deflection through H(f) = 1/(1 - (f/f0)^2 + 2 i zeta f/f0).
  ModalSeries respond(const SwayMode& mode, double height) const;

 private:
  glm::dvec2 direction_{1, 0};
  double convection_speed_ = 1;
  double friction_velocity_ = 0, roughness_length_ = 0.05, displacement_height_ = 0;
  GustSeries gusts_;
};

}  // namespace understory
