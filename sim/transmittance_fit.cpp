#include "sim/transmittance_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/crown.hpp"
#include "sim/gauss.hpp"

namespace understory {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int powers_of_z = 5;
constexpr int minimax_rounds = 25;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Coefficients of least squared error, and with more `rounds` of least largest error: Lawson's iteratively reweighted
/// least squares (Lawson 1961).
Vector least_error(const Matrix& terms, const Vector& values, int rounds) {
  Vector weights = Vector::Ones(values.size()), best = Vector::Zero(terms.cols());
  double least = values.cwiseAbs().maxCoeff();
  for (int round = 0; round < rounds && least > 1e-7; ++round) {
    const Vector root = weights.cwiseSqrt();
    const Matrix weighted = root.asDiagonal() * terms;
    // The normal equations lose digits, but a ridge of 1e-12 keeps their error far below that of the fit.
    Matrix normal = weighted.transpose() * weighted;
    normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
    const Vector fit = normal.ldlt().solve(weighted.transpose() * root.cwiseProduct(values));
    const Vector error = (terms * fit - values).cwiseAbs();
    const double largest = error.maxCoeff();
    if (largest < least) least = largest, best = fit;
    weights = weights.cwiseProduct(((0.9 / largest) * error).array().matrix() + Vector::Constant(error.size(), 0.1));
    weights /= weights.mean();
  }
  return best;
}

/// (1/pi) integral over the azimuth of max(0, n.w) for directions w at cosine `c` from an axis at cosine `m` from n.
double cosine_ring(double c, double m) {
  const double middle = m * c, swing = std::sqrt(std::max((1 - m * m) * (1 - c * c), 0.0));
  if (middle >= swing) return 2 * middle;
  if (middle <= -swing) return 0;
  const double angle = std::acos(-middle / swing);
  return 2 / pi * (middle * angle + swing * std::sin(angle));
}

/// Nodes in [-1, 1] that crowd at 0, where light grazes the shell.
std::vector<GaussNode> grazing_nodes() {
  std::vector<double> borders{0};
  for (double border = 1e-4; border < 1.001; border *= std::pow(10, 0.4)) borders.push_back(border);
  std::vector<GaussNode> nodes;
  for (std::size_t i = 1; i < borders.size(); ++i)
    for (const GaussNode node : gauss_nodes(10, borders[i - 1], borders[i])) {
      nodes.push_back(node);
      nodes.push_back({-node.at, node.weight});
    }
  return nodes;
}

/// A fragment within a shell, in the fit's variables, and what it sees.
struct Seen {
  double square, along, stretch, visibility;
};

std::vector<double> cosines() {
  std::vector<double> all;
  for (int i = 0; i < 17; ++i) all.push_back(std::cos(pi * (i + 0.5) / 17));
  return all;
}

/// Places within a sphere of optical radius `optical`: exact quadrature over circles about the axis through them.
std::vector<Seen> seen_in_sphere(double optical) {
  const std::vector<GaussNode> nodes = grazing_nodes();
  std::vector<double> distances;
  for (int i = 0; i <= 24; ++i) {
    distances.push_back(i / 24.0);
    distances.push_back(1 - std::pow(10, -6 + i / 4.0));
    distances.push_back(std::max(0.0, 1 - (i + 0.5) / (3 * std::max(optical, 8.0))));
  }
  std::vector<Seen> all;
  for (const double m : cosines()) {
    std::vector<double> ring;
    for (const GaussNode& node : nodes) ring.push_back(node.weight * cosine_ring(node.at, m));
    for (const double q : distances) {
      double sum = 0;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double c = nodes[i].at;
        sum += ring[i] * std::exp(-optical * (std::sqrt(1 - q * q * (1 - c * c)) - q * c));
      }
      all.push_back({q * q, q * m, 1, sum});
    }
  }
  return all;
}

/// Point i of N spread evenly over the sphere (Fibonacci lattice).
glm::dvec3 spread_direction(int i, int count) {
  const double z = 1 - (2 * i + 1.0) / count, turn = 2.399963229728653 * i, flat = std::sqrt(1 - z * z);
  return {flat * std::cos(turn), flat * std::sin(turn), z};
}

