// The committed sample sets, and the generator that they come from.
#include "host/passes/obscurance_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/sample_relaxation.hpp"

namespace understory {
namespace {

const int line_counts[] = {1, 4, 5, 7, 9, 12, 13, 15, 16}, point_counts[] = {6, 12, 33};

TEST(ObscuranceSamples, SharesSumToOneWithinTheBall) {
  const auto check = [](const ObscuranceSampleSet& set) {
    double constant = 0, quadratic = 0;
    for (const ObscuranceSample& sample : set.samples) {
      EXPECT_LT(sample.x * sample.x + sample.y * sample.y + sample.z * sample.z, 1);
      EXPECT_GT(sample.constant_share, 0);
      constant += double{sample.constant_share};
      quadratic += double{sample.quadratic_share};
    }
    EXPECT_NEAR(constant, 1, 1e-5);
    EXPECT_NEAR(quadratic, 1, 1e-5);
    if (set.centre) {
      EXPECT_EQ(set.samples[0].x, 0);
      EXPECT_EQ(set.samples[0].y, 0);
    }
  };
  for (const int count : line_counts) check(line_samples(count));
  for (const int count : point_counts) check(point_samples(count));
}

TEST(ObscuranceSamples, FewLinesAreAsGoodAsManyPoints) {
  EXPECT_LT(line_samples(5).noise, point_samples(12).noise);
  EXPECT_LT(line_samples(16).noise, point_samples(33).noise);
}

TEST(ObscuranceSamples, TheTableIsTheGenerators) {
  // Five lines with all starts: the committed set, up to the rounding of the table.
  const RelaxedSamples made = relax_samples(SampleDomain::disc, 5, true, line_samples(5).seed, 30, true);
  ASSERT_EQ(made.points.size(), 5u);
  EXPECT_NEAR(made.noise, line_samples(5).noise, 2e-4);
  EXPECT_NEAR(sample_noise(made), made.noise, 1e-12);
  for (std::size_t i = 0; i < 5; ++i) {
    // Up to a turn of the whole set: radii and shares.
    EXPECT_NEAR(glm::length(made.points[i]), std::hypot(line_samples(5).samples[i].x, line_samples(5).samples[i].y),
                0.02);
    EXPECT_NEAR(made.constant_share[i], line_samples(5).samples[i].constant_share, 0.01);
  }
}

TEST(ObscuranceSamples, SomeCountsDivideTheBallMoreEvenly) {
  // Section 4.5: 6 and 12 points, 9, 13 and 16 lines with the centre and 12, 13 and 15 without it come out better than
  // their neighbours. What singles them out is how evenly their Voronoi regions share the volume.
  const auto deviation = [](SampleDomain domain, int count, bool centre) {
    return relax_samples(domain, count, centre, 1, 6, false).deviation;
  };
  const auto disc = [&](int count, bool centre) { return deviation(SampleDomain::disc, count, centre); };
  EXPECT_LT(disc(9, true), 0.5 * disc(10, true));
  EXPECT_LT(disc(16, true), disc(17, true));
  EXPECT_LT(disc(12, false), disc(11, false));
  EXPECT_LT(disc(12, false), 0.5 * disc(12, true)) << "twelve without the centre";
  EXPECT_LT(deviation(SampleDomain::ball, 6, false), 0.01);
  EXPECT_LT(deviation(SampleDomain::ball, 12, false), 0.5 * deviation(SampleDomain::ball, 11, false));
}

}  // namespace
}  // namespace understory
