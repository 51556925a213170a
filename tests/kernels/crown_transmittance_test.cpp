// crown-transmittance: the fit against quadrature and closed forms, and the device against the same formula in double.
#include "host/passes/crown_transmittance.hpp"

#include <gtest/gtest.h>

#include "kernels/shared/crown_transmittance.h"
#include "sim/crown.hpp"
#include "sim/transmittance_fit.hpp"
#include "tests/reference/crown_transmittance.hpp"
#include "tests/support/crowns.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

const glm::dmat3 upright(1);

double visibility(const TransmittanceShell& shell, glm::dvec3 p, glm::dvec3 n, bool dome) {
  return crown_transmittance(shell, p.x, p.y, p.z, n.x, n.y, n.z, dome);
}

struct Errors {
  double largest = 0, squares = 0;
  int count = 0;
  void add(double error) {
    largest = std::max(largest, std::abs(error));
    squares += error * error;
    ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
};

/// A place in the unit ball: evenly, or near its surface where dense crowns change fastest.
glm::dvec3 place_within(Random& random, double optical) {
  const double q = random.uniform() < 0.5 ? std::cbrt(random.uniform()) : 1 - random.uniform() / std::max(optical, 2.0);
  return q * glm::normalize(glm::dvec3(random_direction(random)));
}

Errors errors_within(glm::dvec3 radii, double k, bool dome, int places) {
  const TransmittanceShell shell = fit_transmittance(upright, radii, k, dome);
  Errors errors;
  for (int i = 0; i < places; ++i) {
    Random random(3, stream_of("within"), static_cast<std::uint64_t>(i));
    const glm::dvec3 p = radii * place_within(random, k), n = glm::normalize(glm::dvec3(random_direction(random)));
    errors.add(visibility(shell, p, n, dome) - reference::crown_transmittance(p, n, radii, k, dome, 120));
  }
  return errors;
}

TEST(CrownTransmittance, HasNoStepWhereTheTangentPlaneLeavesTheCrown) {
  for (const bool dome : {false, true})
    for (const double k : {0.25, 1.0, 9.0, 64.0, 1000.0})
      for (const glm::dvec3 radii : {glm::dvec3(1), glm::dvec3(1.2, 0.9, 0.8)}) {
        const TransmittanceShell shell = fit_transmittance(upright, radii, k, dome);
        for (const double q : {1.001, 1.05, 1.5, 4.0})
          for (const double side : {-1.0, 1.0}) {
            // n.g = -1 and 1: above the crown, where g is upright and as long as q stretched.
            const auto at = [&](double s) {
              const double up = side * s / q;
              return visibility(shell, {0, 0, q * radii.z}, {std::sqrt(1 - up * up), 0, up}, dome);
            };
            EXPECT_NEAR(at(1 - 2e-7), at(1 + 2e-7), 1e-5) << k << ' ' << q << ' ' << side;
          }
      }
}

TEST(CrownTransmittance, SphereIsWithinAThousandthOfQuadrature) {
  for (const double k : {0.0, 0.03, 0.25, 0.7, 1.0, 1.7, 2.7, 4.0, 6.0, 9.0, 13.0, 19.0, 28.0, 40.0, 52.0, 64.0}) {
    const TransmittanceShell shell = fit_transmittance(upright, glm::dvec3(1), k, false);
    for (int i = 0; i < 90; ++i) {
      Random random(1, stream_of("sphere"), static_cast<std::uint64_t>(i));
      glm::dvec3 p = place_within(random, k);
      if (i % 3 == 0) p = glm::normalize(p) / random.uniform(i % 2 ? 0.02 : 0.8, 1);  // outside
      const glm::dvec3 n = glm::normalize(glm::dvec3(random_direction(random)));
      const double exact = reference::crown_transmittance(p, n, glm::dvec3(1), k, false, 240);
      EXPECT_NEAR(visibility(shell, p, n, false), exact, 1e-3 + tolerance::crown_quadrature)
          << k << " at " << glm::length(p);
    }
  }
}

TEST(CrownTransmittance, ClosedForms) {
  const glm::dvec3 up(0, 0, 1), far(0, 0, 40);
  for (const double k : {0.0, 0.5, 3.0, 20.0, 64.0}) {
    const TransmittanceShell shell = fit_transmittance(upright, glm::dvec3(2), k / 2, false);
    EXPECT_NEAR(visibility(shell, {0, 0, 0}, up, false), std::exp(-k), 1e-3);
    // All of the disc is seen: its blocked share times the cosine-weighted solid angle of a sphere.
    EXPECT_NEAR(visibility(shell, far, -up, false), 1 - (1 - disc_transmittance(k)) / 400, 1e-6);
    EXPECT_EQ(visibility(shell, far, up, false), 1);
    EXPECT_EQ(shell.near_share, 1);
  }
  // Impenetrable: on the surface half the sphere of directions is open. Beyond k R = 64 the fit is a little looser.
  const TransmittanceShell solid = fit_transmittance(upright, glm::dvec3(1), 1000, false);
  for (const double m : {-1.0, -0.3, 0.2, 1.0})
    EXPECT_NEAR(visibility(solid, {0, 0, 0.999999}, {std::sqrt(1 - m * m), 0, m}, false), 0.5 + 0.5 * m, 6e-3);
  // Nothing there: open.
  for (const double radius : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_EQ(visibility(fit_transmittance(upright, glm::dvec3(radius), 1, false), {0.1, 0, 0}, up, false), 1);
  EXPECT_NEAR(visibility(fit_transmittance(upright, glm::dvec3(1), NAN, false), {0.1, 0, 0}, up, false), 1, 1e-3);
}

TEST(CrownTransmittance, HorizonIsInTheModel) {
  // Against quadrature over the lune; the product with the open-dome factor is off by 0.03 (rms) and up to 0.2.
  for (const double k : {0.25, 1.0, 2.7, 8.0, 24.0, 64.0}) {
    const Errors errors = errors_within(glm::dvec3(1), k, true, 300);
    EXPECT_LT(errors.rms(), 0.006) << k;
    EXPECT_LT(errors.largest, 0.06) << k;
  }
}

TEST(CrownTransmittance, EllipsoidsAreReducedWithThisError) {
  // 1:1:3.8 is a Lombardy poplar, 1.5:1:1 a hedge, 1:1:0.4 a flat crown.
  for (const glm::dvec3 shape : {glm::dvec3(1, 1, 3.8), glm::dvec3(1.5, 1, 1), glm::dvec3(1, 1, 0.4)})
    for (const double k : {0.5, 2.0, 8.0})
      for (const bool dome : {false, true}) {
        const Errors errors = errors_within(shape / std::cbrt(shape.x * shape.y * shape.z), k, dome, 300);
        EXPECT_LT(errors.rms(), 0.045) << shape.z << ' ' << k << ' ' << dome;
        EXPECT_LT(errors.largest, 0.2) << shape.z << ' ' << k << ' ' << dome;
      }
}

TEST(CrownTransmittance, LuneMomentsAreThoseOfCountedDirections) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.8, 0.3, -0.2)), g(0.3, -0.5, 0.7);
  constexpr int count = 2'000'000;
  double first = 0, second = 0;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, turn = 2.399963229728653 * i, flat = std::sqrt(1 - z * z);
    const glm::dvec3 w(flat * std::cos(turn), flat * std::sin(turn), z);
    const double weight = w.z > 0 ? 4 * std::max(glm::dot(n, w), 0.0) / count : 0, along = glm::dot(g, w);
    first += weight * along;
    second += weight * along * along;
  }
  EXPECT_NEAR(lune_first(glm::dot(n, g), g.z, n.z), first, 5e-5);
  EXPECT_NEAR(lune_second(glm::dot(n, g), g.z, glm::dot(g, g), n.z), second, 1e-6);
}

