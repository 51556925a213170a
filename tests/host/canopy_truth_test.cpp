// The truth of the ground under an endless random canopy against the exponential integral.
#include "bench/canopy_truth.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace understory {
namespace {

TEST(CanopyTruth, MeetsTheExponentialIntegral) {
  const double expected[][2] = {{0.5, 0.649368}, {1, 0.443209}, {2, 0.219384}, {3, 0.113479}, {6, 0.017861}};
  for (const auto& [leaf_area_index, visibility] : expected) {
    const CanopyTruth canopy = trace_canopy(leaf_area_index, 5, 256);
    EXPECT_NEAR(canopy.closed_form, visibility, 1e-6) << "FORMULAS.md, analytic truths";
    const double error = std::abs(canopy.traced - visibility);
    EXPECT_TRUE(error <= 0.02 * visibility || error <= 3 * canopy.standard_error)
        << "LAI " << leaf_area_index << ": " << canopy.traced << " +- " << canopy.standard_error << ", not "
        << visibility;
    EXPECT_LT(canopy.standard_error, 0.05 * visibility) << "LAI " << leaf_area_index << ": too noisy to tell";
  }
}

}  // namespace
}  // namespace understory
