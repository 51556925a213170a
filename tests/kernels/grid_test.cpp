// The scalar grid methods on the device: against double, own surfaces, many bodies, and what must not matter.
#include "host/passes/grid.hpp"

#include <gtest/gtest.h>

#include "tests/reference/grid.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/grids.hpp"
#include "tests/support/tolerances.hpp"

namespace understory {
namespace {

Shaded shade(const std::string& method, const std::vector<TestFragment>& fragments, const std::vector<GridBody>& bodies,
             std::size_t row_length = 0) {
  return shade_everywhere(
      fragments,
      [&](Device& device, int lanes, FragmentPlanes& planes, Buffer<float>& visibility) {
        const GridTable grids = upload_grids(device, bodies, false);
        GridPass(device, method, lanes).run(planes, body_owners(device, 50), grids, visibility);
      },
      row_length);
}

double reference_visibility(const std::vector<GridBody>& bodies, const TestFragment& f, double self_share) {
  double v = 1;
  for (const GridBody& body : bodies)
    v *= 1 - reference::grid_blocked(body, f, static_cast<std::int32_t>(f.owner) - 2 == body.group, self_share);
  return v;
}

TEST(Grid, DeviceIsTheReference) {
  UNDERSTORY_NEEDS_DEVICE();
  for (const GridBorder border : {GridBorder::fade, GridBorder::rescale}) {
    const std::vector<GridBody> bodies = random_bodies(6, border);
    for (const std::size_t size : odd_sizes) {
      const std::vector<TestFragment> fragments = fragments_among(size, bodies.size());
      const Shaded full = shade("grid", fragments, bodies), half = shade("grid-self-paper", fragments, bodies);
      for (std::size_t i = 0; i < size; ++i) {
        ASSERT_NEAR(full.visibility[i], reference_visibility(bodies, fragments[i], 1), tolerance::grid) << i;
        ASSERT_NEAR(half.visibility[i], reference_visibility(bodies, fragments[i], 0.5), tolerance::grid) << i;
      }
    }
  }
}

TEST(Grid, ClosedForms) {
  UNDERSTORY_NEEDS_DEVICE();
  // A grid that holds one number everywhere: 2 a for receivers, 2 a - 1 and half of it on the body itself.
  GridBody body;
  body.grid = {{2, 3, 2}, glm::vec3(-1), glm::vec3(1), 0, std::vector<float>(12, 0.8f), {}};
  body.group = 0;
  TestFragment receiver{glm::vec3(0.3f, -0.2f, 0.1f), glm::vec3(0, 0, 1), 1}, own = receiver, outside = receiver;
  own.owner = 2;
  outside.position.x = 1.001f;
  const auto v = [&](const std::string& method, const TestFragment& f) {
    return shade(method, {f}, {body}).visibility[0];
  };
  EXPECT_NEAR(v("grid", receiver), 0, 1e-6);
  EXPECT_NEAR(v("grid", own), 1 - 0.6, 1e-6);
  EXPECT_NEAR(v("grid-self-paper", own), 1 - 0.3, 1e-6);
  EXPECT_EQ(v("grid", outside), 1);
  body.grid.share.assign(12, 0.2f);
  EXPECT_NEAR(v("grid", receiver), 0.6, 1e-6);
  EXPECT_EQ(v("grid", own), 1);
}

TEST(Grid, WithoutBodiesEverythingIsOpen) {
  UNDERSTORY_NEEDS_DEVICE();
  const Shaded shaded = shade("grid", fragments_among(40, 1), {});
  for (const float v : shaded.visibility) EXPECT_EQ(v, 1);
}

TEST(Grid, BorderIsFlaggedAndOutsideIsNot) {
  UNDERSTORY_NEEDS_DEVICE();
  GridBody body;
  body.grid = {{17, 17, 17}, glm::vec3(-1), glm::vec3(1), 0, std::vector<float>(17 * 17 * 17, 0.1f), {}};
  std::vector<TestFragment> fragments(3);
  fragments[0].position = glm::vec3(0.5f, 0, 0);
  fragments[1].position = glm::vec3(0.95f, 0, 0);
  fragments[2].position = glm::vec3(1.05f, 0, 0);
  EXPECT_EQ(shade("grid", fragments, {body}).validity, (std::vector<std::uint32_t>{0, validity::grid_border, 0}));
}

TEST(Grid, TellsWhatIsInsideTheSolid) {
  UNDERSTORY_NEEDS_DEVICE();
  GridSettings settings = coarse({32, 32, 32});
  settings.stretch = 2;
  const TestMesh mesh = cube();
  GridBody body;
  body.grid = bake_grid(mesh.vertices, mesh.triangles, settings);
  const glm::vec3 cell = body.grid.position(16, 16, 16) - body.grid.position(15, 15, 15);
  const float deep = 0.5f - 2 * 1.2f * cell.x;  // two samples, which lie wider apart towards the faces
  ASSERT_GT(deep, 0.2f);
  std::vector<TestFragment> fragments;
  std::vector<bool> within;
  for (const glm::vec3 towards : {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0.3f, -1, 0.9f), glm::vec3(-1, 1, -1)})
    for (const float reach : {deep, 0.5f, 0.501f, 0.6f, 1.0f, 2.0f}) {
      if (towards == glm::vec3(0) && reach != deep) continue;
      fragments.push_back({reach * towards, glm::vec3(0, 0, 1), 1});
      within.push_back(reach == deep);
    }
  for (const char* method : {"grid", "grid-self-paper"}) {
    const Shaded shaded = shade(method, fragments, {body});
    for (std::size_t i = 0; i < fragments.size(); ++i)
      EXPECT_EQ((shaded.validity[i] & validity::occluder_too_close) != 0, within[i]) << method << ' ' << i;
    EXPECT_EQ(shaded.visibility[0], 0) << "nothing of the sky is seen from within";
  }
}

TEST(Grid, MoreBodiesThanATileListsAreAllTried) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<GridBody> bodies = random_bodies(300);
  for (GridBody& body : bodies)
    for (float& share : body.grid.share) share *= 0.01f;
  const std::vector<TestFragment> fragments = fragments_among(33, 50);
  const Shaded shaded = shade("grid", fragments, bodies);
  for (std::size_t i = 0; i < fragments.size(); ++i)
    EXPECT_NEAR(shaded.visibility[i], reference_visibility(bodies, fragments[i], 1), 20 * tolerance::grid) << i;
}

