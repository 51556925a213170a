// environment: V times the radiance under a constant sky, closed forms under a sky that is bright in a cap, the device
// against double, mirrored cones.
#include "host/passes/environment.hpp"

#include <gtest/gtest.h>

#include "host/passes/ambient.hpp"
#include "kernels/shared/cone.h"
#include "kernels/shared/environment.h"
#include "tests/reference/environment.hpp"
#include "tests/support/environments.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fragments.hpp"

namespace understory {
namespace {

/// Bilinear in cells of up to 33 nodes and 25 levels, whose coordinates are rounded to 24 bits; light within (0, 1).
constexpr double lookup = 2e-5;

const std::vector<Owner> owners{
    {}, {SurfaceClass::terrain, "", -1, {}, -1, -1}, {SurfaceClass::occluder, "", -1, {}, -1, -1}};

struct LitFragment {
  TestFragment fragment;
  float visibility = 1;
  reference::ConeOfFragment cone;
};

std::vector<LitFragment> random_fragments(std::size_t count) {
  std::vector<LitFragment> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(11, stream_of("lit"), i);
    all[i].fragment.normal = random_direction(random);
    all[i].fragment.position = 5.0f * random_direction(random);
    all[i].fragment.owner = 1;
    all[i].cone.axis = glm::dvec3(random_direction(random));
    if (i % 4 != 0) {  // else no cone
      all[i].cone.aperture = double(float(random.uniform(0.001, 0.6)));
      all[i].cone.share = double(float(random.uniform(0, 0.9)));
    }
    all[i].visibility = float(random.uniform(0, 1) * (1 - all[i].cone.share));
  }
  return all;
}

std::vector<TestFragment> fragments_of(const std::vector<LitFragment>& lit) {
  std::vector<TestFragment> all;
  for (const LitFragment& one : lit) all.push_back(one.fragment);
  return all;
}

/// One channel of the light, checked to lie in [0, 1].
std::vector<float> light(const std::vector<LitFragment>& lit, const PrefilteredEnvironment& environment, Sky sky,
                         std::size_t channel, const Gloss& gloss = {}, bool cones = true) {
  const auto pass = [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& out) {
    const auto plane = [&](float wild, auto member) {
      std::vector<float> values(planes.padded_fragments, wild);
      for (std::size_t i = 0; i < lit.size(); ++i) values[i] = static_cast<float>(member(lit[i]));
      return Buffer<float>(device, std::span<const float>(values), "test");
    };
    const Buffer<float> visibility = plane(NAN, [](const auto& f) { return f.visibility; });
    const ConePlanes cone{plane(NAN, [](const auto& f) { return f.cone.axis.x; }),
                          plane(INFINITY, [](const auto& f) { return f.cone.axis.y; }),
                          plane(0, [](const auto& f) { return f.cone.axis.z; }),
                          plane(-1, [](const auto& f) { return f.cone.aperture; }),
                          plane(NAN, [](const auto& f) { return f.cone.share; })};
    const EnvironmentTables tables(device, environment, sky);
    const OwnerTables table = upload_owners(device, owners);
    std::array<Buffer<float>, 3> colours;
    for (Buffer<float>& colour : colours) colour = Buffer<float>(device, planes.padded_fragments, "light");
    EnvironmentPass(device, lanes).run(planes, table, visibility, cones ? &cone : nullptr, tables, gloss, colours);
    out.write(colours[channel].read());
  };
  return shade_everywhere(fragments_of(lit), pass).visibility;
}

TEST(EnvironmentLight, BesideAConeIsTheRestOfTheSky) {
  // A quarter of the light at radiance 3 is hidden: 2 = (1/4) 3 + (3/4) 5/3.
  EXPECT_NEAR(light_beside_cone(0.75, 0.25, 2, 3), 2 - 0.75, 1e-12);
  EXPECT_NEAR(light_beside_cone(0.3, 0.25, 2, 3), 0.4 * 1.25, 1e-12);  // the rest hides 0.6 more
  EXPECT_EQ(light_beside_cone(0, 1, 2, 2), 0);                         // all hidden
  EXPECT_EQ(light_beside_cone(0.5, 0.5, 1, 9), 0);                     // the floor
  EXPECT_NEAR(light_beside_cone(0.9, 0.25, 2, 3), 1.25 + 0.15 * 2, 1e-12);
}

TEST(EnvironmentLight, AConstantSkyGivesVisibilityTimesItsRadiance) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<LitFragment> lit = random_fragments(1003);
  for (const Sky sky : {Sky::dome, Sky::sphere}) {
    const PrefilteredEnvironment e = prefilter(constant_environment({0.75f, 0.5f, 0.25f}), 0, sky, {9, 9, 9});
    const std::vector<float> green = light(lit, e, sky, 1);
    for (std::size_t i = 0; i < lit.size(); ++i) EXPECT_NEAR(green[i], 0.5f * lit[i].visibility, 5e-6) << i;
  }
}

TEST(EnvironmentLight, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  const PrefilteredEnvironment e = prefilter(smooth_environment(), 0.4, Sky::sphere, {17, 17, 13});
  for (const std::size_t size : odd_sizes) {
    const std::vector<LitFragment> lit = random_fragments(size);
    for (const std::size_t channel : {0u, 1u, 2u}) {
      const std::vector<float> shaded = light(lit, e, Sky::sphere, channel);
      for (std::size_t i = 0; i < size; ++i) {
        const glm::dvec3 exact =
            reference::environment(e, glm::dvec3(lit[i].fragment.normal), double(lit[i].visibility), lit[i].cone);
        EXPECT_NEAR(shaded[i], exact[static_cast<int>(channel)], lookup) << i;
      }
    }
  }
}

