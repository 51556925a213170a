// What a frame draws of a scene: every triangle once, nothing that is in view left out, and thinned where it is small.
#include "host/frame/draw_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "host/frame/camera_view.hpp"
#include "host/frame/thinning.hpp"
#include "sim/random.hpp"
#include "tests/reference/pose_mesh.hpp"
#include "tests/support/frames.hpp"

namespace understory {
namespace {

glm::vec3 rest_point(const VertexBlocks& v, std::size_t i) { return {v.x[i], v.y[i], v.z[i]}; }

World windy_meadow() {
  Scene scene = meadow_view();
  scene.wind.speed = 15;
  return build_world(scene);
}

using Corners = std::array<float, 9>;
Corners corners_of(const VertexBlocks& v, const std::array<std::size_t, 3>& index) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      corners[3 * k + axis] = rest_point(v, index[k])[static_cast<glm::length_t>(axis)];
  return corners;
}

TEST(DetailLayout, HoldsEveryTriangleOfEveryPrototypeOnce) {
  const World world = windy_meadow();
  const DetailLayout layout = lay_out_detail(world, true);
  ASSERT_EQ(layout.sections.size(), world.prototypes.size());
  std::size_t thinned = 0, twigs = 0;
  for (std::size_t p = 0; p < world.prototypes.size(); ++p) {
    const Prototype& prototype = world.prototypes[p];
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Corners>> expected, found;  // by run and limb
    for (std::uint32_t run = 0; run < prototype.runs.size(); ++run)
      for (std::uint32_t t = prototype.runs[run].first; t < prototype.runs[run].first + prototype.runs[run].count;
           ++t) {
        const std::uint32_t* c = &prototype.triangles[3 * std::size_t{t}];
        expected[{run, prototype.vertices.block_limb[c[0] / vertex_block]}].push_back(
            corners_of(prototype.vertices, {c[0], c[1], c[2]}));
      }
    for (const DetailSection& section : layout.sections[p]) {
      EXPECT_EQ(section.triangles % unit_triangles, 0u);
      thinned += section.thins;
      twigs += section.far >= 0;
      if (section.is_far) continue;
      for (std::uint32_t t = section.first_triangle; t < section.first_triangle + section.triangles; ++t) {
        const std::size_t first = std::size_t{section.first_block} * vertex_block;
        if (layout.source[t] == no_source) continue;
        found[{section.run, section.limb}].push_back(
            corners_of(layout.vertices, {first + layout.a[t], first + layout.b[t], first + layout.c[t]}));
      }
    }
    for (auto* all : {&expected, &found})
      for (auto& [key, triangles] : *all) std::sort(triangles.begin(), triangles.end());
    EXPECT_EQ(found, expected) << prototype.name;
  }
  EXPECT_GT(thinned, 0u);
  EXPECT_GT(twigs, 0u);
}

TEST(DetailLayout, AUnitNeedsNoVertexOfALaterOne) {
  const World world = windy_meadow();
  const DetailLayout layout = lay_out_detail(world, true);
  for (const std::vector<DetailSection>& sections : layout.sections)
    for (const DetailSection& section : sections) {
      if (!section.thins) continue;
      ASSERT_EQ(section.blocks, section.triangles / unit_triangles * section.unit_blocks);
      for (std::uint32_t t = 0; t < section.triangles; ++t) {
        const std::uint32_t end = (t / unit_triangles + 1) * section.unit_blocks * vertex_block,
                            at = section.first_triangle + t;
        ASSERT_LT(std::max({layout.a[at], layout.b[at], layout.c[at]}), end);
      }
    }
}

/// Twice the area of a triangle of a section.
double area_of(const DetailLayout& layout, const DetailSection& section, std::size_t triangle) {
  const std::size_t first = std::size_t{section.first_block} * vertex_block;
  const glm::dvec3 a(rest_point(layout.vertices, first + layout.a[triangle])),
      b(rest_point(layout.vertices, first + layout.b[triangle])),
      c(rest_point(layout.vertices, first + layout.c[triangle]));
  return glm::length(glm::cross(b - a, c - a));
}

TEST(DetailLayout, ALeafDrawnAsOneTriangleKeepsItsAreaATwigHalfOfItsSurface) {
  const World world = windy_meadow();
  const DetailLayout layout = lay_out_detail(world, true);
  std::size_t leaves = 0, twigs = 0;
  for (const std::vector<DetailSection>& sections : layout.sections)
    for (const DetailSection& whole : sections) {
      if (whole.far < 0) continue;
      // Triangles of one leaf or twig follow each other and share corners; what they came from says which leaf each is.
      std::map<std::uint32_t, double> area_by_source;
      std::vector<std::uint32_t> members;
      double area = 0;
      std::set<std::uint32_t> corners;
      const auto end_leaf = [&] {
        for (const std::uint32_t source : members) area_by_source[source] = area;
        members.clear();
        corners.clear();
        area = 0;
      };
      for (std::uint32_t t = whole.first_triangle; t < whole.first_triangle + whole.triangles; ++t) {
        if (layout.source[t] == no_source) continue;
        const std::uint32_t of[] = {layout.a[t], layout.b[t], layout.c[t]};
        if (std::none_of(of, of + 3, [&](std::uint32_t v) { return corners.contains(v); })) end_leaf();
        corners.insert(of, of + 3);
        members.push_back(layout.source[t]);
        area += area_of(layout, whole, t);
      }
      end_leaf();
      const DetailSection& far = sections[static_cast<std::size_t>(whole.far)];
      for (std::uint32_t t = far.first_triangle; t < far.first_triangle + far.triangles; ++t) {
        if (layout.source[t] == no_source) continue;
        ASSERT_TRUE(area_by_source.contains(layout.source[t]));
        const double expected = area_by_source[layout.source[t]] * (whole.thins ? 1 : 0.5);
        ASSERT_NEAR(area_of(layout, far, t), expected, (whole.thins ? 1e-4 : 5e-3) * expected);  // in float, and thin
        ++(whole.thins ? leaves : twigs);
      }
    }
  EXPECT_GT(leaves, 500u);
  EXPECT_GT(twigs, 50u);
}

TEST(DrawList, SpheresHoldTheirSectionsInAStorm) {
  const World world = windy_meadow();
  const DetailLayout layout = lay_out_detail(world, true);
  for (double time : {0.0, 2.3, 7.1}) {
    const Pose pose = pose_at(world, time, world.scene.camera.position);
    for (std::size_t i = 0; i < world.instances.size(); ++i)
      for (const DetailSection& section : layout.sections[world.instances[i].prototype]) {
        const LimbPose& limb = pose.limbs[pose.first_limb[i] + section.limb];
        const glm::vec4 sphere = posed_sphere(limb, section, world.instances[i].scale);
        for (std::size_t v = section.first_block * vertex_block;
             v < (section.first_block + section.blocks) * vertex_block; v += 3) {
          const VertexBlocks& all = layout.vertices;
          const glm::dvec3 flutter(all.flutter_x[v], all.flutter_y[v], all.flutter_z[v]);
          const glm::dvec3 at =
              reference::posed_point(limb, glm::dvec3(rest_point(all, v)), flutter, all.flutter_phase[v]);
          ASSERT_LE(glm::distance(at, glm::dvec3(glm::vec3(sphere))), double(sphere.w) * 1.0001 + 1e-4)
              << world.prototypes[world.instances[i].prototype].name << " at " << time << " s";
        }
      }
  }
}

TEST(DrawList, NoSphereThatReachesTheImageIsOutOfView) {
  Camera camera;
  camera.position = {0, 0, 0};
  camera.target = {1, 2, -0.3};
  const CameraView view = camera_view(camera, {160, 90}, glm::dvec2(0));
  Random random(3, 1);
  int seen = 0, unseen = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto away = [&] { return random.normal(0, 8); };
    const glm::dvec3 centre(away(), away(), away());
    const double radius = std::abs(random.normal(0, 1));
    const bool in = in_view(view, centre, radius);
    bool reaches = false;
    for (int k = 0; k < 40 && !reaches; ++k) {  // points within the sphere
      const glm::dvec3 p = centre + radius * random.uniform() *
                                        glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
      const auto along = [&](const float(&a)[4]) {
        return double(a[0]) * p.x + double(a[1]) * p.y + double(a[2]) * p.z;
      };
      const double z = along(view.forward), x = along(view.right) * double(view.focal) / z + double(view.centre_x),
                   y = along(view.down) * double(view.focal) / z + double(view.centre_y);
      reaches = z > double(view.near_plane) && x >= 0 && x <= view.width && y >= 0 && y <= view.height;
    }
    if (reaches) {
      EXPECT_TRUE(in) << i;
    }
    ++(in ? seen : unseen);
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(unseen, 10000) << "what is far outside is left out";
}

TEST(DrawList, CulledHoldsAllOfWhatIsInViewAndThinnedLess) {
  const World world = windy_meadow();
  const DetailLayout layout = lay_out_detail(world, true);
  const BladeLayout blades = lay_out_blades(world);
  const Pose pose = pose_without_plants(world, 1, world.scene.camera.position);
  const CameraView view = camera_view(world.scene.camera, world.scene.image, glm::dvec2(0));
  const auto listed = [&](bool thinning, const CameraView& camera) {
    DrawLister lister(world, layout, blades, thinning);
    lister.begin(pose, camera);
    return lister.next();
  };
  const DrawList whole = listed(false, view), thinned = listed(true, view);
  EXPECT_LT(thinned.triangles, whole.triangles);
  EXPECT_TRUE(whole.mesh.block_scale.empty());
  EXPECT_EQ(thinned.mesh.block_scale.size(), thinned.mesh.blocks.size());
  for (const BladeUnit& unit : whole.blade_units) {
    EXPECT_EQ(unit.pairs, 3u);
    EXPECT_EQ(unit.width, 1.0f);
  }
  for (const DrawList* list : {&whole, &thinned})
    for (const TriangleChunk& chunk : list->mesh.chunks) {
      ASSERT_LE(chunk.count, triangles_per_chunk);
      ASSERT_LT(chunk.first_vertex, list->vertices);
    }
  Camera away = world.scene.camera;
  away.target = 2.0 * away.position - away.target + glm::dvec3(0, 0, 50);  // the sky behind
  const DrawList behind = listed(false, camera_view(away, world.scene.image, glm::dvec2(0)));
  EXPECT_LT(behind.triangles, whole.triangles / 4);
}

TEST(DrawList, BatchesHoldTogetherWhatOneListHolds) {
  const World world = windy_meadow();
  const DetailLayout layout = lay_out_detail(world, true);
  const BladeLayout blades = lay_out_blades(world);
  const Pose pose = pose_without_plants(world, 1, world.scene.camera.position);
  const CameraView view = camera_view(world.scene.camera, world.scene.image, glm::dvec2(0));
  DrawLister together(world, layout, blades, false), apart(world, layout, blades, false, 5000);
  together.begin(pose, view);
  apart.begin(pose, view);
  const DrawList& whole = together.next();
  EXPECT_FALSE(together.more());
  std::uint64_t triangles = 0;
  std::size_t batches = 0, units = 0, blocks = 0;
  while (apart.more()) {
    const DrawList& batch = apart.next();
    ++batches;
    triangles += batch.triangles;
    units += batch.blade_units.size();
    blocks += batch.mesh.blocks.size();
    ASSERT_EQ(batch.first_unit.size(), world.grass.size() + 1);
    EXPECT_EQ(batch.first_unit.back(), batch.blade_units.size());
    for (const PosedBlock& block : batch.mesh.blocks) ASSERT_LT(block.limb_pose, batch.limbs.size());
    for (const TriangleChunk& chunk : batch.mesh.chunks) ASSERT_LT(chunk.first_vertex, batch.vertices);
  }
  EXPECT_GT(batches, 3u);
  EXPECT_EQ(triangles, whole.triangles);
  EXPECT_EQ(units, whole.blade_units.size());
  EXPECT_EQ(blocks, whole.mesh.blocks.size());
}

TEST(DrawList, PlantsPosedOneByOneAreThoseOfTheWholePose) {
  const World world = windy_meadow();
  const glm::dvec3 eye(1, 2, 3);
  const Pose whole = pose_at(world, 4, eye), without = pose_without_plants(world, 4, eye);
  ASSERT_EQ(whole.crowns.size(), without.crowns.size());
  for (std::size_t i = 0; i < whole.crowns.size(); ++i)
    EXPECT_EQ(whole.crowns[i].sphere_centre, without.crowns[i].sphere_centre);
  for (std::size_t i = 0; i < world.instances.size(); ++i) {
    const bool plant = world.instances[i].role == Instance::Role::plant;
    const std::vector<LimbPose> limbs = plant ? plant_limbs_at(world, i, 4, eye) : std::vector<LimbPose>();
    const std::size_t count = world.prototypes[world.instances[i].prototype].limbs.size();
    const LimbPose* expected = &whole.limbs[whole.first_limb[i]];
    const LimbPose* found = plant ? limbs.data() : &without.limbs[without.first_limb[i]];
    EXPECT_EQ(std::memcmp(expected, found, count * sizeof(LimbPose)), 0) << "instance " << i;
  }
}

}  // namespace
}  // namespace understory
