// The light among grass: closed forms of endless layers, edges, what blades and meshes hand to it.
#include "sim/grass_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/grass.hpp"
#include "sim/grass_pieces.hpp"
#include "tests/support/data.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

const double pi = std::numbers::pi;

/// Square cells of 1 m under grass 1 m high wherever `area_density(column, row)`, 1/m, says; spherical leaf angles.
template <class Density>
GrassArea even_grass(std::uint32_t side, const Density& area_density) {
  GrassArea area;
  area.columns = area.rows = side;
  area.extent = {{0, 0}, {double(side), double(side)}};
  area.cell = 1;
  area.slabs = 8;
  area.slab = 1.0 / 8;
  area.ground.assign(area.column_count(), 0);
  for (std::uint32_t slab = 0; slab < area.slabs; ++slab)
    for (std::uint32_t row = 0; row < side; ++row)
      for (std::uint32_t column = 0; column < side; ++column)
        for (int ring = 0; ring < sky_rings; ++ring)
          area.projection.push_back(static_cast<float>(area_density(column, row) / 2));
  return area;
}

const LayerLight& node(const GrassLayer& layer, std::uint32_t column, std::uint32_t row, std::uint32_t level) {
  return layer.light[(std::size_t{row} * layer.columns + column) * layer.levels + level];
}

double facing_up(const LayerLight& light) { return 2 * double(light.above + light.zenith); }

TEST(GrassLayer, WithoutBladesIsOpen) {
  for (const bool open_below : {false, true})
    for (const LayerLight& light : light_grass(even_grass(9, [](auto, auto) { return 0.0; }), open_below).light) {
      EXPECT_NEAR(light.above, 0.5, 1e-5);
      EXPECT_NEAR(light.zenith, 0, 1e-5);
      EXPECT_NEAR(light.x, 0, 1e-5);
      EXPECT_NEAR(light.y, 0, 1e-5);
      EXPECT_NEAR(light.below, open_below ? 0.5 : 0, 1e-5);
    }
}

TEST(GrassLayer, OfEndlessGrassIsTheExponentialIntegral) {
  // FORMULAS.md, analytic truths: the ground under spherical leaf angles sees 2 E3(LAI/2).
  for (const double lai : {0.5, 1.0, 2.0, 4.0}) {
    const GrassLayer layer = light_grass(even_grass(61, [=](auto, auto) { return lai; }), false);
    for (std::uint32_t level = 0; level < layer.levels; ++level) {
      const double above = lai * (1 - double(level) / (layer.levels - 1));
      EXPECT_NEAR(facing_up(node(layer, 30, 30, level)), 2 * exponential_integral_3(above / 2), 0.03) << lai << level;
    }
  }
}

TEST(GrassLayer, BrightensUpwardsAndFollowsTheNormal) {
  const GrassLayer layer = light_grass(even_grass(41, [](auto, auto) { return 2.0; }), false);
  for (std::uint32_t level = 0; level + 1 < layer.levels; ++level)
    EXPECT_LT(facing_up(node(layer, 20, 20, level)), facing_up(node(layer, 20, 20, level + 1)));
  const LayerLight& deep = node(layer, 20, 20, 0);
  EXPECT_NEAR(deep.x, 0, 1e-4);
  EXPECT_NEAR(deep.y, 0, 1e-4);
  EXPECT_GT(facing_up(deep), double(deep.above));  // upright, n_z = 0, it sees `above`
}

TEST(GrassLayer, IsLitFromItsEdges) {
  const GrassLayer layer =
      light_grass(even_grass(41, [](auto column, auto) { return column < 20 ? 6.0 : 0.0; }), false);
  const auto level_ground = [&](std::uint32_t column) { return node(layer, column, 20, 0); };
  EXPECT_GT(facing_up(level_ground(19)), facing_up(level_ground(10)));
  EXPECT_GT(level_ground(19).x, 0.02) << "faces the open side";
  EXPECT_NEAR(level_ground(10).x, 0, 1e-3);
  EXPECT_GT(level_ground(21).x, 0.01) << "on the open side the grass is in the west";
  EXPECT_NEAR(facing_up(level_ground(36)), 1, 0.03);
  EXPECT_NEAR(level_ground(30).y, 0, 1e-4);
}

TEST(GrassLayer, BladesDoNotShadeThemselves) {
  const GrassArea grass = even_grass(41, [](auto, auto) { return 2.0; });
  GrassArea own = grass;
  own.own = own.projection;
  for (float& share : own.own) share /= 2;
  for (const bool open_below : {false, true}) {
    const GrassLayer whole = light_grass(grass, open_below), spared = light_grass(own, open_below);
    // On the ground there is no own blade.
    EXPECT_EQ(node(spared, 20, 20, 0).above, node(whole, 20, 20, 0).above);
    for (std::uint32_t level = 1; level + 1 < whole.levels; ++level) {
      // Half the blades of the slab above, at most: e^(G LAI / 8 / 2 / cos) along the steepest ring and the flattest
      // one that is spared for half a cell.
      const double ratio = facing_up(node(spared, 20, 20, level)) / facing_up(node(whole, 20, 20, level));
      EXPECT_GT(ratio, std::exp(2.0 / 2 / 8 / 2)) << level;
      EXPECT_LT(ratio, std::exp(2.0 / 2 * 0.6 / 2)) << level;
    }
    if (!open_below) {
      EXPECT_EQ(node(spared, 20, 20, whole.levels - 1).above, node(whole, 20, 20, whole.levels - 1).above);
    }
  }
}