TEST(EnvironmentLight, AnOccludedSunIsDarkAndAnOpenOneIsNot) {
  UNDERSTORY_NEEDS_DEVICE();
  // All light comes from a cap of 30 degrees about the normal; cones of 60 degrees cover it, or lie beside it.
  const glm::dvec3 up(0, 0, 1);
  const double cap = (1 - std::cos(0.5236)) / 2, cone = 0.25;
  const PrefilteredEnvironment e = prefilter(cap_environment(up, std::cos(0.5236)), 0, Sky::sphere);
  const double seen = clip_cosine(cap, 1);
  std::vector<LitFragment> lit(2);
  for (LitFragment& one : lit) {
    one.fragment.owner = 1;
    one.cone = {up, cone, clip_cosine(cone, 1)};
    one.visibility = float(1 - one.cone.share);
  }
  lit[1].cone = {{1, 0, 0}, cone, clip_cosine(cone, 0)};
  lit[1].visibility = float(1 - lit[1].cone.share);
  const std::vector<float> shaded = light(lit, e, Sky::sphere, 0);
  // The mean radiance of the cone times its share is not all of the cap's light, which is brightest near the normal.
  EXPECT_NEAR(shaded[0], seen - lit[0].cone.share * cap / cone, 0.02);
  EXPECT_NEAR(shaded[1], seen, 0.03);
  EXPECT_LT(shaded[0], 0.3 * shaded[1]);
}

TEST(EnvironmentLight, WithoutConesItIsTheOpenSkyTimesVisibility) {
  UNDERSTORY_NEEDS_DEVICE();
  const PrefilteredEnvironment e = prefilter(smooth_environment(), 0, Sky::dome, {17, 17, 13});
  const std::vector<LitFragment> lit = random_fragments(99);
  const std::vector<float> shaded = light(lit, e, Sky::dome, 2, {}, false);
  for (std::size_t i = 0; i < lit.size(); ++i) {
    const double exact = reference::in_square(e.normals, 0, 17, glm::dvec3(lit[i].fragment.normal)).z;
    EXPECT_NEAR(shaded[i], exact * double(lit[i].visibility), lookup);
  }
}

TEST(EnvironmentLight, OccludersMirrorAConeOfTheSky) {
  UNDERSTORY_NEEDS_DEVICE();
  const double half_angle = 0.35, aperture = (1 - std::cos(half_angle)) / 2;
  const PrefilteredEnvironment e = prefilter(smooth_environment(), 0, Sky::sphere, {17, 33, 25});
  const Gloss gloss{class_bit(SurfaceClass::occluder), half_angle, glm::vec3(0, 0, 4)};
  std::vector<LitFragment> lit = random_fragments(333);
  for (LitFragment& one : lit) one.fragment.owner = 2;
  const std::vector<float> shaded = light(lit, e, Sky::sphere, 0, gloss);
  for (std::size_t i = 0; i < lit.size(); ++i) {
    const glm::dvec3 view = glm::normalize(glm::dvec3(lit[i].fragment.position - gloss.eye));
    const glm::dvec3 mirrored = glm::reflect(view, glm::dvec3(lit[i].fragment.normal));
    const reference::ConeOfFragment& cone = lit[i].cone;
    const double rest = double(lit[i].visibility) / (1 - cone.share);
    const double hidden =
        cone.aperture > 0 ? overlap_of_apertures(aperture, cone.aperture, glm::dot(mirrored, cone.axis)) / aperture : 0;
    const double bright = reference::in_cone(e, mirrored, aperture).x;
    EXPECT_NEAR(shaded[i], std::min(1.0, rest) * (1 - hidden) * bright, 2e-4) << i;
  }
}

TEST(EnvironmentLight, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  const PrefilteredEnvironment e = prefilter(smooth_environment(), 0, Sky::dome, {9, 9, 9});
  const double bad[] = {double(NAN), double(INFINITY), -1, 0, 1e-40, 3, -1e38};
  std::vector<LitFragment> lit;
  for (const TestFragment& fragment : garbage(2))
    for (const double b : bad) lit.push_back({fragment, float(b), {glm::dvec3(b, 1, b), b, b}});
  for (LitFragment& one : lit)
    if (std::isnan(one.fragment.position.x)) one.fragment.validity = validity::not_finite;
  const Gloss gloss{class_bit(SurfaceClass::occluder), 0.3, glm::vec3(1)};
  const std::vector<float> shaded = light(lit, e, Sky::dome, 0, gloss);  // expects [0, 1]
  for (std::size_t i = 0; i < lit.size(); ++i)
    if (lit[i].fragment.validity != 0) {
      EXPECT_EQ(shaded[i], 0);
    }
}

TEST(EnvironmentLight, NamesWhatDoesNotFit) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const FragmentPlanes planes = allocate_planes(device, 300, 1, false);
  const EnvironmentTables tables(device, prefilter(constant_environment(glm::vec3(1)), 0, Sky::dome, {5, 5, 3}),
                                 Sky::dome);
  std::array<Buffer<float>, 3> colours;
  for (Buffer<float>& colour : colours) colour = Buffer<float>(device, 300, "light");
  const std::string message = message_of(ErrorKind::unexpected, [&] {
    const Buffer<float> visibility(device, planes.padded_fragments, "visibility");
    EnvironmentPass(device).run(planes, upload_owners(device, owners), visibility, nullptr, tables, {}, colours);
  });
  EXPECT_NE(message.find("environment: plane light has 300 elements, 512 are needed"), std::string::npos) << message;
}

}  // namespace
}  // namespace understory
