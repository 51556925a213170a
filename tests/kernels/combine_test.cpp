// combine: the product of terms, whose dome factor, and what is open; against a plain loop.
#include "host/passes/combine.hpp"

#include <gtest/gtest.h>

#include <array>

#include "host/passes/ambient.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

constexpr std::uint32_t classes = 6;  // one owner of each class

OwnerTables class_owners(Device& device) {
  std::vector<Owner> owners(classes);
  for (std::uint32_t i = 0; i < classes; ++i) owners[i].surface = static_cast<SurfaceClass>(i);
  return upload_owners(device, owners);
}

constexpr std::size_t term_count = 7, dome = 5, near = 6;

std::vector<TestFragment> mixed_fragments(std::size_t count) {
  std::vector<TestFragment> all;
  const std::uint32_t codes[] = {0, 0, 0, validity::outside_model, validity::background, validity::not_finite};
  for (std::size_t i = 0; i < count; ++i) {
    Random random(10, stream_of("mixed"), i);
    TestFragment f;
    f.owner = static_cast<std::uint32_t>(random.below(classes));
    f.validity = codes[random.below(std::size(codes))];
    all.push_back(f);
  }
  return all;
}

float term_value(std::size_t term, std::size_t fragment) {
  Random random(12, stream_of("term", term), fragment);
  return static_cast<float>(random.uniform());
}

Shaded combine_terms(const std::vector<TestFragment>& fragments, std::uint32_t present, std::uint32_t horizon_classes,
                     bool near_is_limit = false) {
  return shade_everywhere(fragments, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    std::array<Buffer<float>, term_count> terms;
    for (std::size_t term = 0; term < term_count; ++term) {
      std::vector<float> values(planes.padded_fragments, NAN);
      for (std::size_t i = 0; i < fragments.size(); ++i) values[i] = term_value(term, i);
      terms[term] = Buffer<float>(device, std::span<const float>(values), "term");
    }
    VisibilityTerms all;
    const Buffer<float>** places[] = {&all.ambient,   &all.tree, &all.grass, &all.crowns,
                                      &all.occluders, &all.dome, &all.near};
    for (std::size_t term = 0; term < term_count; ++term)
      if (present >> term & 1) *places[term] = &terms[term];
    all.horizon_classes = horizon_classes;
    all.near_is_limit = near_is_limit;
    CombinePass(device, lanes).run(planes, class_owners(device), all, visibility);
  });
}

TEST(Combine, IsTheProductOfThePresentTerms) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::uint32_t blades = class_bit(SurfaceClass::blade);
  for (const std::size_t size : odd_sizes)
    for (const std::uint32_t present : {0u, 0b1111111u, 0b0100110u, 0b1001001u}) {
      const std::vector<TestFragment> fragments = mixed_fragments(size);
      const Shaded shaded = combine_terms(fragments, present, blades);
      for (std::size_t i = 0; i < size; ++i) {
        double exact = 1;
        for (std::size_t term = 0; term < term_count; ++term) {
          const bool has_horizon = term == dome && fragments[i].owner == std::uint32_t(SurfaceClass::blade);
          if ((present >> term & 1) && !has_horizon) exact *= static_cast<double>(term_value(term, i));
        }
        if (fragments[i].validity & (validity::background | validity::not_finite)) exact = 1;
        EXPECT_NEAR(shaded.visibility[i], exact, tolerance::combine) << i << ' ' << present;
        EXPECT_EQ(shaded.validity[i], fragments[i].validity);
      }
    }
}

TEST(Combine, TheNearFieldMayBeALimit) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<TestFragment> fragments = mixed_fragments(333);
  const Shaded shaded = combine_terms(fragments, 1u << near | 0b10u, 0, true);
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const bool open = fragments[i].validity & (validity::background | validity::not_finite);
    EXPECT_EQ(shaded.visibility[i], open ? 1 : std::min(term_value(1, i), term_value(near, i)));
  }
}

TEST(Combine, EveryClassMayHoldItsHorizon) {
  UNDERSTORY_NEEDS_DEVICE();
  for (std::uint32_t chosen = 0; chosen < classes; ++chosen) {
    std::vector<TestFragment> fragments(classes);
    for (std::uint32_t i = 0; i < classes; ++i) fragments[i].owner = i;
    const Shaded shaded = combine_terms(fragments, 1u << dome, 1u << chosen);
    for (std::uint32_t i = 0; i < classes; ++i) EXPECT_EQ(shaded.visibility[i], i == chosen ? 1 : term_value(dome, i));
  }
}

}  // namespace
}  // namespace understory
