// The solid-angle passes on the device: against double, every sphere exactly and folded per tile, and what must hold
// whatever the scene: order, added spheres, own groups, tiles of any image width.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/passes/solid_angle.hpp"
#include "kernels/shared/fragment_tiles.h"
#include "kernels/shared/solid_angle.h"
#include "tests/reference/solid_angle.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fragments.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

constexpr FarFieldError each_sphere{0, 0};
constexpr std::int32_t groups = 40;
const char* const methods[] = {"solid-angle", "solid-angle-exact", "solid-angle-cosine"};

// Owners: 0 background, 1 the ground, of no group, then one per group.
OwnerTables group_owners(Device& device) {
  std::vector<Owner> owners(2 + groups);
  for (std::int32_t group = 0; group < groups; ++group) owners[static_cast<std::size_t>(group) + 2].group = group;
  return upload_owners(device, owners);
}

std::int32_t group_of(const TestFragment& fragment) { return static_cast<std::int32_t>(fragment.owner) - 2; }

/// Spheres above a square of ground, `size` m wide.
std::vector<ShadingSphere> random_spheres(std::size_t count, double size) {
  std::vector<ShadingSphere> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(8, stream_of("shading sphere"), i);
    ShadingSphere sphere{};
    sphere.x = static_cast<float>(random.uniform(-size / 2, size / 2));
    sphere.y = static_cast<float>(random.uniform(-size / 2, size / 2));
    sphere.radius = static_cast<float>(random.uniform(0.3, 4));
    sphere.z = sphere.radius + static_cast<float>(random.uniform(0, 3));
    sphere.opacity = static_cast<float>(random.uniform(0.2, 1));
    sphere.group = static_cast<record_int>(i) % groups;
    all.push_back(sphere);
  }
  return all;
}

/// A picture of ground and crowns: neighbours are near each other, some tiles see two depths.
std::vector<TestFragment> picture(std::size_t width, std::size_t height, const std::vector<ShadingSphere>& spheres) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < width * height; ++i) {
    Random random(9, stream_of("picture"), i);
    const double across = static_cast<double>(i % width) / static_cast<double>(width);
    const double down = static_cast<double>(i / width) / static_cast<double>(height);
    TestFragment f;
    f.owner = 1;
    f.position = glm::vec3(60 * (across - 0.5), 80 * (0.5 - down), 0);
    if (static_cast<int>(across * 12) % 3 == 0 && !spheres.empty()) {
      const std::size_t which = static_cast<std::size_t>(across * 12) % spheres.size();
      const ShadingSphere& own = spheres[which];
      f.normal = random_direction(random);
      f.position = glm::vec3(own.x, own.y, own.z) + own.radius * 0.9f * random_direction(random);
      f.owner = static_cast<std::uint32_t>(own.group + 2);
    }
    all.push_back(f);
  }
  return all;
}

double reference_visibility(const std::string& method, const TestFragment& f, const std::vector<ShadingSphere>& spheres,
                            bool by_quadrature) {
  double v = 1;
  const glm::dvec3 n = glm::dvec3(f.normal);
  for (const ShadingSphere& s : spheres) {
    if (s.group == group_of(f) && s.group >= 0) continue;
    const glm::dvec3 c = glm::dvec3(s.x, s.y, s.z) - glm::dvec3(f.position);
    const double r = static_cast<double>(s.radius);
    double share;
    if (method == "solid-angle")
      share = reference::paper_share(c, r);
    else if (by_quadrature)
      share = reference::blocked_share(
          c, n, r, method == "solid-angle-exact" ? reference::Weighting::uniform : reference::Weighting::cosine);
    else
      share = (method == "solid-angle-exact" ? solid_angle_exact : solid_angle_cosine)(c.x, c.y, c.z, n.x, n.y, n.z, r);
    v *= 1 - static_cast<double>(s.opacity) * share;
  }
  return v;
}