/// Places within an ellipsoid, radii in units of their geometric mean, half of them near its surface; or `outside`, up
/// to half a radius away, where what sticks out of a crown is.
std::vector<Seen> seen_by_ellipsoid(const glm::dvec3& radii, double optical, bool outside) {
  constexpr int places = 1200, directions = 512;
  std::vector<glm::dvec3> sky;
  for (int i = 0; i < directions; ++i) sky.push_back(spread_direction(i, directions));
  std::vector<Seen> all;
  for (int i = 0; i < places; ++i) {
    // Kronecker sequence of the plastic number for depth; a lattice of another length for the normal.
    const double share = std::fmod(0.5 + i * 0.7548776662466927, 1.0);
    const double q = outside ? 1 + 0.5 * share : i % 2 ? std::cbrt(share) : 1 - share / std::max(optical, 2.0);
    const glm::dvec3 p = q * spread_direction(i, places), n = spread_direction((i * 377) % places, places);
    double sum = 0;
    for (const glm::dvec3& w : sky) {
      const double facing = glm::dot(n, w);
      if (facing <= 0) continue;
      const glm::dvec3 step = w / radii;
      const double a = glm::dot(step, step), b = glm::dot(p, step), c = glm::dot(p, p) - 1;
      const double root = std::sqrt(std::max(b * b - a * c, 0.0));
      const double way = std::max((root - b) / a, 0.0) - std::max((-root - b) / a, 0.0);
      sum += facing * std::exp(-optical * way);
    }
    const glm::dvec3 g = p / radii;
    const double stretch = std::sqrt(glm::dot(p, p) / std::max(glm::dot(g, g), 1e-30));
    all.push_back({q * q, stretch * glm::dot(g, n), stretch, sum * 4 / directions});
  }
  return all;
}

/// `powers`: of s.
void fit_within(const std::vector<Seen>& seen, const std::vector<int>& powers, int rounds, TransmittanceShell& shell) {
  const auto rows = static_cast<Eigen::Index>(seen.size());
  Matrix terms(rows, powers_of_z * static_cast<Eigen::Index>(powers.size()));
  Vector values(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Seen& at = seen[static_cast<std::size_t>(row)];
    const double gap = std::max(1 - at.square, 0.0), half_chord = std::sqrt(gap);
    const double z = half_chord / (1 + double(shell.bend) * half_chord);
    const double decay = std::exp(-0.375 * double(shell.optical) * std::sqrt(at.stretch) * gap);
    for (std::size_t j = 0; j < powers.size(); ++j)
      for (int i = 0; i < powers_of_z; ++i)
        terms(row, powers_of_z * static_cast<Eigen::Index>(j) + i) =
            decay * std::pow(z, i) * std::pow(at.along, powers[j]);
    values(row) = at.visibility;
  }
  const Vector fit = least_error(terms, values, rounds);
  for (Eigen::Index i = 0; i < fit.size(); ++i) shell.within[i] = static_cast<float>(fit(i));
}

// E = O/2 + sum over j < 4 of E_j(cone) (s^2j - s^8): at |s| = 1, where the tangent plane touches the disc, it is O/2
// whatever the fit, so that V is continuous there.
constexpr int free_outside = 20;

/// What the fit's coefficients multiply at a place outside.
void set_outside_terms(double cone, double s, double weight, Matrix& terms, Eigen::Index row) {
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < powers_of_z; ++i)
      terms(row, powers_of_z * j + i) = weight * std::pow(cone, i) * (std::pow(s, 2 * j) - std::pow(s, 8));
}

/// Of E_0 to E_3, those of TransmittanceShell: powers of s up to the eighth.
void set_outside(const Vector& fit, TransmittanceShell& shell) {
  for (int i = 0; i < powers_of_z; ++i) {
    double last = 0;
    for (int j = 0; j < 4; ++j) {
      last -= fit(powers_of_z * j + i);
      shell.outside[powers_of_z * j + i] = static_cast<float>(fit(powers_of_z * j + i));
    }
    shell.outside[free_outside + i] = static_cast<float>(last);
  }
  shell.outside[0] = static_cast<float>(fit(0) + 0.5 * double(shell.opacity));
}

/// E of a sphere: what its disc blocks where the tangent plane cuts it, without the part that is odd in s.
void fit_outside(double optical, TransmittanceShell& shell) {
  const std::vector<GaussNode> nodes = gauss_nodes(40, 0, pi / 2);  // of asin(distance of a chord from the centre)
  std::vector<double> inverses;
  for (int i = 0; i < 24; ++i) {
    inverses.push_back(0.05 + 0.945 * (i / 23.0));
    inverses.push_back(1 - std::pow(10, -3.5 + 3 * i / 23.0));
  }
  const auto heights = cosines();
  Matrix terms(static_cast<Eigen::Index>(inverses.size() * heights.size()), free_outside);
  Vector values(terms.rows());
  Eigen::Index row = 0;
  for (const double w : inverses)
    for (const double s : heights) {
      double blocked = 0;
      for (const GaussNode& node : nodes) {
        const double b = std::sin(node.at), c = std::sqrt(1 - b * b * w * w);
        const double dc = b * w * w / c * std::cos(node.at);
        blocked += node.weight * dc * cosine_ring(-c, s * w) * (1 - std::exp(-2 * optical * std::cos(node.at)));
      }
      const double cube = w * w * w, cone = std::sqrt(1 - w * w);
      set_outside_terms(cone, s, cube, terms, row);
      values(row++) = blocked + 0.5 * (s - 1) * double(shell.opacity) * cube;
    }
  set_outside(least_error(terms, values, minimax_rounds), shell);
}

