// Crowns and places in them for the stability of the tree methods.
#pragma once
#include <string>
#include <vector>

#include "bench/stability_case.hpp"
#include "tests/support/test_crown.hpp"

namespace understory {

/// A method that shades fragments by their crowns. Owner i + 1 has crown i.
struct CrownMethod {
  std::string name;
  std::function<void(Device&, const std::vector<TestCrown>&, FragmentPlanes&, Buffer<float>&)> shade;
  /// V of a fragment at `position` in the crown; made once per list of crowns.
  std::function<std::function<double(std::size_t crown, glm::dvec3 position, glm::dvec3 normal)>(
      const std::vector<TestCrown>&)>
      exact;
  double stated_error = 0, stated_jump = 0;
  std::string note = "";
  bool rises_as_foliage_thins = true, rises_along_normal = true;
};

/// Ordinary crowns, then every extreme of size, density, place and number.
std::vector<StabilityCase> crown_cases(const CrownMethod& method, std::size_t samples);

}  // namespace understory
