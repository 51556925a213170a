// Files of other renderers: which channels are taken, which are refused, and which camera comes out.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <half.h>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sim/error.hpp"
#include "tests/support/data.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viz/synthetic_frame.hpp"
#include "viz/exr/camera_fit.hpp"
#include "viz/exr/channel_roles.hpp"
#include "viz/exr/frame_exr.hpp"
#include "viz/exr/gbuffer.hpp"
#include "viz/exr/image.hpp"

namespace understory {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> xyz(const std::string& layer, const char* axes = "XYZ") {
  return {layer + "." + axes[0], layer + "." + axes[1], layer + "." + axes[2]};
}

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string refusal(const std::vector<std::string>& channels, const std::map<std::string, std::string>& chosen = {}) {
  try {
    resolve_channel_roles(channels, chosen);
  } catch (const Error& error) {
    return error.what();
  }
  return "taken";
}

struct Writer {
  std::string name;
  std::vector<std::string> channels;
  std::vector<std::string> position, normal;
};

class ChannelRolesOf : public testing::TestWithParam<Writer> {};

TEST_P(ChannelRolesOf, AreFound) {
  const ChannelRoles roles = resolve_channel_roles(GetParam().channels, {});
  EXPECT_EQ(roles.position.names, GetParam().position);
  EXPECT_EQ(roles.normal.names, GetParam().normal);
  EXPECT_FALSE(roles.owner.has_value());
}

// Channel lists as these programs write them (their sources and sample files).
INSTANTIATE_TEST_SUITE_P(
    Writers, ChannelRolesOf,
    testing::Values(
        Writer{"blender3",
               xyz("ViewLayer.Position") + xyz("ViewLayer.Normal") +
                   std::vector<std::string>{"ViewLayer.Depth.Z", "ViewLayer.Combined.R", "ViewLayer.Combined.A",
                                            "ViewLayer.IndexOB.X", "ViewLayer.CryptoObject00.R",
                                            "ViewLayer.CryptoObject00.A"} +
                   xyz("ViewLayer.AO", "RGB"),
               xyz("ViewLayer.Position"), xyz("ViewLayer.Normal")},
        Writer{"blender5",
               xyz("View Layer.Position") + xyz("View Layer.Normal") +
                   std::vector<std::string>{"View Layer.Object Index.X", "View Layer.Depth.V"},
               xyz("View Layer.Position"), xyz("View Layer.Normal")},
        Writer{"arnold", xyz("P") + xyz("N") + std::vector<std::string>{"R", "G", "B", "A", "Z", "ZBack", "id"},
               xyz("P"), xyz("N")},
        Writer{"arnold_rgb", xyz("P", "RGB") + xyz("N", "RGB"), xyz("P", "RGB"), xyz("N", "RGB")},
        Writer{"ospray", xyz("worldPosition") + xyz("normal") + std::vector<std::string>{"objectId", "A"},
               xyz("worldPosition"), xyz("normal")},
        Writer{"renderman", xyz("__Pworld", "rgb") + xyz("__Nworld", "rgb") + std::vector<std::string>{"__depth.r"},
               xyz("__Pworld", "rgb"), xyz("__Nworld", "rgb")},
        Writer{"mitsuba", xyz("pos.position") + xyz("nn.sh_normal") + std::vector<std::string>{"dd.T"},
               xyz("pos.position"), xyz("nn.sh_normal")},
        Writer{"nuke", xyz("P", "xyz") + xyz("normal", "xyz") + std::vector<std::string>{"depth.Z", "R", "G", "B"},
               xyz("P", "xyz"), xyz("normal", "xyz")}),
    [](const auto& writer) { return writer.param.name; });

TEST(ChannelRoles, TwoCandidatesAreAnErrorThatListsThem) {
  const auto pbrt = xyz("P") + xyz("N") + xyz("Ns");
  EXPECT_THAT(refusal(pbrt), testing::AllOf(HasSubstr("N.X/N.Y/N.Z"), HasSubstr("Ns.X/Ns.Y/Ns.Z")));
  EXPECT_THAT(resolve_channel_roles(pbrt, {{"normal", "Ns"}}).normal.names, ElementsAre("Ns.X", "Ns.Y", "Ns.Z"));
}

TEST(ChannelRoles, WhatIsMissingOrMisnamedIsTold) {
  EXPECT_THAT(refusal({"P.X", "P.Y"}), testing::AllOf(HasSubstr("position"), HasSubstr("P.X, P.Y")));
  EXPECT_THAT(resolve_channel_roles(xyz("P"), {}).normal.names, testing::IsEmpty()) << "made from positions";
  EXPECT_THAT(refusal(xyz("P") + xyz("N"), {{"normal", "Q"}}), HasSubstr("normal=Q"));
  EXPECT_THAT(refusal(xyz("P") + xyz("N"), {{"colour", "P"}}), HasSubstr("position, normal, depth, alpha, owner"));
  EXPECT_THROW(parse_channel_choices("position"), Error);
  EXPECT_THROW(parse_channel_choices("position=A,position=B"), Error);
  EXPECT_THAT(parse_channel_choices("position=My Layer.P,owner=id"),
              ElementsAre(testing::Pair("owner", "id"), testing::Pair("position", "My Layer.P")));
}

/// A synthetic frame as another renderer would write it.
ExrImage foreign_image(const Frame& frame) {
  ExrImage image{frame.width, frame.height, {}, {}, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    image.floats[std::string("Layer.Position.") + "XYZ"[axis]] = frame.position[axis];
    image.floats[std::string("Layer.Normal.") + "XYZ"[axis]] = frame.normal[axis];
  }
  return image;
}

double worst_reprojection(const Frame& frame) {
  double worst = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const auto i = static_cast<std::size_t>(y * frame.width + x);
      if (frame.validity[i] & validity::background) continue;
      const glm::dvec3 p(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
      worst = std::max(worst, glm::length(project(frame, p) - glm::dvec2(x + 0.5, y + 0.5)));
    }
  return worst;
}

TEST(Gbuffer, SolvesTheCameraOfASyntheticFrame) {
  const TemporaryFolder folder;
  const Frame frame = synthetic_frame(163, 101);
  write_exr(folder / "in.exr", foreign_image(frame));
  const Gbuffer read = read_gbuffer(folder / "in.exr");
  EXPECT_LT(worst_reprojection(read.frame), 0.1);
  EXPECT_NEAR(read.frame.vertical_fov, frame.vertical_fov, 1e-4);
  for (int column = 0; column < 4; ++column)
    EXPECT_LT(glm::length(read.frame.world_to_camera[column] - frame.world_to_camera[column]), 1e-3);
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    ASSERT_EQ(read.frame.validity[i], frame.validity[i]);
    if (frame.validity[i] == 0) {
      ASSERT_NEAR(read.frame.depth[i], frame.depth[i], 1e-3 * frame.depth[i]);
    }
  }
}

