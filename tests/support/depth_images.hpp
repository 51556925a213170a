// The passes that shade made-up depth images (made_images.hpp), on every device and width.
#pragma once
#include <gtest/gtest.h>

#include <functional>

#include "tests/support/fragments.hpp"
#include "tests/support/made_images.hpp"

namespace understory {

/// Uploads the image, calls `pass(device, lanes, planes, visibility)` and reads back, for every width on every device;
/// all widths must give the same bits, within [0, 1].
inline Shaded shade_image(const reference::DepthImage& image,
                          const std::function<void(Device&, int, FragmentPlanes&, Buffer<float>&)>& pass) {
  Shaded first;
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    for (const int lanes : lane_counts) {
      FragmentPlanes planes = upload_image(device, image);
      Buffer<float> visibility(device, planes.padded_fragments, "visibility");
      pass(device, lanes, planes, visibility);
      const Shaded shaded{first_of(visibility, planes.fragments), first_of(planes.validity, planes.fragments)};
      for (const float v : shaded.visibility) EXPECT_TRUE(v >= 0 && v <= 1) << v << ", W = " << lanes;
      if (first.visibility.empty()) first = shaded;
      EXPECT_EQ(shaded.visibility, first.visibility) << info.name << ", W = " << lanes;
      EXPECT_EQ(shaded.validity, first.validity) << info.name << ", W = " << lanes;
    }
  }
  return first;
}

}  // namespace understory
