// obscurance-line and obscurance-point: flat surfaces are open, closed forms, the device against double, and behaviour
// where neighbourhoods end.
#include <gtest/gtest.h>

#include "host/passes/obscurance_line.hpp"
#include "host/passes/obscurance_point.hpp"
#include "tests/support/depth_images.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

const double pi = std::numbers::pi;

struct Kind {
  bool lines;
  int samples;
  const ObscuranceSampleSet& set() const { return lines ? line_samples(samples) : point_samples(samples); }
};

const std::vector<Kind> all_kinds = {{true, 5},  {true, 7},  {true, 9},  {true, 12},  {true, 13},
                                     {true, 15}, {true, 16}, {false, 6}, {false, 12}, {false, 33}};

std::string name_of(const Kind& kind) { return (kind.lines ? "lines " : "points ") + std::to_string(kind.samples); }

void run(Device& device, int lanes, const Kind& kind, const NearField& options, FragmentPlanes& planes,
         const ObscuranceView& view, Buffer<float>& visibility) {
  if (kind.lines)
    ObscuranceLinePass(device, options, kind.set(), lanes).run(planes, view, visibility);
  else
    ObscurancePointPass(device, options, kind.set(), lanes).run(planes, view, visibility);
}

Shaded shade(const reference::DepthImage& image, const Kind& kind, const NearField& options) {
  return shade_image(image, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    run(device, lanes, kind, options, planes, image.view, visibility);
  });
}

/// At the device's own width only, for surveys over many images.
Shaded shade_once(Device& device, const reference::DepthImage& image, const Kind& kind, const NearField& options) {
  FragmentPlanes planes = upload_image(device, image);
  Buffer<float> visibility(device, planes.padded_fragments, "visibility");
  run(device, 0, kind, options, planes, image.view, visibility);
  return {first_of(visibility, planes.fragments), first_of(planes.validity, planes.fragments)};
}

reference::Obscurance expected(const reference::DepthImage& image, int x, int y, const Kind& kind,
                               const NearField& options) {
  const auto one = [&](double radius) {
    return kind.lines ? reference::line_obscurance(image, x, y, kind.set(), options, radius)
                      : reference::point_obscurance(image, x, y, kind.set(), options, radius);
  };
  reference::Obscurance result = one(options.radius);
  if (options.second_radius <= 0) return result;
  const reference::Obscurance second = one(options.second_radius);
  result.value = options.radii == "minimum" ? std::min(result.value, second.value) : result.value * second.value;
  result.nearest_edge = std::min(result.nearest_edge, second.nearest_edge);
  result.doubt += second.doubt;
  return result;
}

/// Every pixel whose samples do not fall on the border between two pixels, where float may take the other one.
void expect_reference(const reference::DepthImage& image, const Kind& kind, const NearField& options) {
  const Shaded shaded = shade(image, kind, options);
  int compared = 0;
  for (int y = 0; y < image.view.height; ++y)
    for (int x = 0; x < image.view.width; ++x) {
      const auto i = static_cast<std::size_t>(y * image.view.width + x);
      if (std::isinf(image.depth[i])) {
        EXPECT_EQ(shaded.visibility[i], 1);
        continue;
      }
      const reference::Obscurance exact = expected(image, x, y, kind, options);
      if (exact.nearest_edge < 2e-3) continue;
      ++compared;
      ASSERT_NEAR(shaded.visibility[i], exact.value, tolerance::obscurance + exact.doubt)
          << name_of(kind) << " at " << x << ", " << y;
    }
  EXPECT_GT(compared, image.view.width * image.view.height / 2);
}

TEST(Obscurance, IsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  NearField options;
  options.radius = 0.6;
  for (const double field_of_view : {0.9, 2.4, 0.0}) {
    const reference::DepthImage image = image_of(odd_view(61, 37, field_of_view), patchwork(3, 4, 0.5));
    for (const char* falloff : {"cosine", "constant"}) {
      options.falloff = falloff;
      expect_reference(image, {true, 5}, options);
      expect_reference(image, {false, 12}, options);
    }
  }
  expect_reference(image_of(odd_view(3, 70, 0.9), patchwork(3, 4, 0.5)), {true, 16}, options);
}

