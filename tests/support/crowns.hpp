// Fragments in crowns made by chance, for tests of the tree methods.
#pragma once
#include <vector>

#include "tests/support/fragments.hpp"
#include "tests/support/test_crown.hpp"

namespace understory {

/// Fragments in and a little outside the crowns that own them, every eighth without a crown.
inline std::vector<TestFragment> crown_fragments(std::size_t count, const std::vector<TestCrown>& crowns) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(11, stream_of("crown fragment"), i);
    const std::size_t crown = random.below(crowns.size());
    const double distance = crowns[crown].radius * 1.1 * std::cbrt(random.uniform());
    TestFragment fragment;
    fragment.position = glm::vec3(crowns[crown].centre + distance * glm::dvec3(random_direction(random)));
    fragment.normal = random_direction(random);
    fragment.owner = static_cast<std::uint32_t>(i % 8 == 7 ? crowns.size() + 1 : crown + 1);
    all.push_back(fragment);
  }
  return all;
}

inline std::vector<TestCrown> random_crowns(std::size_t count) {
  std::vector<TestCrown> crowns;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(5, stream_of("crown"), i);
    crowns.push_back(random_crown(random));
  }
  return crowns;
}

}  // namespace understory