Shaded shade(const std::string& method, FarFieldError error, const std::vector<TestFragment>& fragments,
             const std::vector<ShadingSphere>& spheres, std::size_t row_length = 0) {
  return shade_everywhere(
      fragments,
      [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
        std::vector<ShadingSphere> table = spheres;
        table.resize(spheres.size() + 1);  // one more than counts
        const Buffer<ShadingSphere> buffer(device, std::span<const ShadingSphere>(table), "spheres");
        SolidAnglePass(device, method, error, lanes)
            .run(planes, group_owners(device), buffer, spheres.size(), visibility);
      },
      row_length);
}

TEST(FragmentTiles, PartitionTheUnitsOfAnyImage) {
  for (const tile_count length : {16u, 17u, 100u, 256u, 800u, 801u})
    for (const tile_count units : {1u, 16u, 63u, 1000u}) {
      const tile_count tiles = tiles_of_units(units, length);
      std::vector<int> visits(units, 0);
      for (tile_count tile = 0; tile < tiles; ++tile)
        for (tile_count row = 0; row < TILE_ROWS; ++row) {
          const tile_count top = tile / tile_columns(length) * TILE_ROWS;
          const tile_count begin = first_unit(top + row, length) + tile % tile_columns(length) * TILE_UNITS;
          const tile_count end = std::min({begin + TILE_UNITS, first_unit(top + row + 1, length), units});
          for (tile_count unit = begin; unit < end; ++unit) {
            ++visits[unit];
            EXPECT_EQ(tile_of_unit(unit, length), tile);
          }
        }
      EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), units) << length << ' ' << units;
    }
}

TEST(TileSpheres, EverySphereExactlyIsTheQuadrature) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<ShadingSphere> spheres = random_spheres(5, 30);
  for (const char* method : methods)
    for (const std::size_t size : {std::size_t{1}, std::size_t{17}, std::size_t{211}}) {
      const std::vector<TestFragment> fragments = picture(size, 1, spheres);
      const Shaded shaded = shade(method, each_sphere, fragments, spheres);
      for (std::size_t i = 0; i < size; ++i)
        EXPECT_NEAR(shaded.visibility[i], reference_visibility(method, fragments[i], spheres, true),
                    tolerance::solid_angle_product)
            << method << ' ' << i;
    }
}

TEST(TileSpheres, FoldingDistantSpheresStaysWithinItsBound) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<ShadingSphere> spheres = random_spheres(300, 400);
  const std::size_t width = 173, height = 29;
  const std::vector<TestFragment> fragments = picture(width, height, spheres);
  for (const char* method : methods) {
    const FarFieldError bound;
    const Shaded shaded = shade(method, bound, fragments, spheres, width);
    double square = 0, most = 0;
    for (std::size_t i = 0; i < fragments.size(); ++i) {
      const double error = std::abs(shaded.visibility[i] - reference_visibility(method, fragments[i], spheres, false));
      square += error * error;
      most = std::max(most, error);
    }
    const double rms = std::sqrt(square / static_cast<double>(fragments.size()));
    // Typical errors are far below the bound.
    EXPECT_LE(rms, static_cast<double>(bound.total) / 8) << method;
    EXPECT_LE(most, static_cast<double>(bound.total) + tolerance::solid_angle_product) << method;
  }
}

TEST(TileSpheres, MoreSpheresThanATileListsAreAllTried) {
  UNDERSTORY_NEEDS_DEVICE();
  const std::vector<ShadingSphere> spheres = random_spheres(500, 30);
  std::vector<ShadingSphere> thin = spheres;
  for (ShadingSphere& sphere : thin) sphere.opacity *= 0.02f;
  const std::vector<TestFragment> fragments = picture(33, 3, thin);
  const Shaded shaded = shade("solid-angle-cosine", each_sphere, fragments, thin, 33);
  for (std::size_t i = 0; i < fragments.size(); ++i)
    EXPECT_NEAR(shaded.visibility[i], reference_visibility("solid-angle-cosine", fragments[i], thin, false),
                5 * tolerance::solid_angle_product);
}

