// Pictures: light adds up linearly, colours can be read back, files hold what was drawn. No display anywhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>

#include "sim/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viz/synthetic_frame.hpp"
#include "viz/vtk/contact_sheet.hpp"
#include "viz/vtk/false_colour.hpp"
#include "viz/vtk/frame_pictures.hpp"
#include "viz/vtk/movie.hpp"
#include "viz/vtk/ogg_serial.hpp"
#include "viz/vtk/png.hpp"
#include "viz/vtk/sky_light.hpp"
#include "viz/vtk/text.hpp"

namespace understory {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Left in the folder that UNDERSTORY_TEST_OUT names, for eyes.
void keep(const std::string& name, const Picture& picture) {
  if (const char* folder = std::getenv("UNDERSTORY_TEST_OUT")) write_png(std::filesystem::path(folder) / name, picture);
}

double mean_light(const Picture& picture) {
  double sum = 0;
  for (const std::uint8_t value : picture.rgb) sum += static_cast<double>(decode_srgb(static_cast<float>(value) / 255));
  return sum / static_cast<double>(picture.rgb.size());
}

TEST(Picture, SrgbIsTheStandardCurve) {
  EXPECT_NEAR(encode_srgb(0.18f), 0.4613561f, 1e-5);
  EXPECT_NEAR(encode_srgb(1.0f), 1.0f, 1e-6);
  for (int i = 0; i <= 100; ++i) EXPECT_NEAR(decode_srgb(encode_srgb(static_cast<float>(i) / 100)), i / 100.0, 1e-5);
}

TEST(Picture, ShrinkingKeepsTheLight) {
  Picture picture(101, 67, glm::u8vec3(0));
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      picture.set(x, y, glm::u8vec3((x * 37 + y * 91) % 256, (x * y) % 256, (x + y) % 2 * 255));
  const Picture small = shrink(picture, 25);
  EXPECT_EQ(small.width, 25);
  EXPECT_EQ(small.height, 17);
  EXPECT_NEAR(mean_light(small), mean_light(picture), 0.004);
  // A checkerboard of black and white is half the light: 188 in sRGB, not 128.
  EXPECT_NEAR(shrink(picture, 1).at(0, 0).b, 188, 1);
}

TEST(Picture, PastingCutsAtTheBorder) {
  Picture target(5, 4, glm::u8vec3(9));
  paste(target, Picture(3, 3, glm::u8vec3(200)), -1, 2);
  EXPECT_EQ(target.at(0, 2).r, 200);
  EXPECT_EQ(target.at(1, 3).r, 200);
  EXPECT_EQ(target.at(2, 2).r, 9);
  EXPECT_EQ(target.at(0, 1).r, 9);
  paste(target, Picture(3, 3, glm::u8vec3(200)), 17, -9);
}

TEST(SkyLight, MoreVisibilityIsMoreLightAndNothingElseChanges) {
  Frame frame = synthetic_frame(90, 57);
  const LightPicture lit = sky_light_picture(frame);
  for (float& v : frame.visibility) v *= 0.5f;
  const LightPicture darker = sky_light_picture(frame);
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.validity[i] != 0) {
      EXPECT_EQ(lit.light[i], darker.light[i]);
    } else {
      EXPECT_GE(lit.light[i].g, darker.light[i].g);
    }
    for (int channel = 0; channel < 3; ++channel) EXPECT_TRUE(lit.light[i][channel] >= 0 && lit.light[i][channel] < 2);
  }
}

TEST(SkyLight, OpenHorizontalGroundReflectsItsAlbedo) {
  Frame frame = synthetic_frame(64, 48);
  SkyLight plain;
  plain.tint = glm::vec3(1);
  plain.meteorological_range = 1e9f;
  frame.owners[3].albedo = glm::vec3(0.4f);
  frame.owner.assign(frame.pixels(), 3);
  frame.validity.assign(frame.pixels(), 0);
  frame.visibility.assign(frame.pixels(), 1);
  frame.normal[2].assign(frame.pixels(), 1);
  frame.depth.assign(frame.pixels(), 10);
  for (const glm::vec3& light : sky_light_picture(frame, plain).light) EXPECT_NEAR(light.g, 0.4, 0.002);
}

TEST(SkyLight, LooksLikeAMeadow) {
  const Frame frame = synthetic_frame(800, 500);
  const Picture picture = sky_lit_picture(frame);
  keep("sky_lit.png", picture);
  EXPECT_EQ(picture.rgb, sky_lit_picture(frame).rgb);
  const glm::u8vec3 sky = picture.at(400, 5), ground = picture.at(400, 490);
  EXPECT_GT(sky.g, 200);
  EXPECT_GT(ground.g, 60);
  EXPECT_LT(ground.g, 170);
}

