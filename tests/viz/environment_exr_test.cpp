// Environment maps from EXR files, and what is refused.
#include "viz/exr/environment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/errors.hpp"
#include "tests/support/temporary_folder.hpp"
#include "viz/exr/image.hpp"

namespace understory {
namespace {

/// 8 x 4; pixel i of channel c is i + 100 c.
ExrImage image_of(int width, int height, const std::vector<std::string>& channels) {
  ExrImage image{width, height, {}, {}, {}};
  for (std::size_t c = 0; c < channels.size(); ++c)
    for (int i = 0; i < width * height; ++i) image.floats[channels[c]].push_back(float(i + 100 * int(c)));
  return image;
}

TEST(EnvironmentExr, ReadsColoursAndGrey) {
  const TemporaryFolder folder;
  write_exr(folder / "colour.exr", image_of(8, 4, {"R", "G", "B"}));
  const EnvironmentMap colour = read_environment(folder / "colour.exr");
  EXPECT_EQ(colour.width, 8);
  EXPECT_EQ(colour.height, 4);
  EXPECT_EQ(colour.radiance[9], glm::vec3(9, 109, 209));
  write_exr(folder / "grey.exr", image_of(8, 4, {"Y"}));
  EXPECT_EQ(read_environment(folder / "grey.exr").radiance[31], glm::vec3(31));
}

TEST(EnvironmentExr, NamesWhatItRefuses) {
  const TemporaryFolder folder;
  const auto message = [&](const ExrImage& image) {
    write_exr(folder / "bad.exr", image);
    return message_of(ErrorKind::invalid_input, [&] { read_environment(folder / "bad.exr"); });
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find("bad.exr"), std::string::npos) << text;
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(message(image_of(8, 5, {"R", "G", "B"})), "8 x 5 pixels; allowed is twice as wide as high");
  expect(message(image_of(8, 4, {"R", "B"})), "no channel G");
  expect(message(image_of(8, 4, {"Z"})), "no channel Y");
  ExrImage compressed = image_of(8, 4, {"Y"});
  compressed.floats["Y"][3] = -1e-4f;
  write_exr(folder / "compressed.exr", compressed);
  EXPECT_EQ(read_environment(folder / "compressed.exr").radiance[3], glm::vec3(0));
  for (const float bad : {NAN, INFINITY, -5.0f}) {
    ExrImage image = image_of(8, 4, {"R", "G", "B"});
    image.floats["G"][10] = bad;
    expect(message(image), "column 2, row 1; allowed are finite radiances from 0");
  }
  std::ofstream(folder / "bad.exr") << "no image";
  expect(message_of(ErrorKind::invalid_input, [&] { read_environment(folder / "bad.exr"); }),
         "not a readable EXR image");
  const std::string missing = message_of(ErrorKind::invalid_input, [&] { read_environment(folder / "missing.exr"); });
  EXPECT_NE(missing.find("missing.exr: no such file"), std::string::npos) << missing;
}

}  // namespace
}  // namespace understory
