// rasterise and resolve over triangles and blades together: every vector width and both layouts of the visibility
// buffer see the same triangles, and those that rays in double see. Small, so that oclgrind can follow each access.
#include <gtest/gtest.h>

#include <cmath>

#include "host/frame/camera_view.hpp"
#include "host/frame/geometry.hpp"
#include "host/frame/read_back.hpp"
#include "host/passes/pose_mesh.hpp"
#include "host/passes/resolve.hpp"
#include "sim/random.hpp"
#include "tests/reference/rasterise.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/pose_on_device.hpp"

namespace understory {
namespace {

constexpr ImageSize image{33, 21};

/// 301 triangles of all sizes, some behind the eye and some through the near plane, and 259 blades before it.
World scattered_world() {
  Random random(9, 6);
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < 3 * 301; ++i) {
    if (i % 3 == 0) vertices.emplace_back(random.uniform(-6, 6), random.uniform(-1, 12), random.uniform(-5, 5));
    if (i % 3 != 0)
      vertices.push_back(vertices[i - i % 3] +
                         glm::vec3(0.7 * random.normal(), 0.7 * random.normal(), 0.7 * random.normal()));
    triangles.push_back(i);
  }
  World world = world_of_triangles(vertices, triangles);
  world.owners.resize(3);
  world.owners[2].surface = SurfaceClass::blade;
  GrassBlades& blades = world.grass.emplace_back();
  blades.owner = 2;
  for (int i = 0; i < 259; ++i) {
    const auto add = [&](std::vector<float>& plane, double low, double high) {
      plane.push_back(static_cast<float>(random.uniform(low, high)));
    };
    add(blades.root_x, -2, 2), add(blades.root_y, -0.5, 4), add(blades.root_z, -1, -0.8);
    add(blades.length, 0.3, 1), add(blades.half_width, 0.01, 0.1);
    add(blades.bend_x, -1, 1), add(blades.bend_y, -1, 1), add(blades.facing, 0, 6.28);
    add(blades.flexibility, 1, 1), add(blades.phase, 0, 1);
  }
  return world;
}

CameraView level_view() {
  Camera camera;
  camera.position = {0, 0, 0};
  camera.target = {0, 1, 0};
  camera.vertical_fov = 0.9;
  camera.near_plane = 0.1;
  return camera_view(camera, image, glm::dvec2(0));
}

Geometry posed_geometry(Device& device, const World& world) {
  Geometry geometry = upload_geometry(device, world);
  PoseMeshPass(device).run(geometry.rest, geometry.blocks, upload_test_data(device, std::vector{standing_limb()}),
                           geometry.posed);
  GrassWind calm{};
  calm.direction_x = calm.lateral_scale = calm.series_rate = 1;
  calm.series_count = 2;
  const SwaySeries series = upload_test_data(device, std::vector<std::array<float, 2>>(2));
  const FieldRange& field = geometry.fields.front();
  PoseGrassPass(device).run(geometry.blades, calm, series, field.first_blade, field.blades, field.first_vertex,
                            geometry.posed);
  return geometry;
}

Frame draw(Device& device, Geometry& geometry, int lanes, bool wide_atomics) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  VisibilityBuffer visible{Buffer<std::uint32_t>(device, 2 * pixels, "visible")};
  const CameraView camera = level_view();
  const TriangleTables& t = geometry.triangles;
  const PosedVertices& posed = geometry.posed;
  const std::size_t local = triangles_per_chunk / static_cast<std::size_t>(lanes);
  for (int pass = 0; pass < (wide_atomics ? 1 : 2); ++pass) {
    const std::string options = "-DW=" + std::to_string(lanes) +
                                (wide_atomics ? "" : " -DNARROW_ATOMICS -DRASTER_PASS=" + std::to_string(pass));
    const auto kernel = [&](const char* name) { return Kernel(device, "rasterise", name, name, options); };
    const auto words = static_cast<std::uint32_t>(wide_atomics ? pixels : 2 * pixels);
    if (pass == 0) kernel("clear_visible").launch(words, 256, visible.words, words);
    kernel("rasterise_mesh")
        .launch(t.mesh_chunks * local, local, t.chunks, t.index_a, t.index_b, t.index_c, posed.points, camera,
                visible.words);
    kernel("rasterise_grass")
        .launch(t.grass_chunks * local, local, t.chunks, t.mesh_chunks, posed.points, camera, visible.words);
  }
  FragmentPlanes planes =
      allocate_planes(device, static_cast<std::size_t>(image.width), static_cast<std::size_t>(image.height), true);
  ResolvePass(device, {.grass_height = true}, wide_atomics)
      .run(visible, t, posed, {geometry.blades, 0, nullptr, nullptr, nullptr, &geometry.mesh_grass}, camera, planes);
  Frame frame;
  frame.width = image.width;
  frame.height = image.height;
  read_planes(planes, glm::dvec3(0), frame);
  return frame;
}

TEST(DrawWidths, AllGiveThePixelsOfWidthOneInBothLayouts) {
  for (const DeviceInfo& info : list_devices()) {
    Device device(std::to_string(info.index));
    Geometry geometry = posed_geometry(device, scattered_world());
    const Frame narrow = draw(device, geometry, 1, false);
    for (const int lanes : vector_widths)
      for (const bool wide_atomics : {false, true}) {
        if (wide_atomics && !info.atomic64) continue;
        const Frame frame = draw(device, geometry, lanes, wide_atomics);
        EXPECT_EQ(frame.depth, narrow.depth) << "W = " << lanes << " on " << info.name;
        EXPECT_EQ(frame.owner, narrow.owner) << "W = " << lanes << " on " << info.name;
        EXPECT_EQ(frame.normal, narrow.normal) << "W = " << lanes << " on " << info.name;
        EXPECT_EQ(frame.height_above_root, narrow.height_above_root) << "W = " << lanes << " on " << info.name;
      }
  }
}

TEST(DrawWidths, SeeWhatRaysSee) {
  Device device;
  Geometry geometry = posed_geometry(device, scattered_world());
  const Frame frame = draw(device, geometry, 16, false);
  const PosedGeometry posed = read_geometry(geometry, glm::dvec3(0));
  std::vector<glm::dvec3> vertices;
  for (std::size_t i = 0; i < posed.positions.size(); i += 3)
    vertices.emplace_back(posed.positions[i], posed.positions[i + 1], posed.positions[i + 2]);
  int different = 0, blades = 0, meshes = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto i = static_cast<std::size_t>(y * image.width + x);
      const reference::Hit hit = reference::trace_pixel(level_view(), vertices, posed.triangles, x, y);
      const std::uint32_t owner = hit.triangle == 0xffffffffu ? 0 : posed.owner[hit.triangle];
      meshes += owner == 1;
      blades += owner == 2;
      different += owner != frame.owner[i] || (owner != 0 && std::abs(hit.depth - frame.depth[i]) > 1e-3 * hit.depth);
    }
  EXPECT_GT(meshes, 100);
  EXPECT_GT(blades, 50);
  // Corners snap to 1/256 pixel: samples that close to an edge may fall on either side.
  EXPECT_LE(different, (meshes + blades) / 50);
}

}  // namespace
}  // namespace understory