TEST(Obscurance, EveryOptionIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  const reference::DepthImage image = image_of(odd_view(53, 31, 1.2), patchwork(5, 3, 0.6));
  std::vector<NearField> all(8);
  for (NearField& options : all) options.radius = 0.5;
  all[0].normals = "none";
  all[1].falloff = "quadratic";
  all[2].thickness = 0.4;
  all[3].thickness = 0.4;
  all[3].normals = "none";
  all[3].falloff = "quadratic";
  all[6].thickness = 0.2;
  all[6].falloff = "quadratic";
  all[7].thickness = 0.4;
  all[7].falloff = "cosine";
  all[4].second_radius = 0.2;
  all[5].second_radius = 0.2;
  all[5].radii = "minimum";
  for (const NearField& options : all) {
    expect_reference(image, {true, 9}, options);
    expect_reference(image, {true, 12}, options);
    expect_reference(image, {false, 6}, options);
  }
}

TEST(Obscurance, OneLinePixelsOfSmallBallsAndNarrowImagesAreTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  NearField options;
  options.falloff = "cosine";
  options.thickness = 0.3;
  // 3 pixels; and 256 fragments, as many as the plane holds, in rows shorter than those that lines read and in longer.
  options.radius = 0.15;
  expect_reference(image_of(odd_view(45, 17, 0), patchwork(3, 4, 0.2)), {true, 5}, options);
  options.radius = 0.6;
  expect_reference(image_of(odd_view(2, 128, 0), patchwork(3, 4, 0.2)), {true, 7}, options);
  expect_reference(image_of(odd_view(16, 16, 0), patchwork(3, 4, 0.2)), {true, 7}, options);
}

TEST(Obscurance, LargeBallsAreTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<NearField> all(4);
  all[0].thickness = 0.8;
  all[1].normals = "none";
  all[1].second_radius = 0.6;
  all[2].falloff = "quadratic";
  all[2].thickness = 0.8;
  all[3].falloff = "cosine";
  for (NearField& options : all) {
    // 16 to 46 pixels: rows of neighbours and of every second pixel in one image.
    options.radius = 2.4;
    const reference::DepthImage image = image_of(odd_view(61, 37, 0.9), patchwork(3, 4, 1.5));
    for (const Kind& kind : {Kind{true, 5}, Kind{false, 12}}) expect_reference(image, kind, options);
  }
  // Of every second pixel a row has not room enough, just enough, a pixel more.
  for (const int width : {6, 7, 8})
    expect_reference(image_of(odd_view(width, 40, 0), patchwork(3, 4, 0.5)), {true, 7}, all[0]);
  // Beyond the camera.
  all[0].radius = 7;
  expect_reference(image_of(odd_view(29, 23, 0.9), patchwork(3, 4, 1)), {false, 12}, all[0]);
}

TEST(Obscurance, ADepthThatIsNoNumberHidesNothing) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const reference::DepthImage whole = image_of(odd_view(40, 30, 0.9), plane_surface({0, 0, 4}, {0, 0, -1}));
  reference::DepthImage holed = whole;
  constexpr std::size_t hole = 15 * 40 + 20;
  holed.depth[hole] = std::numeric_limits<double>::quiet_NaN();
  NearField options;
  for (const char* normals : {"given", "none"})
    for (const double thickness : {0.0, 0.5}) {
      options.normals = normals;
      options.thickness = thickness;
      for (const Kind& kind : {Kind{true, 9}, Kind{false, 33}}) {
        const std::vector<float> before = shade_once(device, whole, kind, options).visibility,
                                 after = shade_once(device, holed, kind, options).visibility;
        for (std::size_t i = 0; i < after.size(); ++i)
          if (i != hole) {
            EXPECT_GE(after[i], before[i] - 1e-5f) << name_of(kind) << ' ' << i;
          }
      }
    }
}