TEST(TileSpheres, OrderChangesNothing) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<ShadingSphere> spheres = random_spheres(40, 60);
  const std::vector<TestFragment> fragments = picture(100, 3, spheres);
  const Shaded forward = shade("solid-angle-cosine", each_sphere, fragments, spheres, 100);
  std::reverse(spheres.begin(), spheres.end());
  const Shaded backward = shade("solid-angle-cosine", each_sphere, fragments, spheres, 100);
  for (std::size_t i = 0; i < fragments.size(); ++i)
    EXPECT_NEAR(forward.visibility[i], backward.visibility[i], tolerance::solid_angle_product);
  EXPECT_EQ(forward.validity, backward.validity);
}

TEST(TileSpheres, AnotherSphereNeverBrightens) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<ShadingSphere> spheres = random_spheres(12, 60);
  const std::vector<TestFragment> fragments = picture(100, 3, spheres);
  for (const char* method : methods) {
    std::vector<ShadingSphere> fewer = spheres;
    fewer.pop_back();
    const Shaded all = shade(method, each_sphere, fragments, spheres, 100);
    const Shaded without = shade(method, each_sphere, fragments, fewer, 100);
    for (std::size_t i = 0; i < fragments.size(); ++i) EXPECT_LE(all.visibility[i], without.visibility[i]) << method;
  }
}

TEST(TileSpheres, OwnGroupAndNothingLeaveFragmentsOpen) {
  UNDERSTORY_NEEDS_DEVICE();
  ShadingSphere near{0, 0, 2, 1, 1, 3, {}};
  const std::vector<TestFragment> fragments = {{{0, 0, 0}, {0, 0, 1}, 5},     // group 3
                                               {{0, 0, 0}, {0, 0, 1}, 1},     // no group
                                               {{0, 0, 0}, {0, 0, 1}, 4},     // group 2
                                               {{0, 0, 1.5f}, {0, 0, 1}, 1},  // inside
                                               {{0, 0, 1.5f}, {0, 0, 1}, 5}};
  const Shaded shaded = shade("solid-angle-cosine", {}, fragments, {near});
  EXPECT_EQ(shaded.visibility[0], 1);
  EXPECT_NEAR(shaded.visibility[1], 0.75, tolerance::solid_angle);
  EXPECT_NEAR(shaded.visibility[2], 0.75, tolerance::solid_angle);
  EXPECT_NEAR(shaded.visibility[3], 0, tolerance::solid_angle);
  EXPECT_EQ(shaded.visibility[4], 1);
  EXPECT_EQ(shaded.validity, (std::vector<std::uint32_t>{0, 0, 0, validity::occluder_too_close, 0}));

  near.opacity = 0;
  EXPECT_EQ(shade("solid-angle-exact", {}, fragments, {near}).visibility, std::vector<float>(5, 1.0f));
  EXPECT_EQ(shade("solid-angle", {}, fragments, {}).visibility, std::vector<float>(5, 1.0f));
}

TEST(TileSpheres, GarbageStaysWithinBounds) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<ShadingSphere> spheres = random_spheres(9, 20);
  spheres[0].radius = NAN;
  spheres[1].x = INFINITY;
  spheres[2].y = NAN;
  spheres[3].radius = -1;
  spheres[4].opacity = NAN;
  spheres[5].opacity = 7;
  spheres[6].radius = 1e30f;
  const std::vector<TestFragment> fragments = garbage(groups + 2);
  for (const char* method : methods)
    for (const FarFieldError error : {each_sphere, FarFieldError{}}) {
      const Shaded shaded = shade(method, error, fragments, spheres);
      for (std::size_t i = 0; i < fragments.size(); ++i)
        if (std::isnan(fragments[i].position.x)) {
          EXPECT_EQ(shaded.visibility[i], 1) << method;
        }
    }
}

TEST(TileSpheres, NamesAnUnknownMethod) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  EXPECT_NE(message_of(ErrorKind::unexpected, [&] { SolidAnglePass(device, "solid-angel"); }).find("solid-angel"),
            std::string::npos);
}

}  // namespace
}  // namespace understory
