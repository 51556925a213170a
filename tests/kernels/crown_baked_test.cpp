// crown-baked: texels against another form in double, corners exactly, texels that do not exist.
#include "host/passes/crown_baked.hpp"

#include <gtest/gtest.h>

#include "kernels/shared/crown_baked.h"
#include "tests/reference/crown_baked.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fragments.hpp"

namespace understory {
namespace {

/// Texel and place of each fragment.
struct TexelFragments {
  std::vector<std::uint32_t> texel, place;
};

Shaded shade(const TexelFragments& fragments, const std::vector<std::uint32_t>& texels) {
  return shade_everywhere(std::vector<TestFragment>(fragments.texel.size()),
                          [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
                            std::vector<std::uint32_t> texel = fragments.texel, place = fragments.place;
                            texel.resize(planes.padded_fragments, 0xdeadbeefu);
                            place.resize(planes.padded_fragments, 0xdeadbeefu);
                            allocate_texel_planes(device, planes);
                            planes.texel.write(texel);
                            planes.texel_place.write(place);
                            const Buffer<std::uint32_t> table(device, std::span<const std::uint32_t>(texels), "texels");
                            CrownBakedPass(device, lanes).run(planes, table, visibility);
                          });
}

TEST(CrownBaked, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<std::uint32_t> texels(777);
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = static_cast<std::uint32_t>(Random(1, stream_of("texel"), i).bits());
  for (const std::size_t size : odd_sizes) {
    TexelFragments fragments;
    for (std::size_t i = 0; i < size; ++i) {
      Random random(2, stream_of("texel fragment"), i);
      fragments.texel.push_back(static_cast<std::uint32_t>(random.below(texels.size() + 40)));
      fragments.place.push_back(static_cast<std::uint32_t>(random.bits()));
    }
    const Shaded shaded = shade(fragments, texels);
    for (std::size_t i = 0; i < size; ++i) {
      const bool known = fragments.texel[i] < texels.size();
      const double exact = known ? reference::texel_visibility(texels[fragments.texel[i]], fragments.place[i]) : 1;
      EXPECT_NEAR(shaded.visibility[i], exact, 2e-6) << i;
      EXPECT_EQ(shaded.validity[i], 0u);
    }
  }
}

TEST(CrownBaked, ClosedFormsAtTheCorners) {
  UNDERSTORY_NEEDS_DEVICE();
  // V = 0.1, 0.3, 0.7, 1.0 to half a step, and two values beyond [0, 1].
  const std::vector<std::uint32_t> texels{77u | 102u << 8 | 153u << 16 | 191u << 24,
                                          0u | 255u << 8 | 0u << 16 | 255u << 24};
  const std::uint32_t right = 4095, high = right << 12, level = 128u << 24;
  const Shaded shaded = shade({{0, 0, 0, 0, 1, 1, NO_TEXEL},
                               {level, level | right, level | high, level | right | high, level, level | right, 0}},
                              texels);
  const double expected[] = {0.1, 0.3, 0.7, 1.0, 0, 1, 1};
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_NEAR(shaded.visibility[i], expected[i], 0.004) << i;
}

TEST(CrownBaked, TiltScalesWhatIsSeen) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::uint32_t third = 102u;  // V = 0.3
  const Shaded shaded =
      shade({{0, 0, 0, 0}, {0, 64u << 24, 128u << 24, 255u << 24}}, {third | third << 8 | third << 16 | third << 24});
  const double expected[] = {0, 0.15, 0.3, 0.3 * 255 / 128};
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_NEAR(shaded.visibility[i], expected[i], 0.001) << i;
}

TEST(CrownBaked, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  TexelFragments fragments;
  for (const std::uint32_t number : {0u, 1u, 2u, 0x7fffffffu, 0x80000000u, 0xffffffffu})
    for (const std::uint32_t place : {0u, 0xffffu, 0xffff0000u, 0xffffffffu}) {
      fragments.texel.push_back(number);
      fragments.place.push_back(place);
    }
  const Shaded shaded = shade(fragments, {0xffffffffu});  // expects [0, 1]
  for (std::size_t i = 4; i < shaded.visibility.size(); ++i) EXPECT_EQ(shaded.visibility[i], 1);
}

TEST(CrownBaked, NamesWhatDoesNotFit) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const FragmentPlanes planes = allocate_planes(device, 300, 1, false);
  Buffer<float> visibility(device, 512, "visibility");
  const Buffer<std::uint32_t> texels(device, 1, "texels");
  const std::string message =
      message_of(ErrorKind::unexpected, [&] { CrownBakedPass(device).run(planes, texels, visibility); });
  EXPECT_NE(message.find("crown-baked: plane texel has 0 elements, 512 are needed"), std::string::npos) << message;
}

}  // namespace
}  // namespace understory