TEST(Gbuffer, NormalsAreTurnedToTheViewerAndMadeUnit) {
  const TemporaryFolder folder;
  const Frame frame = synthetic_frame(64, 49);
  ExrImage image = foreign_image(frame);
  for (const char axis : {'X', 'Y', 'Z'})
    for (float& value : image.floats[std::string("Layer.Normal.") + axis]) value *= -0.5f;
  write_exr(folder / "in.exr", image);
  const Gbuffer read = read_gbuffer(folder / "in.exr");
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.validity[i] != 0) continue;
    EXPECT_EQ(read.frame.validity[i], validity::not_unit);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(read.frame.normal[axis][i], frame.normal[axis][i], 1e-6);
  }
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("not unit")));
}

// pbrt-v4's gbuffer film: positions and normals in camera space, the matrix for column vectors.
TEST(Gbuffer, CameraSpaceOfPbrtIsMovedToTheWorld) {
  const TemporaryFolder folder;
  const Frame frame = synthetic_frame(120, 75);
  ExrImage image{frame.width, frame.height, {}, {}, {}};
  glm::dmat4 camera = frame.world_to_camera;
  for (int column = 0; column < 4; ++column) camera[column].z *= -1;  // +z forward
  image.attributes.matrices["worldToCamera"] = glm::transpose(camera);
  for (const char axis : {'X', 'Y', 'Z'})
    for (const char layer : {'P', 'N'}) image.floats[std::string{layer, '.', axis}].assign(frame.pixels(), 0);
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.validity[i] != 0) continue;
    const glm::dvec4 p = camera * glm::dvec4(frame.position[0][i], frame.position[1][i], frame.position[2][i], 1);
    const glm::dvec4 n = camera * glm::dvec4(frame.normal[0][i], frame.normal[1][i], frame.normal[2][i], 0);
    for (int axis = 0; axis < 3; ++axis) {
      image.floats[std::string("P.") + "XYZ"[axis]][i] = static_cast<float>(p[axis]);
      image.floats[std::string("N.") + "XYZ"[axis]][i] = static_cast<float>(n[axis]);
    }
  }
  write_exr(folder / "pbrt.exr", image);
  const Gbuffer read = read_gbuffer(folder / "pbrt.exr");
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("space: camera")));
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
      ASSERT_NEAR(read.frame.position[axis][i], frame.position[axis][i], 1e-3 + 1e-5 * frame.depth[i]);
      ASSERT_NEAR(read.frame.normal[axis][i], frame.normal[axis][i], 1e-5);
    }
}

TEST(Gbuffer, AFlatSceneNeedsACamera) {
  const TemporaryFolder folder;
  Frame frame = synthetic_frame(90, 60);
  for (std::size_t i = 0; i < frame.pixels(); ++i)
    if (frame.owner[i] != 1)
      for (std::size_t axis = 0; axis < 3; ++axis) frame.normal[axis][i] = 0;
  write_exr(folder / "flat.exr", foreign_image(frame));
  try {
    read_gbuffer(folder / "flat.exr");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("flat.exr"), HasSubstr("--camera")));
  }
  GbufferOptions options;
  options.camera = Camera{{0.3, -4, 1.7}, {0, 6, 1.5}, 0.9, 0.05};
  const Gbuffer read = read_gbuffer(folder / "flat.exr", options);
  EXPECT_LT(worst_reprojection(read.frame), 0.1);
}