TEST(GrassArea, MeanProjectionIsTheMeanOverTheAzimuth) {
  for (const double normal : {0.0, 0.3, 0.7, 1.0})
    for (const double direction : {0.05, 0.4, 0.9}) {
      double sum = 0;
      constexpr int turns = 20000;
      for (int i = 0; i < turns; ++i)
        sum += std::abs(normal * direction + std::sqrt((1 - normal * normal) * (1 - direction * direction)) *
                                                 std::cos(2 * pi * (i + 0.5) / turns));
      EXPECT_NEAR(mean_projection(normal, -direction), sum / turns, 1e-6) << normal << ' ' << direction;
    }
}

/// Half the leaf area: the mean over the sphere of what any surface turns to a direction.
double projected_area(const GrassArea& area) {
  double sum = 0;
  for (const float projection : area.projection) sum += double(projection);
  return sum / sky_rings * area.cell * area.cell * area.slab;
}

TEST(GrassArea, HoldsTheAreaOfAllBlades) {
  Scene scene = small_meadow();
  scene.plants.clear();
  scene.species.clear();
  const World world = build_world(scene);
  double blades = 0;
  for (const GrassBlades& field : world.grass)
    for (std::size_t i = 0; i < field.size(); ++i)
      blades += 2 * blade_fullness * double(field.length[i]) * double(field.half_width[i]);
  // A strip whose width is not at right angles to its bend is a little narrower.
  EXPECT_NEAR(projected_area(measure_grass(world)), blades / 2, 0.04 * blades / 2);
}

/// Share of the area around a place on a blade that is the blade itself.
double own_share(const GrassArea& area) {
  double own = 0, all = 0;
  for (std::size_t i = 0; i < area.own.size(); ++i) {
    EXPECT_LE(area.own[i], area.projection[i] * 1.0001f);
    own += double(area.own[i]);
    all += double(area.projection[i]);
  }
  return own / all;
}

TEST(GrassArea, ALoneBladeIsAllItsOwn) {
  Scene scene = small_meadow();
  scene.plants.clear();
  scene.species.clear();
  scene.grass.front().density = 40;  // far fewer blades than columns
  EXPECT_GT(own_share(measure_grass(build_world(scene))), 0.9);
  scene.grass.front().density = 20'000;
  EXPECT_LT(own_share(measure_grass(build_world(scene))), 0.5);
}

TEST(GrassArea, BladesOfAMeshAreWholeThoughTheirTrianglesAreWrittenOneByOne) {
  UNDERSTORY_NEEDS_DATA();
  SpeciesSource wheat;
  wheat.name = "wheat";
  wheat.mesh = data_folder() / "plants/grass_wheat_6x6.glb";
  wheat.leaf_materials.clear();
  wheat.blade_materials = {"leaf*", "blade*"};
  Scene scene = one_plant(wheat);
  std::uint32_t blades = 0, triangles = 0, last = 0xffffffffu;
  visit_grass(build_world(scene), 1e9, [&](const GrassPiece& piece) {
    blades += piece.blade != last;
    last = piece.blade;
    ++triangles;
  });
  EXPECT_GT(triangles, 250'000u);
  EXPECT_LT(blades, 20'000u);
}

TEST(GrassArea, OfASceneWithoutGrassIsEmpty) {
  Scene scene = small_meadow();
  scene.grass.clear();
  EXPECT_EQ(measure_grass(build_world(scene)).columns, 0u);
}

TEST(GrassArea, OfAMeshHoldsItsBlades) {
  UNDERSTORY_NEEDS_DATA();
  SpeciesSource lawn;
  lawn.name = "lawn";
  lawn.mesh = data_folder() / "plants/grass_lawn_2m.glb";
  Scene scene = one_plant(lawn);
  scene.plants.front().spots.front().yaw = 0;
  const World world = build_world(scene);
  const GrassArea area = measure_grass(world);
  EXPECT_EQ(world.instances.back().crown, -1) << "grass is no crown";
  EXPECT_EQ(world.owners[world.instances.back().run_owner.front()].surface, SurfaceClass::blade);
  EXPECT_NEAR(area.slab * area.slabs, 0.19, 0.01);
  // 2.3 m square and a border of twice its height all around.
  EXPECT_NEAR(area.extent.high.x - area.extent.low.x, 2.31 + 4 * 0.19, 0.1);
  EXPECT_NEAR(projected_area(area), 2.69 / 2, 0.05);
}

}  // namespace
}  // namespace understory
