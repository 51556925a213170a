// screen-rays: the device against double, flat surfaces, closed forms, and behaviour where neighbourhoods end.
#include "host/passes/screen_rays.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/reference/screen_rays.hpp"
#include "tests/support/depth_images.hpp"
#include "tests/support/errors.hpp"

namespace understory {
namespace {

const double pi = std::numbers::pi;

NearField rays_of(double length, double thickness = 0.05) {
  NearField near;
  near.radius = length;
  near.thickness = thickness;
  return near;
}

Shaded shade(const reference::DepthImage& image, int rays, const NearField& near) {
  return shade_image(image, [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
    ScreenRaysPass(device, near, rays, lanes).run(planes, image.view, visibility);
  });
}

Shaded shade_once(Device& device, const reference::DepthImage& image, int rays, const NearField& near) {
  FragmentPlanes planes = upload_image(device, image);
  Buffer<float> visibility(device, planes.padded_fragments, "visibility");
  ScreenRaysPass(device, near, rays).run(planes, image.view, visibility);
  return {first_of(visibility, planes.fragments), first_of(planes.validity, planes.fragments)};
}

/// Exactly where no ray is in doubt; else what one ray more or less changes, once for each.
void expect_reference(const reference::DepthImage& image, int rays, const NearField& near) {
  const Shaded shaded = shade(image, rays, near);
  int drawn = 0, sure = 0;
  double difference = 0;
  for (int y = 0; y < image.view.height; ++y)
    for (int x = 0; x < image.view.width; ++x) {
      const auto i = static_cast<std::size_t>(y * image.view.width + x);
      if (std::isinf(image.depth[i])) {
        EXPECT_EQ(shaded.visibility[i], 1);
        continue;
      }
      const reference::ScreenRays exact = reference::screen_rays(image, x, y, rays, near);
      const double error = std::abs(static_cast<double>(shaded.visibility[i]) - exact.value);
      ++drawn;
      difference += error;
      sure += exact.doubtful == 0;
      ASSERT_LE(error, 2e-4 + exact.doubtful * (1 + 6 * std::min(near.radius, 1.0)) / rays)
          << rays << " at " << x << ", " << y;
      if (exact.doubtful == 0) {
        EXPECT_EQ((shaded.validity[i] & validity::left_image) != 0, exact.left) << x << ", " << y;
      }
    }
  EXPECT_GT(sure, drawn / 2) << rays;
  EXPECT_LT(difference / drawn, 2e-3) << rays;
}

TEST(ScreenRays, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const double field_of_view : {0.9, 2.4, 0.0}) {
    const reference::DepthImage image = image_of(odd_view(61, 37, field_of_view), patchwork(3, 4, 0.5));
    expect_reference(image, 5, rays_of(0.6));
    expect_reference(image, 16, rays_of(0.6, 0.2));
  }
}

TEST(ScreenRays, ShortAndLongRaysAreTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  const reference::DepthImage image = image_of(odd_view(45, 29, 0.9), patchwork(5, 4, 0.7));
  for (const double length : {0.05, 2.5, 9.0}) expect_reference(image, 4, rays_of(length));
  expect_reference(image, 1, rays_of(1, 1e-3));
  expect_reference(image, 64, rays_of(0.3, 2));
}

TEST(ScreenRays, NarrowImagesAreTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const auto& [width, height] : {std::pair{1, 70}, {70, 1}, {3, 70}, {1, 1}})
    expect_reference(image_of(odd_view(width, height, 0.9), patchwork(3, 4, 0.5)), 5, rays_of(0.6));
}

TEST(ScreenRays, FlatSurfacesAreOpen) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  for (const double field_of_view : {1.0, 60.0, 170.0, 0.0})
    for (const double tilt : {0.0, 35.0, 60.0, 79.5}) {
      const ObscuranceView view = odd_view(64, 48, field_of_view * pi / 180);
      const glm::dvec3 normal(std::sin(tilt * pi / 180) * 0.6, std::sin(tilt * pi / 180) * 0.8,
                              -std::cos(tilt * pi / 180));
      const double depth = view.perspective ? 0.1 * view.focal * 0.5 : 7;
      const reference::DepthImage image = image_of(view, plane_surface({0, 0, depth}, normal));
      for (const int rays : {4, 16, 64}) {
        const Shaded shaded = shade_once(device, image, rays, rays_of(0.5));
        for (std::size_t i = 0; i < shaded.visibility.size(); ++i)
          ASSERT_NEAR(shaded.visibility[i], 1, 1e-3)
              << rays << ", field of view " << field_of_view << ", tilt " << tilt << ", pixel " << i;
      }
    }
}