/// A sphere, an ellipsoid, and a crown of three spheres; shells in the order of their crowns.
struct TestShells {
  std::vector<std::uint32_t> first{0, 1, 2, 5};
  std::vector<TransmittanceShell> shells;
  explicit TestShells(bool dome) {
    const auto add = [&](glm::vec3 centre, glm::dvec3 radii, double k) {
      shells.push_back(fit_transmittance(upright, radii, k, dome));
      shells.back().x = centre.x;
      shells.back().y = centre.y;
      shells.back().z = centre.z;
      shells.back().near_share = 0.875f;
    };
    add({1, 2, 3}, glm::dvec3(2), 1);
    add({-4, 0, 2}, glm::dvec3(1, 2, 3), 0.5);
    add({8, 1, 1}, glm::dvec3(1.5), 2);
    add({9, 1, 1}, glm::dvec3(1), 2);
    add({8, 2, 2}, glm::dvec3(1), 2);
  }
  /// In double, as the kernel multiplies them.
  double at(std::size_t crown, glm::dvec3 position, glm::dvec3 n, bool dome) const {
    const double open = dome ? open_dome(n.z) : 1;
    double v = open;
    for (std::uint32_t j = first[crown]; j < first[crown + 1]; ++j) {
      TransmittanceShell shell = shells[j];
      shell.near_share = 1;
      v *= visibility(shell, position - glm::dvec3(shell.x, shell.y, shell.z), n, dome) / std::max(open, 1e-6);
    }
    return std::min(0.875 * v, 1.0);
  }
};