TEST(FramePictures, OneSampleIsThePictureItselfAndManyAreTheirMean) {
  const Frame frame = synthetic_frame(70, 44);
  FramePictures one;
  one.add(frame);
  EXPECT_EQ(one.sky_lit().rgb, sky_lit_picture(frame).rgb);
  EXPECT_EQ(one.visibility().rgb, false_colour(70, 44, frame.visibility, frame.validity).rgb);

  Frame dark = frame;
  dark.visibility.assign(frame.pixels(), 0);
  Frame bright = frame;
  bright.visibility.assign(frame.pixels(), 1);
  Frame middle = frame;
  middle.visibility.assign(frame.pixels(), 0.5f);
  FramePictures two;
  two.add(dark);
  two.add(bright);
  EXPECT_EQ(two.visibility().rgb, false_colour(70, 44, middle.visibility, frame.validity).rgb);
  EXPECT_THROW(two.add(synthetic_frame(71, 44)), Error);
}

TEST(FalseColour, ViridisHasItsPublishedEndsAndGrowsInLightness) {
  EXPECT_EQ(map_colour(ColourMap::viridis, 0, 0, 1), glm::u8vec3(68, 1, 84));
  EXPECT_EQ(map_colour(ColourMap::viridis, 7, 0, 1), glm::u8vec3(253, 231, 37));
  EXPECT_EQ(map_colour(ColourMap::difference, 0, -1, 1), glm::u8vec3(238));
  EXPECT_EQ(map_colour(ColourMap::viridis, std::nanf(""), 0, 1), glm::u8vec3(255, 0, 255));
  double before = -1;
  for (int i = 0; i <= 50; ++i) {
    const glm::u8vec3 c = map_colour(ColourMap::viridis, static_cast<float>(i) / 50, 0, 1);
    const double lightness = 0.2126 * static_cast<double>(decode_srgb(c.r / 255.0f)) +
                             0.7152 * static_cast<double>(decode_srgb(c.g / 255.0f)) +
                             0.0722 * static_cast<double>(decode_srgb(c.b / 255.0f));
    EXPECT_GT(lightness, before) << i;
    before = lightness;
  }
}

TEST(FalseColour, BarTitleAndBackgroundAreThere) {
  const Frame frame = synthetic_frame(320, 200);
  const Picture plain = colour_plane(320, 200, frame.visibility, frame.validity, {});
  const Picture framed = false_colour(320, 200, frame.visibility, frame.validity, {ColourMap::viridis, 0, 1, "V"});
  keep("false_colour.png", framed);
  keep("difference.png", false_colour(320, 200, difference(frame.visibility, frame.terms.at("open-dome")),
                                      frame.validity, {ColourMap::difference, -0.5f, 0.5f, "V - open dome"}));
  const int title_height = framed.height - 200;
  ASSERT_GT(title_height, 0);
  for (int y = 0; y < 200; y += 7)
    for (int x = 0; x < 320; x += 7) EXPECT_EQ(framed.at(x, y + title_height), plain.at(x, y));
  // The bar's column runs through the map from high to low.
  int bar = 320;
  while (bar < framed.width && framed.at(bar, 100).r == 250) ++bar;
  ASSERT_LT(bar, framed.width);
  EXPECT_GT(framed.at(bar + 4, title_height + 12).r, 200);
  EXPECT_LT(framed.at(bar + 4, framed.height - 12).g, 40);
  EXPECT_THROW(colour_plane(3, 3, Plane(8), {}, {}), Error);
}

TEST(Text, LongerIsWiderAndDrawingStaysInside) {
  const glm::ivec2 a = text_size("V", 14), b = text_size("visibility", 14);
  EXPECT_GT(a.x, 3);
  EXPECT_GT(b.x, 3 * a.x);
  Picture picture(60, 20, glm::u8vec3(0));
  draw_text(picture, "visibility", 40, 3, 14, glm::u8vec3(255));
  draw_text(picture, "x", -3, 15, 14, glm::u8vec3(255));
  draw_text(picture, "", 1, 1, 14, glm::u8vec3(255));
  EXPECT_GT(mean_light(picture), 0.01);
}

