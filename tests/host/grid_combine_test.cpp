// How bodies' cones are put together, judged as `understory bench --grids` judges it: on the walker, whose eleven parts
// hide behind one another, beside traced truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/grid_accuracy.hpp"
#include "tests/support/fragments.hpp"

namespace understory {
namespace {

TEST(GridCombine, PartsOfAWalkerAreNotCountedTwice) {
  UNDERSTORY_NEEDS_DEVICE();
  GridAccuracyOptions options;
  options.scenes = {std::filesystem::path(UNDERSTORY_SOURCE_FOLDER) / "sim/scenes/walker.yaml"};
  options.rays = 1024;
  options.fragments = 500;
  const GridAccuracyReport report = measure_grid_accuracy(options);
  // The truth's own variance taken out.
  const auto error = [&](const char* receivers, const char* method) {
    const auto row = std::find_if(report.rows.begin(), report.rows.end(), [&](const GridAccuracyRow& r) {
      return r.receivers == receivers && r.method == method;
    });
    return row == report.rows.end() ? -1 : std::sqrt(row->rmse * row->rmse - row->truth_noise * row->truth_noise);
  };
  for (const char* receivers : {"all", "contact", "near"}) {
    const double multiply = error(receivers, "grid-cone multiply");
    EXPECT_GT(multiply, 0) << receivers;
    for (const char* method : {"grid-cone merge", "grid-cone union"}) {
      EXPECT_GT(error(receivers, method), 0) << receivers << ", " << method;
      EXPECT_LE(error(receivers, method), 0.7 * multiply) << receivers << ", " << method;
    }
  }
}

}  // namespace
}  // namespace understory