TEST(Gbuffer, OwnFramesComeBackWithOwners) {
  const TemporaryFolder folder;
  const Frame frame = synthetic_frame(31, 22);
  write_frame_exr(folder / "own.exr", frame, {});
  const Gbuffer read = read_gbuffer(folder / "own.exr");
  EXPECT_EQ(read.frame.owner, frame.owner);
  EXPECT_EQ(read.frame.owners.size(), frame.owners.size());
  EXPECT_TRUE(read.frame.terms.empty());
}

TEST(Gbuffer, OfBlenderMatchesItsOwnCamera) {
  UNDERSTORY_NEEDS_DATA();
  const auto data = data_folder() / "gbuffer";
  const Gbuffer read = read_gbuffer(data / "gbuffer_walnut_meadow.exr");
  EXPECT_THAT(read.notes,
              testing::Contains("position: ViewLayer.Position.X/ViewLayer.Position.Y/ViewLayer.Position.Z"));
  EXPECT_THAT(read.notes, testing::Contains("normal: ViewLayer.Normal.X/ViewLayer.Normal.Y/ViewLayer.Normal.Z"));
  EXPECT_LT(worst_reprojection(read.frame), 0.1);

  nlohmann::json truth;
  std::ifstream(data / "gbuffer_walnut_meadow.json") >> truth;
  const auto& rows = truth.at("camera_to_world_rowmajor");
  const glm::dmat4 camera_to_world = glm::inverse(read.frame.world_to_camera);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_NEAR(camera_to_world[column][row], rows[row][column].get<double>(), 2e-3) << row << ' ' << column;
  const double half_width = std::tan(0.5 * truth.at("hfov_deg").get<double>() * M_PI / 180);
  EXPECT_NEAR(std::tan(0.5 * read.frame.vertical_fov), half_width * 480 / 640, 1e-4);

  // Sky pixels have IndexOB 0.
  const ExrHeader header = read_exr_header(data / "gbuffer_walnut_meadow.exr");
  const std::vector<std::string> index{"ViewLayer.IndexOB.X"};
  const Plane object = read_exr_floats(data / "gbuffer_walnut_meadow.exr", header, index).front();
  for (std::size_t i = 0; i < object.size(); ++i)
    ASSERT_EQ((read.frame.validity[i] & validity::background) != 0, object[i] == 0) << i;
  GbufferOptions options;
  options.channels["owner"] = "ViewLayer.IndexOB";
  const Gbuffer with_owner = read_gbuffer(data / "gbuffer_walnut_meadow.exr", options);
  for (std::size_t i = 0; i < object.size(); ++i) ASSERT_EQ(static_cast<float>(with_owner.frame.owner[i]), object[i]);
}

TEST(Gbuffer, MissingFilesAndFilesWithoutPositionsAreRefused) {
  EXPECT_THROW(read_gbuffer("/nowhere/none.exr"), Error);
  UNDERSTORY_NEEDS_DATA();
  EXPECT_THROW(read_gbuffer(data_folder() / "gbuffer/gbuffer_walnut_meadow_ao.exr"), Error);
}

/// The synthetic frame with 16-bit channels, `shift` metres further along x and y.
void write_half(const std::filesystem::path& path, const Frame& frame, float shift) {
  Imf::Header header(frame.width, frame.height);
  Imf::FrameBuffer buffer;
  std::vector<std::vector<half>> planes;
  for (const char layer : {'P', 'N'})
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name = std::string{layer, '.'} + "XYZ"[axis];
      std::vector<half>& plane = planes.emplace_back();
      for (std::size_t i = 0; i < frame.pixels(); ++i)
        plane.emplace_back(layer == 'N' ? frame.normal[axis][i] : frame.position[axis][i] + (axis < 2 ? shift : 0));
      header.channels().insert(name, Imf::Channel(Imf::HALF));
      buffer.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(plane.data()), sizeof(half),
                                     sizeof(half) * static_cast<std::size_t>(frame.width)));
    }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(frame.height);
}

TEST(Gbuffer, HalfPositionsAreToldAndFarFromTheOriginRefused) {
  const TemporaryFolder folder;
  Frame frame = synthetic_frame(96, 64);
  for (std::size_t i = 0; i < frame.pixels(); ++i)  // nothing farther than 30 m
    if (!(frame.depth[i] < 30))
      for (std::size_t axis = 0; axis < 3; ++axis) frame.normal[axis][i] = 0;
  GbufferOptions options;
  options.camera = Camera{{0.3, -4, 1.7}, {0, 6, 1.5}, 0.9, 0.05};
  write_half(folder / "near.exr", frame, 0);
  EXPECT_THAT(read_gbuffer(folder / "near.exr", options).notes, testing::Contains(HasSubstr("16-bit")));
  write_half(folder / "far.exr", frame, 2000);
  try {
    read_gbuffer(folder / "far.exr", options);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("far.exr"), HasSubstr("32 bits")));
  }
}

}  // namespace
}  // namespace understory