/// The same for an ellipsoid, with the opacity that its disc has on average from places near it.
void fit_outside_ellipsoid(const std::vector<Seen>& seen, TransmittanceShell& shell) {
  const auto rows = static_cast<Eigen::Index>(seen.size());
  Matrix terms = Matrix::Zero(rows, free_outside + 1);
  Vector values = Vector::Zero(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Seen& at = seen[static_cast<std::size_t>(row)];
    const double w = 1 / std::sqrt(at.square), cube = w * w * w, cone = std::sqrt(std::max(1 - w * w, 0.0));
    if (at.along >= 1) continue;
    values(row) = 1 - at.visibility;
    terms(row, free_outside) = (at.along <= -1 ? -at.along : 0.5 * (1 - at.along)) * cube;
    if (at.along > -1) set_outside_terms(cone, at.along, cube, terms, row);
  }
  const Vector fit = least_error(terms, values, 1);
  shell.opacity = static_cast<float>(std::clamp(fit(free_outside), 0.0, 1.0));
  set_outside(fit, shell);
}

}  // namespace

TransmittanceShell fit_transmittance(const glm::dmat3& axes, glm::dvec3 radii, double k, bool dome) {
  TransmittanceShell shell{};
  shell.near_share = 1;
  const double radius = std::cbrt(radii.x * radii.y * radii.z);
  if (!(radius > 0) || !std::isfinite(radius)) {
    shell.within[0] = 1;
    return shell;
  }
  const bool sphere = glm::distance(radii / radius, glm::dvec3(1)) < 1e-5;
  const double optical = k > 0 ? std::min(k * radius, 1000.0) : 0;  // not a number: nothing there
  for (int axis = 0; axis < 3; ++axis)
    for (int column = 0; column < 3; ++column)
      shell.to_unit[4 * axis + column] = static_cast<float>(axes[axis][column] / radii[axis]);
  shell.radius = static_cast<float>(radius);
  shell.sphere = sphere ? static_cast<float>(1 / radius) : 0.0f;
  shell.optical = static_cast<float>(optical);
  shell.bend = static_cast<float>(1 + std::sqrt(optical) / 3);
  shell.opacity = static_cast<float>(1 - disc_transmittance(optical));
  // Higher powers help no ellipsoid: there the reduction to a sphere's variables decides.
  if (!sphere)
    fit_within(seen_by_ellipsoid(radii / radius, optical, false), {0, 1, 2}, 1, shell);
  else if (dome)
    fit_within(seen_in_sphere(optical), {0, 1, 2}, minimax_rounds, shell);
  else
    fit_within(seen_in_sphere(optical), {0, 1, 2, 4, 6}, minimax_rounds, shell);
  if (sphere)
    fit_outside(optical, shell);
  else
    fit_outside_ellipsoid(seen_by_ellipsoid(radii / radius, optical, true), shell);
  return shell;
}

std::vector<TransmittanceShell> fit_shells(const CrownShell& crown, const CrownModel& model, bool dome) {
  std::vector<TransmittanceShell> shells;
  const auto add = [&](const glm::vec3& centre, const glm::mat3& axes, const glm::vec3& radii) {
    shells.push_back(
        fit_transmittance(glm::dmat3(axes), glm::dvec3(model.shell_scale * radii), double(model.extinction), dome));
    shells.back().x = centre.x;
    shells.back().y = centre.y;
    shells.back().z = centre.z;
    shells.back().near_share = model.near_share;
  };
  if (crown.sphere_radius <= 0) return shells;
  if (model.shape == CrownShape::ellipsoid) add(crown.ellipsoid_centre, crown.ellipsoid_axes, crown.ellipsoid_radii);
  if (model.shape == CrownShape::sphere) add(crown.sphere_centre, glm::mat3(1), glm::vec3(crown.sphere_radius));
  if (model.shape == CrownShape::shells)
    for (const glm::vec4& shell : crown.shells) add(glm::vec3(shell), glm::mat3(1), glm::vec3(shell.w));
  return shells;
}

}  // namespace understory
