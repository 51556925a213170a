// Frame files: nothing lost, same bytes, cameras that point at the pixels, and no harm from damaged files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "sim/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viz/synthetic_frame.hpp"
#include "viz/exr/frame_exr.hpp"
#include "viz/exr/image.hpp"

namespace understory {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(FrameExr, LosesNothing) {
  const TemporaryFolder folder;
  Frame frame = synthetic_frame(83, 61, 0.7);
  frame.terms["sphere-cap"] = frame.terms["open-dome"];
  frame.terms["sphere-cap"][7] = -0.0f;
  frame.validity[5] |= validity::occluder_too_close | validity::grid_border;
  ExrAttributes attributes;
  attributes.seed = 0xFFFF'FFFF'FFFF'FFF5u;
  write_frame_exr(folder / "frame.exr", frame, attributes);
  const Frame read = read_frame_exr(folder / "frame.exr");

  EXPECT_EQ(read.width, 83);
  EXPECT_EQ(read.height, 61);
  EXPECT_EQ(read.index, frame.index);
  EXPECT_EQ(read.time, frame.time);
  EXPECT_EQ(read.origin, frame.origin);
  EXPECT_EQ(read.world_to_camera, frame.world_to_camera);
  EXPECT_EQ(read.vertical_fov, frame.vertical_fov);
  EXPECT_EQ(read.near_plane, frame.near_plane);
  EXPECT_EQ(read.position, frame.position);
  EXPECT_EQ(read.normal, frame.normal);
  EXPECT_EQ(read.depth, frame.depth);
  EXPECT_EQ(read.owner, frame.owner);
  EXPECT_EQ(read.validity, frame.validity);
  EXPECT_EQ(read.height_above_root, frame.height_above_root);
  EXPECT_EQ(read.visibility, frame.visibility);
  EXPECT_EQ(read.terms, frame.terms);
  EXPECT_TRUE(std::signbit(read.terms.at("sphere-cap")[7]));
  ASSERT_EQ(read.owners.size(), frame.owners.size());
  for (std::size_t i = 0; i < read.owners.size(); ++i) {
    EXPECT_EQ(read.owners[i].surface, frame.owners[i].surface);
    EXPECT_EQ(read.owners[i].species, frame.owners[i].species);
    EXPECT_EQ(read.owners[i].instance, frame.owners[i].instance);
    EXPECT_EQ(read.owners[i].albedo, frame.owners[i].albedo);
    EXPECT_EQ(read.owners[i].crown, frame.owners[i].crown);
    EXPECT_EQ(read.owners[i].group, frame.owners[i].group);
  }
}

TEST(FrameExr, ChannelsAndAttributesAreThePublishedOnes) {
  const TemporaryFolder folder;
  ExrAttributes attributes;
  attributes.seed = 42;
  attributes.scene_sha256 = "0123abcd";
  write_frame_exr(folder / "frame.exr", synthetic_frame(20, 10), attributes);
  const ExrHeader header = read_exr_header(folder / "frame.exr");
  std::vector<std::string> names;
  for (const ExrChannel& channel : header.channels) {
    names.push_back(channel.name);
    const bool integer = channel.name == "owner" || channel.name == "validity";
    EXPECT_EQ(channel.sample, integer ? ExrSample::uint32 : ExrSample::float32) << channel.name;
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("A", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "Y", "Z", "height",
                                                   "open-dome.Y", "solid-angle.Y", "owner", "validity"));
  EXPECT_EQ(header.attributes.texts.at("understory:seed"), "42");
  EXPECT_EQ(header.attributes.texts.at("understory:scene_sha256"), "0123abcd");
  EXPECT_EQ(header.attributes.texts.at("understory:unit"), "m");
  EXPECT_FALSE(header.attributes.texts.contains("capDate"));
}

TEST(FrameExr, SameFrameSameBytes) {
  const TemporaryFolder folder;
  write_frame_exr(folder / "a.exr", synthetic_frame(131, 77), {});
  write_frame_exr(folder / "b.exr", synthetic_frame(131, 77), {});
  EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
}

// OpenEXR, "Standard Attributes": row vector times worldToNDC, divided by w, is (0,0) at the upper left corner of the
// image and (1,1) at the lower right; worldToCamera has +z forward, x right, y up.
TEST(FrameExr, MatricesSendPositionsToTheirPixels) {
  const TemporaryFolder folder;
  const Frame frame = synthetic_frame(97, 53);
  write_frame_exr(folder / "frame.exr", frame, {});
  const auto matrices = read_exr_header(folder / "frame.exr").attributes.matrices;
  const auto row_times = [](glm::dvec4 row, const glm::dmat4& header_matrix) {
    glm::dvec4 result(0);
    for (int column = 0; column < 4; ++column)
      for (int k = 0; k < 4; ++k) result[column] += row[k] * header_matrix[k][column];
    return result;
  };
  int checked = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const auto i = static_cast<std::size_t>(y * frame.width + x);
      if (frame.validity[i] != 0) continue;
      const glm::dvec4 point(frame.position[0][i], frame.position[1][i], frame.position[2][i], 1);
      const glm::dvec4 ndc = row_times(point, matrices.at("worldToNDC"));
      EXPECT_NEAR(ndc.x / ndc.w * frame.width, x + 0.5, 0.01);
      EXPECT_NEAR(ndc.y / ndc.w * frame.height, y + 0.5, 0.01);
      const glm::dvec4 seen = row_times(point, matrices.at("worldToCamera"));
      EXPECT_NEAR(seen.z, frame.depth[i], 1e-5 * frame.depth[i]);
      ++checked;
    }
  EXPECT_GT(checked, 1000);
}

