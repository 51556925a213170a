// Wind as a function of (scene, seed, t): a log profile, and gusts as one periodic series, synthetic or measured.
// Each way of swaying gets the series filtered once through its transfer function (FFT); poses only look up.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sim/scene.hpp"

namespace understory {

/// No response to the wind ever reaches this angle, radians: it saturates smoothly (tanh).
inline constexpr double largest_tip_angle = 1.2;

/// Velocities about the mean, equally spaced in time and periodic; the sample count is a power of two.
struct GustSeries {
  double rate = 32;                   // samples per second
  std::vector<double> along, across;  // u', v', m/s, zero mean
};

/// Tip angle of one sway mode over time, radians at flexibility 1, periodic like the gusts that drive it.
struct ModalSeries {
  double rate = 32;                  // samples per second
  double mean = 0;                   // response to the mean wind, along the wind
  std::vector<float> along, across;  // about the mean; sizes are equal powers of two

  /// (along, across) at time t, mean included; linear interpolation, periodic in t.
  glm::dvec2 at(double time) const;
};

class Wind {
 public:
  /// Synthetic gusts: von Karman spectrum with random phases from an integer hash of `seed`. Measured: the record,
  /// rotated into its mean direction, end cross-faded into the start; its mean speed holds at `record_height`.
  /// Throws Error(invalid_input) naming key or file, value and what is allowed.
  Wind(const WindSource& source, std::uint64_t seed);

  /// Mean speed, m/s, at a height above ground: (u*/kappa) ln((z - d)/z0), 0 below d + z0.
  double mean_speed(double height) const;
  /// Unit, where the wind blows to.
  glm::dvec2 direction() const { return direction_; }
  /// Gusts travel with the mean speed at the reference (or record) height (Taylor's frozen turbulence), at least 0.5
  /// m/s.
  double convection_speed() const { return convection_speed_; }
  const GustSeries& gusts() const { return gusts_; }

  /// Integral length of the gusts along the wind, m.
  double length_scale() const { return length_scale_; }

  /// How a damped oscillator answers the drag of this wind at `height`: static angle deflection * (U/10)^2,
  /// its fluctuation 2 U u'/100 * deflection along and U v'/100 * deflection across (drag |V| V, first order), through
  /// H(f) = 1/(1 - (f/f0)^2 + 2 i zeta f/f0), zeta at least 0.01. The sum saturates below `largest_tip_angle`;
  /// deflection 0 gives exactly 0. Throws Error(invalid_input) for a frequency that is not positive.
  ModalSeries respond(const SwayMode& mode, double height) const;

 private:
  glm::dvec2 direction_{1, 0};
  double convection_speed_ = 1, length_scale_ = 40;
  double friction_velocity_ = 0, roughness_length_ = 0.05, displacement_height_ = 0;
  GustSeries gusts_;
};

}  // namespace understory