std::vector<TestFragment> shell_fragments(std::size_t count, const TestShells& crowns) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(11, stream_of("shell fragment"), i);
    const std::size_t crown = random.below(3);
    const TransmittanceShell& shell = crowns.shells[crowns.first[crown]];
    TestFragment fragment;
    fragment.position = glm::vec3(shell.x, shell.y, shell.z) + 1.2f * shell.radius *
                                                                   static_cast<float>(std::cbrt(random.uniform())) *
                                                                   random_direction(random);
    fragment.normal = random_direction(random);
    fragment.owner = static_cast<std::uint32_t>(i % 8 == 7 ? 4 : crown + 1);
    all.push_back(fragment);
  }
  return all;
}

Shaded shade(const std::vector<TestFragment>& fragments, const TestShells& crowns, bool dome) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& out) {
    const Buffer<std::uint32_t> first(device, std::span<const std::uint32_t>(crowns.first), "first");
    const Buffer<TransmittanceShell> shells(device, std::span<const TransmittanceShell>(crowns.shells), "shells");
    CrownTransmittancePass(device, dome, lanes).run(planes, crown_owners(device, 3), first, 3, shells, out);
  });
}

TEST(CrownTransmittance, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const bool dome : {false, true}) {
    const TestShells crowns(dome);
    for (const std::size_t size : odd_sizes) {
      const std::vector<TestFragment> fragments = shell_fragments(size, crowns);
      const Shaded shaded = shade(fragments, crowns, dome);
      for (std::size_t i = 0; i < size; ++i) {
        const TestFragment& f = fragments[i];
        if (f.owner > 3) {
          EXPECT_EQ(shaded.visibility[i], 1);
          EXPECT_EQ(shaded.validity[i], 0u);
          continue;
        }
        EXPECT_NEAR(shaded.visibility[i],
                    crowns.at(f.owner - 1, glm::dvec3(f.position), glm::normalize(glm::dvec3(f.normal)), dome),
                    tolerance::crown_transmittance)
            << i << " of crown " << f.owner << (dome ? ", dome" : "");
      }
    }
  }
}

TEST(CrownTransmittance, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const bool dome : {false, true}) {
    TestShells crowns(dome);
    crowns.shells[0].radius = crowns.shells[0].sphere = NAN;
    crowns.shells[1].to_unit[5] = INFINITY;
    crowns.shells[2].within[3] = NAN;
    crowns.shells[3].outside[7] = -INFINITY;
    crowns.shells[4].sphere = 0;
    shade(garbage(5), crowns, dome);  // expects [0, 1]
  }
}

TEST(CrownTransmittance, NamesWhatDoesNotFit) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const TestShells crowns(false);
  const FragmentPlanes planes = allocate_planes(device, 300, 1, false);
  Buffer<float> visibility(device, planes.padded_fragments, "visibility");
  const Buffer<std::uint32_t> first(device, std::span<const std::uint32_t>(crowns.first), "first");
  const Buffer<TransmittanceShell> shells(device, std::span<const TransmittanceShell>(crowns.shells), "shells");
  const std::string message = message_of(ErrorKind::unexpected, [&] {
    CrownTransmittancePass(device, false).run(planes, crown_owners(device, 4), first, 4, shells, visibility);
  });
  EXPECT_NE(message.find("crown-transmittance: plane first shells has 4 elements, 5 are needed"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace understory