TEST(Obscurance, LinesTakeTheMeanOfFourPixels) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  // A comb of columns, two pixels wide, far in front of a wall: of four neighbours in a row two are closed, whatever
  // the line, so that the wall's every pixel is half open; lines by single pixels would leave noise. Columns of four
  // pixels where the ball is large and rows are of every second.
  for (const int width : {2, 4}) {
    const ObscuranceView view = odd_view(160, 80, 0);
    const auto is_wall = [&](int column) { return column / width % 2 == 1; };
    const reference::DepthImage comb = image_of(view, [&](const reference::PixelRay& ray) {
      const int column = static_cast<int>(std::floor(ray.origin.x * view.focal + view.centre_x));
      return SurfacePoint{is_wall(column) ? 9.0 : 2.0, {0, 0, -1}};
    });
    NearField options;
    options.radius = width == 2 ? 0.5 : 1.5;  // 10, 30 pixels
    for (const char* falloff : {"constant", "quadratic", "cosine"}) {
      options.falloff = falloff;
      const Shaded shaded = shade_once(device, comb, {true, 5}, options);
      for (int y = 34; y < 46; ++y)
        for (int x = 36; x < 124; ++x)
          EXPECT_NEAR(shaded.visibility[static_cast<std::size_t>(y * 160 + x)], is_wall(x) ? 0.5 : 1, 1e-5) << x;
    }
  }
}

TEST(Obscurance, WhatIsBeyondTheBallHidesNothing) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  // A floor seen at a low angle up to the middle of the image, from there on a wall far behind it, in front of where
  // the floor would go on.
  const ObscuranceView view = odd_view(96, 64, 0.9);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0, -1, -0.15));
  const reference::DepthImage image = image_of(view, [&](const reference::PixelRay& ray) {
    return ray.direction.y > 0.2 ? plane_surface({0, 1, 2}, normal)(ray) : SurfacePoint{30, {0, 0, -1}};
  });
  NearField options;
  options.radius = 0.4;
  for (const char* falloff : {"constant", "cosine"}) {
    options.falloff = falloff;
    const Shaded shaded = shade_once(device, image, {true, 12}, options);
    for (std::size_t i = 0; i < shaded.visibility.size(); ++i)
      if (image.depth[i] < 20) {
        EXPECT_NEAR(shaded.visibility[i], 1, 1e-3) << i % 96 << ' ' << i / 96;
      }
  }
}

TEST(Obscurance, FlatSurfacesAreOpenWithEverySampleSet) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  NearField options;
  for (const double field_of_view : {1.0, 60.0, 170.0, 0.0})
    for (const double tilt : {0.0, 35.0, 60.0, 79.5}) {
      options.falloff = tilt == 35 ? "constant" : "cosine";
      const ObscuranceView view = odd_view(64, 48, field_of_view * pi / 180);
      const glm::dvec3 normal(std::sin(tilt * pi / 180) * 0.6, std::sin(tilt * pi / 180) * 0.8,
                              -std::cos(tilt * pi / 180));
      // From far away for narrow fields of view: the ball spans about ten pixels.
      const double depth = view.perspective ? 0.1 * view.focal * 0.5 : 7;
      options.radius = 0.5;
      const reference::DepthImage image = image_of(view, plane_surface({0, 0, depth}, normal));
      for (const Kind& kind : all_kinds) {
        const Shaded shaded = shade_once(device, image, kind, options);
        for (std::size_t i = 0; i < shaded.visibility.size(); ++i)
          ASSERT_NEAR(shaded.visibility[i], 1, 1e-3)
              << name_of(kind) << ", field of view " << field_of_view << ", tilt " << tilt << ", pixel " << i;
      }
    }
}

TEST(Obscurance, WithoutNormalsAFacingWallIsOpen) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  NearField options;
  options.normals = "none";
  const reference::DepthImage image = image_of(odd_view(64, 48, 0), plane_surface({0, 0, 4}, {0, 0, -1}));
  for (const Kind& kind : all_kinds) {
    if (!kind.lines) continue;  // a ball's points are not symmetric about every plane
    for (const float v : shade_once(device, image, kind, options).visibility) ASSERT_NEAR(v, 1, 1e-5) << name_of(kind);
  }
}