/// Share of cosine-weighted rays of unit length that a wall at a distance stops: directions are even over the unit
/// disc.
double stopped_by_wall(double distance) {
  const double h = std::min(distance, 1.0);
  return (std::acos(h) - h * std::sqrt(1 - h * h)) / pi;
}

/// Two planes that meet in a horizontal line at a right angle, both seen at 45 degrees.
reference::DepthImage corner(const ObscuranceView& view) {
  return image_of(view, [](const reference::PixelRay& ray) {
    const double side = ray.direction.y * 6 + ray.origin.y > 0 ? 1 : -1;
    return plane_surface({0, 0, 6}, glm::normalize(glm::dvec3(0, -side, -1)))(ray);
  });
}

TEST(ScreenRays, BesideAWallIsTheClosedForm) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const ObscuranceView view = odd_view(96, 128, 0.5);
  const reference::DepthImage image = corner(view);
  const Shaded shaded = shade_once(device, image, 64, rays_of(1));
  int compared = 0;
  for (int y = 4; y < view.height - 4; ++y) {
    const glm::dvec3 point = reference::pixel_ray(view, view.width / 2, y).at(image.depth_at(view.width / 2, y));
    const double distance = std::abs(point.y) * std::sqrt(2.0);
    if (distance > 1.2) continue;
    double mean = 0;
    for (int x = 8; x < 88; ++x)
      mean += static_cast<double>(shaded.visibility[static_cast<std::size_t>(y * view.width + x)]) / 80;
    ++compared;
    // Open by a little too much: in its last step, a sixth of its way, a ray looks up to that far before its end. Of
    // the corner a pixel, 0.03 m, knows no more than where it is to half of that.
    EXPECT_LT(mean, 1 - stopped_by_wall(distance) + 0.05) << y << ": " << distance << " m";
    EXPECT_GT(mean, 1 - stopped_by_wall(distance) - 0.04) << y << ": " << distance << " m";
  }
  EXPECT_GT(compared, 40);
}

/// A board some pixels wide, a metre in front of a wall, seen by an orthographic camera; 20 pixels a metre.
double mean_beside_board(Device& device, int width, double thickness, double camera = 0) {
  ObscuranceView view = odd_view(160, 64, 0);
  view.centre_x = 80;
  const reference::DepthImage image = image_of(view, [&](const reference::PixelRay& ray) {
    return SurfacePoint{std::abs(ray.origin.x) * 40 < width ? 8 - camera : 9 - camera, {0, 0, -1}};
  });
  const Shaded shaded = shade_once(device, image, 16, rays_of(2, thickness));
  double sum = 0;
  for (int y = 16; y < 48; ++y)
    for (int x = 0; x < 4; ++x)
      sum += static_cast<double>(shaded.visibility[static_cast<std::size_t>(y * 160 + 80 + width / 2 + x)]);
  return sum / 128;
}

TEST(ScreenRays, PassBehindWhatIsThinAndNotBehindWhatIsWide) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const double post = mean_beside_board(device, 2, 0.05), board = mean_beside_board(device, 60, 0.05);
  EXPECT_GT(post, 0.9);
  EXPECT_LT(board, post - 0.1);
  // What is thick hides as much whatever its width, beyond what rays get past a post's side.
  double last = 1;
  for (const double thickness : {0.05, 0.3, 0.6, 2.0}) {
    const double open = mean_beside_board(device, 6, thickness);
    EXPECT_LE(open, last + 0.01) << thickness;
    last = open;
  }
  EXPECT_LT(last, post - 0.1);
  EXPECT_NEAR(mean_beside_board(device, 60, 0.05, 20), board, 1e-3) << "an orthographic camera within the scene";
}

TEST(ScreenRays, SurfacesAreAsDeepAsSaidHoweverLongTheRays) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const ObscuranceView view = odd_view(96, 128, 0.5);
  const reference::DepthImage image = corner(view);
  // From the corner half of all rays meet the other wall; up to lengths that are rounded by as much as walls are thick.
  for (const double length : {0.5, 5.0, 100.0}) {
    const Shaded shaded = shade_once(device, image, 16, rays_of(length, std::min(0.05, 0.1 * length)));
    double mean = 0;
    for (int x = 8; x < 88; ++x) {
      const auto i = static_cast<std::size_t>((view.height / 2 - 1) * view.width + x);
      mean += static_cast<double>(shaded.visibility[i]) / 80;
    }
    EXPECT_NEAR(mean, 0.5, 0.05) << length;
  }
}