TEST(FrameExr, AnUnwritableFolderIsOneErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  try {
    write_frame_exr(folder / "missing/frame.exr", synthetic_frame(8, 8), {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input_output);
    EXPECT_THAT(error.what(), testing::HasSubstr("missing/frame.exr"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FrameExr, AFullDiskIsAnErrorAndKeepsTheOldFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const TemporaryFolder folder;
  write_bytes(folder / "frame.exr", "old");
  // The temporary name of this process leads to a device that is always full.
  std::filesystem::create_symlink("/dev/full", folder / (".frame.tmp-" + std::to_string(::getpid()) + ".exr"));
  try {
    write_frame_exr(folder / "frame.exr", synthetic_frame(33, 17), {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input_output);
    EXPECT_THAT(error.what(), testing::HasSubstr("No space left"));
  }
  EXPECT_EQ(bytes_of(folder / "frame.exr"), "old");
}

TEST(FrameExr, ForeignAndMissingFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_frame_exr(folder / "none.exr"), Error);
  write_bytes(folder / "text.exr", "no image at all");
  EXPECT_THROW(read_frame_exr(folder / "text.exr"), Error);
  ExrImage image{2, 1, {{"P.X", {1, 2}}}, {}, {}};
  write_exr(folder / "other.exr", image);
  EXPECT_THROW(read_frame_exr(folder / "other.exr"), Error);
}

// Any cut and any flipped byte gives a frame or our Error: no crash, no hang, no other exception.
TEST(FrameExr, DamagedFilesGiveErrors) {
  const TemporaryFolder folder;
  write_frame_exr(folder / "good.exr", synthetic_frame(37, 23), {});
  const std::string good = bytes_of(folder / "good.exr");
  int refused = 0;
  const auto try_to_read = [&](const std::string& bytes) {
    write_bytes(folder / "bad.exr", bytes);
    try {
      read_frame_exr(folder / "bad.exr");
    } catch (const Error&) {
      ++refused;
    }
  };
  for (std::size_t length = 0; length < good.size(); length += 1 + good.size() / 97)
    try_to_read(good.substr(0, length));
  EXPECT_GE(refused, 96);
  std::mt19937 random(7);
  for (int trial = 0; trial < 600; ++trial) {
    std::string bytes = good;
    // Mostly the header: it rules the sizes.
    const std::size_t reach = trial % 3 == 0 ? bytes.size() : 2500;
    for (int flips = 0; flips < 3; ++flips) bytes[random() % reach] = static_cast<char>(random());
    try_to_read(bytes);
  }
  EXPECT_GE(refused, 200);
}

TEST(ExrImage, HugeSizesAreRefusedBeforeMemoryIsTaken) {
  const TemporaryFolder folder;
  write_exr(folder / "small.exr", ExrImage{4, 4, {{"Y", Plane(16, 1.0f)}}, {}, {}});
  std::string bytes = bytes_of(folder / "small.exr");
  for (const std::string window : {"dataWindow", "displayWindow"}) {
    const auto at = bytes.find(window) + window.size() + 1 + 6 + 4;  // name, "box2i", size; then xmin ymin xmax ymax
    bytes[at + 8 + 2] = 0x7f;                                        // xmax = 8323075
    bytes[at + 12 + 2] = 0x7f;
  }
  write_bytes(folder / "huge.exr", bytes);
  EXPECT_THROW(read_exr(folder / "huge.exr"), Error);
}

}  // namespace
}  // namespace understory