/// Mean over the pixels of a column.
double column_mean(const Shaded& shaded, const ObscuranceView& view, int x) {
  double sum = 0;
  for (int y = view.height / 4; y < view.height * 3 / 4; ++y)
    sum += static_cast<double>(shaded.visibility[static_cast<std::size_t>(y * view.width + x)]);
  return sum / (view.height * 3 / 4 - view.height / 4);
}

TEST(Obscurance, ClosedForms) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  ObscuranceView view = odd_view(128, 96, 0);
  view.centre_x = 64;
  NearField options;
  options.radius = 1;  // 20 pixels
  // A floor that meets a wall along the sight: the corner's fragment sees half of its hemisphere.
  const auto corner = [&](double x) { return x > 0 ? 3.0 : 9.0; };
  const reference::DepthImage wall = image_of(view, [&](const reference::PixelRay& ray) {
    return SurfacePoint{corner(ray.origin.x), {0, 0, -1}};
  });
  for (const Kind& kind : {Kind{true, 12}, Kind{true, 15}, Kind{false, 33}}) {
    const Shaded shaded = shade_once(device, wall, kind, options);
    EXPECT_NEAR(column_mean(shaded, view, 63), 0.5, 0.04) << name_of(kind);
    EXPECT_NEAR(column_mean(shaded, view, 63 - 21), 1, 1e-6) << name_of(kind);
    EXPECT_NEAR(column_mean(shaded, view, 64), 1, 1e-6) << name_of(kind) << ": the upper surface is open";
    // Half a radius away a cap of height 1/2 is closed: pi h^2 (3 - h)/3 of 4 pi/3, and its half of the hemisphere.
    EXPECT_NEAR(column_mean(shaded, view, 63 - 10), 1 - 0.15625, 0.05) << name_of(kind);
  }
  // Thickness: the wall is a curtain 0.2 m in front of the floor, 0.1 m thick; a silhouette darkens less.
  const reference::DepthImage curtain = image_of(view, [&](const reference::PixelRay& ray) {
    return SurfacePoint{ray.origin.x > 0 ? 8.8 : 9.0, {0, 0, -1}};
  });
  NearField thick = options;
  thick.thickness = 0.1;  // 0 to 0.2
  const double endless = column_mean(shade_once(device, curtain, {true, 12}, options), view, 63);
  const double thin = column_mean(shade_once(device, curtain, {true, 12}, thick), view, 63);
  // Of the hemisphere's half beyond the edge: 1 - (3t - t^3)/2 is in front of height t, and below 0.2 half is closed.
  const auto below = [](double t) { return (3 * t - t * t * t) / 2; };
  EXPECT_NEAR(endless, 0.5 + 0.5 * (1 - below(0.2)), 0.02);
  EXPECT_NEAR(thin, 1 - 0.5 * 0.5 * below(0.2), 0.02);
}

TEST(Obscurance, WithCosineFalloffIsThatOfTheTangentBallsCaps) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  ObscuranceView view = odd_view(128, 96, 0);
  view.centre_x = 64;
  NearField options;
  options.falloff = "cosine";
  options.radius = 1;  // 20 pixels
  const reference::DepthImage wall = image_of(view, [&](const reference::PixelRay& ray) {
    return SurfacePoint{ray.origin.x > 0 ? 3.0 : 9.0, {0, 0, -1}};
  });
  // A ball of radius 1/2, of which a wall at a distance d cuts a cap of height 1/2 - d: h^2 (3 - 2 h) of it.
  for (const Kind& kind : {Kind{true, 9}, Kind{true, 16}, Kind{false, 33}}) {
    const Shaded shaded = shade_once(device, wall, kind, options);
    for (const int column : {63, 58, 55}) {
      const double height = 0.5 - (63.5 - column) / 20;
      EXPECT_NEAR(column_mean(shaded, view, column), 1 - height * height * (3 - 2 * height), 0.05)
          << name_of(kind) << ", column " << column;
    }
    EXPECT_NEAR(column_mean(shaded, view, 63 - 13), 1, 1e-6) << name_of(kind);
  }
}