TEST(ScreenRays, FloorsAndWallsGoOnBeyondTheImage) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  ObscuranceView view = odd_view(96, 128, 0.5), part = view;
  // The wall in the part's image ends a tenth of the ray above the corner.
  constexpr int cut = 60;
  part.height -= cut;
  part.centre_y -= cut;
  const Shaded whole = shade_once(device, corner(view), 16, rays_of(1)),
               shaded = shade_once(device, corner(part), 16, rays_of(1));
  double with = 0, closed = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 8; x < 88; ++x) {
      with += static_cast<double>(shaded.visibility[static_cast<std::size_t>(y * 96 + x)]) / 24 / 80;
      closed += static_cast<double>(whole.visibility[static_cast<std::size_t>((y + cut) * 96 + x)]) / 24 / 80;
    }
  EXPECT_NEAR(with, closed, 0.03);
  EXPECT_LT(closed, 0.85);
  EXPECT_TRUE(shaded.validity[40] & validity::left_image);
}

TEST(ScreenRays, BackgroundHidesNothingWhateverItsNormal) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  for (const double field_of_view : {0.9, 0.0}) {
    const ObscuranceView view = odd_view(48, 40, field_of_view);
    reference::DepthImage image = image_of(view, [](const reference::PixelRay& ray) {
      const glm::dvec3 p = ray.at(4);
      return std::abs(p.x) + std::abs(p.y) < 0.8 ? SurfacePoint{4, {0, 0, -1}} : SurfacePoint{};
    });
    for (glm::dvec3& normal : image.normal)
      if (normal.z < 0) normal = {0, 0, -1};
    for (std::size_t i = 0; i < image.depth.size(); ++i)
      if (std::isinf(image.depth[i])) image.normal[i] = glm::dvec3(0.6, i % 2 ? 0.8 : -0.8, 0.5);
    for (const float v : shade_once(device, image, 16, rays_of(3)).visibility) ASSERT_EQ(v, 1);
  }
}

TEST(ScreenRays, GarbageStaysWithinBoundsAndADepthThatIsNoNumberHidesNothing) {
  UNDERSTORY_NEEDS_DEVICE();
  const double bad[] = {0.0, -1.0, 1e-44, NAN, 3e38, -infinitely_far, 10.0};
  int number = 0;
  const reference::DepthImage broken = image_of(odd_view(49, 7, 0.9), [&](const reference::PixelRay&) {
    const SurfacePoint point{bad[number % 7], {bad[number / 7 % 7], 0, -1}};
    ++number;
    return point;
  });
  shade(broken, 5, rays_of(1));  // within [0, 1], the same bits at all widths
  Device device;
  reference::DepthImage holed = image_of(odd_view(40, 30, 0.9), plane_surface({0, 0, 4}, {0, 0, -1}));
  for (std::size_t i = 0; i < holed.depth.size(); i += 3) holed.depth[i] = NAN;
  const Shaded shaded = shade_once(device, holed, 16, rays_of(1));
  for (std::size_t i = 0; i < holed.depth.size(); ++i)
    if (i % 3) {
      ASSERT_GE(shaded.visibility[i], 1 - 1e-6f) << i;
    }
}

TEST(ScreenRays, CodesTellShortRaysAndLongOnes) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  const reference::DepthImage image = image_of(odd_view(40, 30, 0), plane_surface({0, 0, 4}, {0, 0, -1}));
  for (const auto& [length, flagged] : {std::pair{0.02, true}, {0.5, false}, {3.0, true}})
    for (const std::uint32_t code : shade_once(device, image, 4, rays_of(length)).validity)
      ASSERT_EQ((code & validity::radius_out_of_range) != 0, flagged) << length;
}

TEST(ScreenRays, RefusesWhatItCannotDo) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  NearField none = rays_of(1);
  none.normals = "none";
  const auto refused = [&](const NearField& near, int rays) {
    return message_of(ErrorKind::invalid_input, [&] { ScreenRaysPass(device, near, rays); });
  };
  EXPECT_THAT(refused(rays_of(1), 0), testing::HasSubstr("allowed: 1 to 64"));
  EXPECT_THAT(refused(rays_of(1), 65), testing::HasSubstr("allowed: 1 to 64"));
  for (const double thickness : {0.0, -1.0, double{NAN}})
    EXPECT_THAT(refused(rays_of(1, thickness), 4), testing::HasSubstr("a number above 0"));
  NearField two = rays_of(1), quadratic = rays_of(1);
  two.second_radius = 2;
  quadratic.falloff = "quadratic";
  EXPECT_THAT(refused(two, 4), testing::HasSubstr("allowed: one"));
  EXPECT_THAT(refused(quadratic, 4), testing::HasSubstr("allowed: constant"));
  EXPECT_THAT(refused(none, 4), testing::HasSubstr("allowed: buffer, depth"));
}

}  // namespace
}  // namespace understory
