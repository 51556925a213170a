// The polynomials that replace library functions, in double, against the library over their whole domains.
#include "kernels/shared/exp_minus.h"

#include <gtest/gtest.h>

#include <numbers>

#include "kernels/shared/arc_tangent.h"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

TEST(ExpMinus, IsTheExponential) {
  for (int i = 0; i <= 870000; ++i) {
    const double x = i * 1e-4, exact = std::exp(-x);
    ASSERT_NEAR(exp_minus(x), exact, tolerance::exp_minus) << x;
    ASSERT_NEAR(exp_minus(x) / exact, 1, tolerance::exp_minus_relative) << x;
  }
}

TEST(ExpMinus, IsExactAtZeroAndNothingFarOut) {
  EXPECT_EQ(exp_minus(0.0), 1.0);
  for (const double x : {1e3, 1e30, double(INFINITY), double(NAN)}) {
    EXPECT_GE(exp_minus(x), 0.0) << x;
    EXPECT_LT(exp_minus(x), 1e-37) << x;
  }
}

TEST(ExpMinus, NeverRisesBeyondItsError) {
  for (int i = 0; i < 100000; ++i)
    ASSERT_LE(exp_minus((i + 1) * 1e-4), exp_minus(i * 1e-4) + tolerance::exp_minus) << i;
}

TEST(ArcTangent, IsTheArcTangentOfTheQuadrant) {
  for (int i = 0; i <= 100000; ++i) {
    const double angle = i * std::numbers::pi / 2 / 100000;
    for (const double length : {1e-10, 1.0, 1e20})
      ASSERT_NEAR(arc_tangent(length * std::sin(angle), length * std::cos(angle)), angle, tolerance::arc_tangent);
  }
}

TEST(ArcTangent, IsDefinedAtTheOrigin) { EXPECT_EQ(arc_tangent(0.0, 0.0), 0.0); }

TEST(Limits, TakeTheNamedSideForWhatIsNotANumber) {
  EXPECT_EQ(at_least(double(NAN), 2.0), 2.0);
  EXPECT_EQ(at_most(double(NAN), 2.0), 2.0);
  EXPECT_EQ(as_visibility(double(NAN)), 1.0);
  EXPECT_EQ(as_visibility(-1.0), 0.0);
  EXPECT_EQ(as_visibility(7.0), 1.0);
}

}  // namespace
}  // namespace understory