TEST(Grid, TilesOfAnyWidthListEveryBodyTheyMeet) {
  UNDERSTORY_NEEDS_DEVICE();
  // Bodies spread wide: most tiles meet few of them. A picture of the ground, row by row.
  std::vector<GridBody> bodies = random_bodies(40);
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].position *= 8.0;
  for (const std::size_t width : {16, 47, 100}) {
    std::vector<TestFragment> fragments(width * 37);
    for (std::size_t i = 0; i < fragments.size(); ++i) {
      fragments[i].owner = 1;
      fragments[i].position = glm::vec3(40 * (static_cast<float>(i % width) / static_cast<float>(width) - 0.5f),
                                        40 * (static_cast<float>(i / width) / 37.0f - 0.5f), 0);
    }
    const Shaded shaded = shade("grid", fragments, bodies, width);
    for (std::size_t i = 0; i < fragments.size(); i += 7)
      ASSERT_NEAR(shaded.visibility[i], reference_visibility(bodies, fragments[i], 1), tolerance::grid) << i;
  }
}

TEST(Grid, GarbageStaysInRange) {
  UNDERSTORY_NEEDS_DEVICE();
  std::vector<GridBody> bodies = random_bodies(3);
  for (const char* method : {"grid", "grid-self-paper"}) shade(method, garbage(8), bodies);  // checks [0, 1]
  bodies[1].position = glm::dvec3(NAN);
  bodies[2].position = glm::dvec3(1e30);
  shade("grid", garbage(8), bodies);
}

TEST(Grid, RefusesOtherMethods) {
  UNDERSTORY_NEEDS_DEVICE();
  Device device;
  EXPECT_NE(message_of(ErrorKind::unexpected, [&] { GridPass(device, "gird"); }).find("'gird'"), std::string::npos);
}

}  // namespace
}  // namespace understory
