// The passes that shade made-up fragments (test_fragments.hpp), on every device there is.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/test_fragments.hpp"

namespace understory {

/// Sizes that are no multiple of a vector, a tile or a work-group.
inline constexpr std::size_t odd_sizes[] = {1, 17, 1003};
inline constexpr int lane_counts[] = {1, 4, 8, 16};

/// Uploads `fragments`, calls `pass(device, lanes, planes, visibility)` and reads back, for every width on every
/// device; all widths must give the same bits. Returns the result of the first device.
inline Shaded shade_everywhere(const std::vector<TestFragment>& fragments,
                               const std::function<void(Device&, int lanes, FragmentPlanes&, Buffer<float>&)>& pass,
                               std::size_t row_length = 0) {
  Shaded first_device;
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    Shaded narrowest;
    for (const int lanes : lane_counts) {
      FragmentPlanes planes = upload_fragments(device, fragments, row_length);
      Buffer<float> visibility(device, planes.padded_fragments, "visibility");
      pass(device, lanes, planes, visibility);
      const Shaded shaded{first_of(visibility, fragments.size()), first_of(planes.validity, fragments.size())};
      for (const float v : visibility.read()) EXPECT_TRUE(v >= 0 && v <= 1) << v << ", W = " << lanes;
      if (narrowest.visibility.empty()) narrowest = shaded;
      EXPECT_EQ(shaded.visibility, narrowest.visibility) << info.name << ", W = " << lanes;
      EXPECT_EQ(shaded.validity, narrowest.validity) << info.name << ", W = " << lanes;
    }
    if (first_device.visibility.empty()) first_device = narrowest;
  }
  return first_device;
}

}  // namespace understory

/// First line of a test that needs a device: without one it fails in CI and skips aloud elsewhere.
#define UNDERSTORY_NEEDS_DEVICE()                                      \
  if (understory::list_devices().empty()) {                            \
    if (std::getenv("CI")) FAIL() << "CI has no OpenCL device";        \
    GTEST_SKIP() << "needs an OpenCL device: install pocl-opencl-icd"; \
  }