TEST(ContactSheet, HoldsEveryFrame) {
  std::vector<ContactCell> cells;
  for (int i = 0; i < 5; ++i) {
    const Frame frame = synthetic_frame(160, 100, 0.5 * i);
    cells.push_back({sky_lit_picture(frame), false_colour(160, 100, frame.visibility, frame.validity),
                     "frame " + std::to_string(i)});
  }
  const Picture sheet = contact_sheet(cells, 2, 160);
  keep("contact_sheet.png", sheet);
  EXPECT_GT(sheet.width, 4 * 160);
  EXPECT_GT(sheet.height, 3 * 100);
  EXPECT_EQ(sheet.at(10, 10), cells[0].left.at(0, 0));
  EXPECT_GT(contact_sheet({}, 3, 100).width, 0);
}

TEST(Png, RoundTripIsExactAndBytesRepeat) {
  const TemporaryFolder folder;
  const Picture picture = sky_lit_picture(synthetic_frame(77, 41));
  write_png(folder / "a.png", picture);
  write_png(folder / "b.png", picture);
  EXPECT_EQ(read_png(folder / "a.png").rgb, picture.rgb);
  EXPECT_EQ(bytes_of(folder / "a.png"), bytes_of(folder / "b.png"));
  EXPECT_THROW(write_png(folder / "missing/a.png", picture), Error);
  EXPECT_THROW(read_png(folder / "missing.png"), Error);
  std::ofstream(folder / "c.png") << "text";
  EXPECT_THROW(read_png(folder / "c.png"), Error);
}

/// Sizes and packet counts straight from the container (RFC 3533; Theora specification, section 6.2).
struct OggFacts {
  int width = 0, height = 0, rate = 0, packets = 0;
};

OggFacts read_ogg(const std::string& bytes) {
  OggFacts facts;
  const auto byte = [&](std::size_t i) { return static_cast<int>(static_cast<unsigned char>(bytes.at(i))); };
  for (std::size_t page = 0; page + 27 < bytes.size() && bytes.compare(page, 4, "OggS") == 0;) {
    const int segments = byte(page + 26);
    std::size_t length = 0;
    for (int s = 0; s < segments; ++s) {
      const int lacing = byte(page + 27 + static_cast<std::size_t>(s));
      length += static_cast<std::size_t>(lacing);
      if (lacing < 255) ++facts.packets;
    }
    const std::size_t body = page + 27 + static_cast<std::size_t>(segments);
    if (bytes.compare(body, 7, "\x80theora") == 0) {
      facts.width = (byte(body + 14) << 16) | (byte(body + 15) << 8) | byte(body + 16);
      facts.height = (byte(body + 17) << 16) | (byte(body + 18) << 8) | byte(body + 19);
      facts.rate = (byte(body + 24) << 8) | byte(body + 25);
    }
    page = body + length;
  }
  return facts;
}

TEST(Movie, HoldsEveryFrameAtItsSizeAndRate) {
  const TemporaryFolder folder;
  MovieWriter movie(folder / "wind.ogv", 24);
  for (int i = 0; i < 7; ++i) movie.add(sky_lit_picture(synthetic_frame(150, 90, i / 24.0)));
  EXPECT_FALSE(std::filesystem::exists(folder / "wind.ogv"));
  EXPECT_THROW(movie.add(Picture(10, 10, glm::u8vec3(0))), Error);
  movie.finish();
  const OggFacts facts = read_ogg(bytes_of(folder / "wind.ogv"));
  EXPECT_EQ(facts.width, 150);
  EXPECT_EQ(facts.height, 90);
  EXPECT_EQ(facts.rate, 24);
  EXPECT_GE(facts.packets, 3 + 7);  // three headers, then a packet a frame
}

TEST(Movie, IsAFunctionOfItsPictures) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name) {
    MovieWriter movie(folder / name, 24);
    for (int i = 0; i < 3; ++i) movie.add(sky_lit_picture(synthetic_frame(150, 90, i / 24.0)));
    movie.finish();
    return bytes_of(folder / name);
  };
  const std::string first = write("first.ogv");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // the writer's chance changes with the second
  EXPECT_TRUE(first == write("second.ogv"));
  std::filesystem::resize_file(folder / "first.ogv", first.size() - 1);
  EXPECT_THROW(set_ogg_serial_number(folder / "first.ogv", 1), Error) << "a movie that is cut off";
}

TEST(Movie, LeavesNothingWhenGivenUp) {
  const TemporaryFolder folder;
  {
    MovieWriter movie(folder / "wind.ogv", 24);
    movie.add(Picture(64, 64, glm::u8vec3(90)));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  MovieWriter empty(folder / "wind.ogv", 24);
  EXPECT_THROW(empty.finish(), Error);
  MovieWriter nowhere(folder / "missing/wind.ogv", 24);
  EXPECT_THROW(nowhere.add(Picture(64, 64, glm::u8vec3(90))), Error);
}

}  // namespace
}  // namespace understory
