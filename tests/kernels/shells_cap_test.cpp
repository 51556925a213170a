// shells-cap and shells-cap-levels: the device against eq. 4-6 in double, in the nearest of a crown's spheres.
#include "host/passes/shells_cap.hpp"

#include <gtest/gtest.h>

#include "tests/reference/shells_cap.hpp"
#include "tests/support/crowns.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

/// Crowns of one sphere, of one and a cluster, of one and four.
struct TestShells {
  std::vector<std::uint32_t> first{0, 1, 3, 8};
  std::vector<TestCrown> spheres = random_crowns(8);

  TestShells() {
    for (std::size_t crown = 0; crown < 3; ++crown)
      for (std::uint32_t j = first[crown] + 1; j < first[crown + 1]; ++j)
        spheres[j].centre = spheres[first[crown]].centre + glm::dvec3(j % 2, j % 3, 0.5 * j) - 1.0;
  }
  reference::CapSphere sphere(std::size_t i) const {
    const CrownRecord r = spheres[i].record();
    return {glm::dvec3(r.x, r.y, r.z), r.radius, r.alpha_rho};
  }
  double at(std::size_t crown, glm::dvec3 p, glm::dvec3 n, bool levels) const {
    std::vector<reference::CapSphere> clusters;
    for (std::uint32_t j = first[crown] + 1; j < first[crown + 1]; ++j) clusters.push_back(sphere(j));
    return reference::shells_cap(p, n, sphere(first[crown]), clusters, levels);
  }
};

std::vector<TestFragment> fragments_of(std::size_t count, const TestShells& crowns) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(13, stream_of("shells fragment"), i);
    const std::size_t crown = random.below(3);
    const TestCrown& sphere = crowns.spheres[crowns.first[crown]];
    TestFragment fragment;
    fragment.position =
        glm::vec3(sphere.centre + sphere.radius * std::cbrt(random.uniform()) * glm::dvec3(random_direction(random)));
    fragment.normal = random_direction(random);
    fragment.owner = static_cast<std::uint32_t>(i % 8 == 7 ? 4 : crown + 1);
    all.push_back(fragment);
  }
  return all;
}

Shaded shade(const std::vector<TestFragment>& fragments, const TestShells& crowns, bool levels) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& out) {
    const Buffer<std::uint32_t> first(device, std::span<const std::uint32_t>(crowns.first), "first");
    ShellsCapPass(device, levels, lanes)
        .run(planes, crown_owners(device, 3), first, 3, upload_crowns(device, crowns.spheres), out);
  });
}

TEST(ShellsCap, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  const TestShells crowns;
  for (const bool levels : {false, true})
    for (const std::size_t size : odd_sizes) {
      const std::vector<TestFragment> fragments = fragments_of(size, crowns);
      const Shaded shaded = shade(fragments, crowns, levels);
      for (std::size_t i = 0; i < size; ++i) {
        const TestFragment& f = fragments[i];
        const double exact =
            f.owner > 3 ? 1 : crowns.at(f.owner - 1, glm::dvec3(f.position), glm::dvec3(f.normal), levels);
        EXPECT_NEAR(shaded.visibility[i], exact, 2 * tolerance::crown) << i << (levels ? ", levels" : "");
      }
    }
}

TEST(ShellsCap, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  TestShells crowns;
  crowns.spheres[0].radius = 0;
  crowns.spheres[2].radius = INFINITY;
  crowns.spheres[4].centre.x = NAN;
  crowns.spheres[5].alpha_rho = NAN;
  crowns.spheres[6].alpha_rho = -1;
  for (const bool levels : {false, true}) shade(garbage(5), crowns, levels);  // expects [0, 1]
}

TEST(ShellsCap, NamesWhatDoesNotFit) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const TestShells crowns;
  const FragmentPlanes planes = allocate_planes(device, 300, 1, false);
  Buffer<float> visibility(device, planes.padded_fragments, "visibility");
  const Buffer<std::uint32_t> first(device, std::span<const std::uint32_t>(crowns.first), "first");
  const std::string message = message_of(ErrorKind::unexpected, [&] {
    ShellsCapPass(device, false)
        .run(planes, crown_owners(device, 4), first, 4, upload_crowns(device, crowns.spheres), visibility);
  });
  EXPECT_NE(message.find("shells-cap: plane first shells has 4 elements, 5 are needed"), std::string::npos) << message;
}

}  // namespace
}  // namespace understory