TEST(Obscurance, StatesWhereNeighbourhoodsEnd) {
  UNDERSTORY_NEEDS_DEVICE();
  const ObscuranceView view = odd_view(40, 30, 0);
  const reference::DepthImage image = image_of(view, plane_surface({0, 0, 4}, {0, 0, -1}));
  NearField options;
  options.radius = 0.25;  // 5 pixels
  const Shaded shaded = shade(image, {true, 9}, options);
  const auto code = [&](int x, int y) { return shaded.validity[static_cast<std::size_t>(y * 40 + x)]; };
  EXPECT_EQ(code(20, 15), 0u);
  EXPECT_EQ(code(0, 15), validity::left_image);
  EXPECT_EQ(code(39, 29), validity::left_image);
  EXPECT_EQ(code(34, 15) | code(5, 15), 0u) << "within the image by a pixel";
  options.radius = 0.01;  // a fifth of a pixel
  for (const std::uint32_t v : shade(image, {true, 5}, options).validity) EXPECT_EQ(v, validity::radius_out_of_range);
  options.radius = 10;  // 200 pixels
  const Shaded large = shade(image, {false, 6}, options);
  for (const std::uint32_t v : large.validity) EXPECT_TRUE(v & validity::radius_out_of_range);
  for (const float v : large.visibility) EXPECT_NEAR(v, 1, 1e-3);
}

TEST(Obscurance, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  const float bad[] = {NAN, INFINITY, -INFINITY, 0.0f, 1e-44f, 1e6f, -3e38f, 1e30f, 1e-30f, 2.0f};
  reference::DepthImage image{odd_view(30, 20, 1.0), {}, {}};
  for (std::size_t i = 0; i < 600; ++i) {
    image.depth.push_back(double{bad[i % 10]});
    image.normal.push_back(glm::dvec3(double{bad[i / 10 % 10]}, double{bad[i / 3 % 10]}, double{bad[i / 7 % 10]}));
  }
  NearField options;
  options.second_radius = 1;
  options.thickness = 0.1;
  for (const Kind& kind : {Kind{true, 5}, Kind{true, 12}, Kind{false, 6}}) shade(image, kind, options);  // in [0, 1]
  options.normals = "none";
  options.falloff = "quadratic";
  for (const Kind& kind : {Kind{true, 5}, Kind{false, 6}}) shade(image, kind, options);
}

TEST(Obscurance, NamesWhatDoesNotFit) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  EXPECT_NE(message_of(ErrorKind::invalid_input, [&] { line_samples(6); })
                .find("6 lines: no such sample set; allowed: 1 4 5 7 9 12 13 15 16"),
            std::string::npos);
  EXPECT_NE(message_of(ErrorKind::invalid_input, [&] { point_samples(5); }).find("6 12 33"), std::string::npos);
  FragmentPlanes planes = allocate_planes(device, 300, 2, false);
  Buffer<float> visibility(device, planes.padded_fragments, "visibility");
  const std::string message = message_of(ErrorKind::unexpected, [&] {
    ObscuranceLinePass(device, NearField{}, line_samples(5)).run(planes, odd_view(301, 2, 1), visibility);
  });
  EXPECT_NE(message.find("obscurance-line: plane image has 602 elements, 600 are needed"), std::string::npos)
      << message;
  NearField options;
  options.radius = 0;
  EXPECT_NE(
      message_of(
          ErrorKind::invalid_input,
          [&] { ObscuranceLinePass(device, options, line_samples(5)).run(planes, odd_view(300, 2, 1), visibility); })
          .find("radius 0.000000; allowed: a number above 0"),
      std::string::npos);
}

}  // namespace
}  // namespace understory
