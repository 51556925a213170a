// The mean transmittance of an even crown by brute quadrature: directions on equal shares of the cosine-weighted
// hemisphere, each with the way through the shell from its two crossings. Then the fit of it that the kernel evaluates
// (kernels/shared/crown_transmittance.h), by the library's functions.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "kernels/shared/transmittance_shell.h"

namespace understory::reference {

/// Length of the ray from `p` along `w` within the ellipsoid about the origin; `radii` along x, y, z.
inline double chord(glm::dvec3 p, glm::dvec3 w, glm::dvec3 radii) {
  const glm::dvec3 u = p / radii, v = w / radii;
  // Foot of the perpendicular from the centre, in the frame of the unit sphere.
  const double speed = glm::length(v), foot = -glm::dot(u, v) / (speed * speed);
  const glm::dvec3 nearest = u + foot * v;
  const double off = glm::length(nearest);
  if (off >= 1) return 0;
  const double half = std::sqrt((1 - off) * (1 + off)) / speed;
  return std::max(foot + half, 0.0) - std::max(foot - half, 0.0);
}

/// V_c; `side`^2 directions.
inline double crown_transmittance(glm::dvec3 p, glm::dvec3 n, glm::dvec3 radii, double k, bool dome, int side = 200) {
  const glm::dvec3 helper = std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(helper, n)), b = glm::cross(n, a);
  double sum = 0;
  for (int i = 0; i < side; ++i) {
    const double square = (i + 0.5) / side, flat = std::sqrt(square), height = std::sqrt(1 - square);
    for (int j = 0; j < side; ++j) {
      const double turn = 2 * std::numbers::pi * (j + 0.5 * (i % 2) + 0.25) / side;
      const glm::dvec3 w = flat * (std::cos(turn) * a + std::sin(turn) * b) + height * n;
      if (!dome || w.z > 0) sum += std::exp(-k * chord(p, w, radii));
    }
  }
  return sum / (side * side);
}

/// Sum of five coefficients times rising powers.
inline double quartic_sum(const float* c, double z) {
  double sum = 0;
  for (int power = 0; power < 5; ++power) sum += double(c[power]) * std::pow(z, power);
  return sum;
}

/// Where a fragment is in the frame of a shell: q, n.g and z.g of kernels/shared/crown_transmittance.h.
struct ShellCoordinates {
  double q = 0, along = 0, rise = 0, stretch = 1;
};

/// Mean over the lune above tangent plane and horizon, at depth variable z.
inline double lune_transmittance(const TransmittanceShell& shell, ShellCoordinates at, glm::dvec3 n, double z) {
  const double level = quartic_sum(shell.within, z), slope = quartic_sum(shell.within + 5, z),
               curve = quartic_sum(shell.within + 10, z), s = at.along, r = at.rise;
  const double tilt = std::acos(std::clamp(n.z, -1.0, 1.0)), sine = std::sqrt(std::max(1 - n.z * n.z, 0.0));
  const double first = 2.0 / 3 * ((1 - tilt / std::numbers::pi) * s + sine * r / std::numbers::pi);
  const double second = ((1 + n.z) * at.q * at.q + s * s + 2 * s * r - n.z * r * r) / 8;
  return (level - curve * at.q * at.q) * (1 + n.z) / 2 + 1.5 * slope * first + 4 * curve * second;
}

/// What the shell blocks of a fragment outside it, of the dome: of what the tangent plane leaves of it, what the
/// horizon leaves too.
inline double blocked_beside_shell(const TransmittanceShell& shell, ShellCoordinates at, glm::dvec3 n, bool dome) {
  double even = 0;
  for (int j = 0; j < 5; ++j)
    even += quartic_sum(shell.outside + 5 * j, std::sqrt(std::max(at.q - 1, 0.0) * (at.q + 1)) / at.q) *
            std::pow(at.along, 2 * j);
  const double opacity = double(shell.opacity), whole = std::max(-at.along, 0.0) * opacity;
  const double cut = std::max(even - opacity * at.along / 2, 0.0);
  const double blocked = (std::abs(at.along) < 1 ? cut : whole) / (at.q * at.q * at.q);
  if (!dome) return blocked;
  const double h = std::clamp((1 - at.along) / 2, 0.0, 1.0), z = std::clamp((1 - at.rise) / 2, 0.0, 1.0);
  const double bound = n.z > 0 ? std::min(h, z) : std::max(h + z - 1, 0.0),
               joint = std::lerp(h * z, bound, std::abs(n.z));
  return blocked * joint / std::max(h, 1e-6);
}

/// V as fitted, of one shell about the origin.
inline double fitted_transmittance(const TransmittanceShell& shell, glm::dvec3 p, glm::dvec3 n, bool dome) {
  glm::dmat3 to_unit;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) to_unit[column][row] = double(shell.to_unit[4 * row + column]);
  const glm::dvec3 unit = to_unit * p, outward = double(shell.radius) * glm::transpose(to_unit) * unit;
  ShellCoordinates at;
  at.q = std::max(glm::length(unit), 1e-15);
  at.stretch = at.q / std::max(glm::length(outward), 1e-15);
  at.along = at.stretch * glm::dot(outward, n);
  at.rise = at.stretch * outward.z;
  const double open = dome ? (1 + n.z) / 2 : 1;
  double v = 0;
  if (at.q > 1) {
    double blocked = blocked_beside_shell(shell, at, n, dome);
    if (dome) {
      const ShellCoordinates rim{1, at.along / at.q, at.rise / at.q, at.stretch};
      const double on_rim = open - std::max(lune_transmittance(shell, rim, n, 0), 0.0);
      blocked += (on_rim - blocked_beside_shell(shell, rim, n, true)) * std::pow(at.q, -8);
    }
    v = std::max(open - blocked, 0.0);
  } else {
    const double half_chord = std::sqrt(std::max(1 - at.q, 0.0) * (1 + at.q));
    const double z = half_chord / (1 + double(shell.bend) * half_chord);
    const double decay = std::exp(-0.375 * double(shell.optical) * std::sqrt(at.stretch) * half_chord * half_chord);
    double sum = 0;
    if (dome) {
      sum = lune_transmittance(shell, at, n, z);
    } else {
      const int powers[] = {0, 1, 2, 4, 6};
      for (int j = 0; j < 5; ++j) sum += quartic_sum(shell.within + 5 * j, z) * std::pow(at.along, powers[j]);
    }
    v = std::max(decay * sum, 0.0);
  }
  return std::clamp(double(shell.near_share) * v, 0.0, 1.0);
}

}  // namespace understory::reference
