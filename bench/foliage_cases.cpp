// Blades and far pieces, posed alone and posed and drawn at once, where the answers are known in closed form: blades
// too stiff to follow the wind, and a triangle for every pixel.
#include <array>
#include <bit>
#include <memory>

#include "bench/kernel_cases.hpp"
#include "bench/posed_offset.hpp"
#include "host/passes/draw_blades.hpp"
#include "host/passes/draw_far.hpp"
#include "sim/prototype.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr std::uint64_t seed = 7;
constexpr double focal = 1024;

/// Level, from the origin along -z; of whole rows of the bench's image.
CameraView level_view(const FragmentPlanes& image) {
  CameraView camera{};
  camera.right[0] = 1;
  camera.down[1] = -1;
  camera.forward[2] = -1;
  camera.focal = static_cast<float>(focal);
  camera.width = static_cast<record_int>(image.row_length);
  camera.height = static_cast<record_int>(std::max<std::size_t>(image.fragments / image.row_length, 1));
  camera.centre_x = static_cast<float>(camera.width / 2);
  camera.centre_y = static_cast<float>(camera.height / 2);
  camera.near_plane = 0.1f;
  return camera;
}

VisibilityBuffer cleared_words(Device& device, const CameraView& camera) {
  const std::size_t words = 2 * static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  VisibilityBuffer visible{Buffer<std::uint32_t>(device, words, "visibility buffer")};
  visible.words.write(std::vector<std::uint32_t>(words, 0xffffffffu));
  return visible;
}

// Blades that look up the wind and are too stiff to follow it.

/// Flat ground full of upright blades.
struct Meadow {
  Meadow(Device& device, std::size_t count) : blades(count) {
    std::vector<float> root_x, root_y, length, facing_x, facing_y;
    for (std::size_t i = 0; i < count; ++i) {
      Random random(seed, stream_of("blade"), i);
      root_x.push_back(0.05f * static_cast<float>(i % 512));
      root_y.push_back(0.05f * static_cast<float>(i / 512 % 512));
      length.push_back(static_cast<float>(random.uniform(0.2, 0.5)));
      const double turn = random.uniform(0, 6.28);
      facing_x.push_back(static_cast<float>(std::cos(turn)));
      facing_y.push_back(static_cast<float>(std::sin(turn)));
    }
    const std::vector<float> none(count, 0), width(count, half_width), phase(count, 1);
    rest = {uploaded(device, root_x, "roots"),    uploaded(device, root_y, "roots"),
            uploaded(device, none, "roots"),      uploaded(device, length, "lengths"),
            uploaded(device, width, "widths"),    uploaded(device, none, "bend"),
            uploaded(device, none, "bend"),       uploaded(device, facing_x, "facing"),
            uploaded(device, facing_y, "facing"), uploaded(device, none, "flexibility"),
            uploaded(device, phase, "phase")};
    lengths = length;
    facing = {facing_x, facing_y};
    std::vector<std::array<float, 2>> pairs(1024, {0.1f, 0.05f});
    series = uploaded(device, pairs, "series");
    wind.direction_x = 1;
    wind.slowness = 0.2f;
    wind.series_rate = 8;
    wind.mean_bend = 0.3f;
    wind.flutter_amplitude = 0.1f;
    wind.lateral_scale = 5;
    wind.lateral_delay = 0.5f;
    wind.series_count = static_cast<record_uint>(pairs.size());
    posed.points = Buffer<std::array<float, 4>>(device, vertices_per_blade * count, "posed");
  }

  /// Vertex k of blade l of a group of 256 is 7 * 256 * group + 256 k + l.
  glm::dvec3 vertex(std::size_t i) const {
    constexpr double side[] = {-1, 1, -0.85, 0.85, -0.5, 0.5, 0}, share[] = {0, 0, 0.4, 0.4, 0.75, 0.75, 1};
    const std::size_t group = i / (vertices_per_blade * blades_per_group),
                      k = i / blades_per_group % vertices_per_blade;
    const std::size_t blade = group * blades_per_group + i % blades_per_group;
    const double away = side[k] * double(half_width);
    return {0.05 * double(blade % 512) + away * double(facing[0][blade]),
            0.05 * double(blade / 512 % 512) + away * double(facing[1][blade]), share[k] * double(lengths[blade])};
  }

  static constexpr float half_width = 0.004f;
  std::size_t blades;
  RestBlades rest;
  std::vector<float> lengths;
  std::array<std::vector<float>, 2> facing;
  GrassWind wind{};
  SwaySeries series;
  PosedVertices posed;
};

std::shared_ptr<Meadow> meadow_for(Device& device, const BenchFragments& all) {
  const std::size_t groups = std::max<std::size_t>(all.planes.fragments / 4 / blades_per_group, 1);
  return std::make_shared<Meadow>(device, groups * blades_per_group);
}

KernelCase pose_grass_case() {
  return {"pose-grass", 1e-4, [](Device& device, BenchFragments& all) {
            const auto meadow = meadow_for(device, all);
            const auto pass = std::make_shared<PoseGrassPass>(device);
            ReadyKernel ready;
            ready.run = [meadow, pass] {
              pass->run(meadow->rest, meadow->wind, meadow->series, 0, static_cast<std::uint32_t>(meadow->blades), 0,
                        meadow->posed);
            };
            ready.error = [meadow] {
              return largest_offset(meadow->posed, [&](std::size_t i) { return meadow->vertex(i); });
            };
            ready.items = static_cast<double>(meadow->blades);
            return ready;
          }};
}

// The meadow from its edge, 5 m before the first blades and 1 m high.

struct DrawnMeadow {
  DrawnMeadow(Device& device, const BenchFragments& all)
      : pass(device, device.info().atomic64),
        passes(device.info().atomic64 ? 1 : 2),
        meadow(meadow_for(device, all)),
        camera(northward(level_view(all.planes))),
        visible(cleared_words(device, camera)) {
    std::vector<TriangleChunk> chunks;
    std::vector<BladeUnit> units;
    for (std::uint32_t group = 0; group < meadow->blades / blades_per_group; ++group) {
      for (std::uint32_t unit = 0; unit < blades_per_group / blades_per_unit; ++unit)
        units.push_back({static_cast<record_uint>(chunks.size()) * triangles_per_chunk + unit * blades_per_unit, 1,
                         vertices_per_blade / 2, 0});
      for (std::uint32_t k = 0; k < triangles_per_blade; ++k)
        chunks.push_back(
            {(group * vertices_per_blade + k) * blades_per_group, group * blades_per_group, blades_per_group, 1});
    }
    triangles.chunks = uploaded(device, chunks, "chunks");
    triangles.grass_chunks = static_cast<std::uint32_t>(chunks.size());
    unit_table = uploaded(device, units, "units");
    meadow->wind.root_offset_x = static_cast<float>(-eye.x);
    meadow->wind.root_offset_y = static_cast<float>(-eye.y);
    meadow->wind.root_offset_z = static_cast<float>(-eye.z);
  }
  void run() {
    for (std::size_t raster_pass = 0; raster_pass < passes; ++raster_pass)
      pass.run(raster_pass, meadow->rest, meadow->wind, meadow->series, unit_table, 0,
               static_cast<std::uint32_t>(unit_table.size()), triangles, camera, meadow->posed, visible);
  }
  /// Of posed vertices, m; 1 where a pixel is not as far away as the blade that it sees.
  double error() const {
    const std::vector<std::uint32_t> words = visible.words.read();
    const bool wide = passes == 1;  // visibility_buffer.h
    constexpr std::size_t group_triangles = triangles_per_blade * blades_per_group;
    for (std::size_t pixel = 0; pixel < words.size() / 2; pixel += 97) {
      const std::size_t triangle = words[wide ? 2 * pixel : words.size() / 2 + pixel];
      if (triangle == 0xffffffffu) continue;
      const std::size_t blade = triangle / group_triangles * blades_per_group + triangle % blades_per_group;
      const double depth = double(std::bit_cast<float>(words[wide ? 2 * pixel + 1 : pixel]));
      const double expected =
          meadow->vertex(blade / blades_per_group * vertices_per_blade * blades_per_group + blade % blades_per_group)
              .y -
          eye.y;
      if (!(std::abs(depth - expected) < 3 * double(Meadow::half_width))) return 1;
    }
    return largest_offset(meadow->posed, [&](std::size_t i) { return meadow->vertex(i) - eye; });
  }
  static CameraView northward(CameraView camera) {
    camera.down[1] = camera.forward[2] = 0;
    camera.down[2] = -1;
    camera.forward[1] = 1;
    return camera;
  }
  static constexpr glm::dvec3 eye{12.8, -5, 1};
  DrawBladesPass pass;
  std::size_t passes;
  std::shared_ptr<Meadow> meadow;
  TriangleTables triangles;
  Buffer<BladeUnit> unit_table;
  CameraView camera;
  VisibilityBuffer visible;
};

KernelCase draw_blades_case() {
  return {"draw-blades", 1e-4, [](Device& device, BenchFragments& all) {
            const auto drawn = std::make_shared<DrawnMeadow>(device, all);
            return ReadyKernel{[drawn] { drawn->run(); }, [drawn] { return drawn->error(); },
                               static_cast<double>(drawn->meadow->blades)};
          }};
}

// A triangle about the centre of every pixel, 10 to 13 m away; every second one twice as large as at rest, which makes
// it cover no other centre.

struct Pieces {
  Pieces(Device& the_device, const BenchFragments& all)
      : device(&the_device),
        pass(the_device, the_device.info().atomic64),
        passes(the_device.info().atomic64 ? 1 : 2),
        camera(level_view(all.planes)),
        visible(cleared_words(the_device, camera)),
        count(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height) / 16) {
    std::vector<float> axes[3], scales;
    std::vector<PosedBlock> rows;
    std::vector<FarUnit> listed;
    for (std::size_t unit = 0; unit < count; ++unit) {
      const float scale = unit % 2 == 0 ? 1.0f : 2.0f;
      listed.push_back({static_cast<record_uint>(3 * unit), static_cast<record_uint>(16 * unit)});
      for (std::size_t k = 0; k < 3; ++k) {
        rows.push_back({static_cast<record_uint>(3 * unit + k), static_cast<record_uint>(unit % 64)});
        scales.push_back(scale);
        for (std::size_t l = 0; l < 16; ++l) {
          const glm::dvec3 p = corner(16 * unit + l, k, 0.25 / double(scale));
          for (int axis = 0; axis < 3; ++axis) axes[axis].push_back(static_cast<float>(p[axis]));
        }
      }
    }
    const std::vector<std::int8_t> none(axes[0].size(), 0);
    rest = {uploaded(the_device, axes[0], "rest"),
            uploaded(the_device, axes[1], "rest"),
            uploaded(the_device, axes[2], "rest"),
            uploaded(the_device, none, "flutter"),
            uploaded(the_device, none, "flutter"),
            uploaded(the_device, none, "flutter"),
            Buffer<std::uint8_t>(the_device, none.size(), "phase")};
    rest.flutter_phase.write(std::vector<std::uint8_t>(none.size(), 3));
    LimbPose limb{};
    for (int axis : {0, 5, 10}) limb.to_limb[axis] = limb.to_scene[axis] = 1;
    limbs = uploaded(the_device, std::vector<LimbPose>(64, limb), "limbs");
    blocks = uploaded(the_device, rows, "blocks");
    scale_table = uploaded(the_device, scales, "scales");
    units = uploaded(the_device, listed, "units");
    posed.points = Buffer<std::array<float, 4>>(the_device, axes[0].size(), "posed");
  }
  /// Corner k of the piece of a pixel, `size` pixels from its centre.
  glm::dvec3 corner(std::size_t pixel, std::size_t k, double size) const {
    constexpr double across[] = {-1, 1, 0}, down[] = {-1, -1, 2};
    const auto width = static_cast<std::size_t>(camera.width);
    const double x = double(pixel % width) + 0.5 + size * across[k], y = double(pixel / width) + 0.5 + size * down[k];
    return depth_of(pixel) *
           glm::dvec3((x - double(camera.centre_x)) / focal, (double(camera.centre_y) - y) / focal, -1);
  }
  static double depth_of(std::size_t pixel) { return 10 + double(pixel % 4); }
  void run() {
    for (std::size_t raster_pass = 0; raster_pass < passes; ++raster_pass)
      pass.run(raster_pass, rest, blocks, scale_table, limbs, units, units.size(), camera, posed, visible);
  }
  /// Largest error of depth; 1 where another piece is seen than the pixel's.
  double error() const {
    const std::vector<std::uint32_t> words = visible.words.read();
    const bool wide = device->info().atomic64;  // visibility_buffer.h
    double largest = 0;
    for (std::size_t pixel = 0; pixel < 16 * count; pixel += 97) {
      if (words[wide ? 2 * pixel : words.size() / 2 + pixel] != pixel) return 1;
      const double error =
          std::abs(double(std::bit_cast<float>(words[wide ? 2 * pixel + 1 : pixel])) - depth_of(pixel));
      largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
    }
    return largest;
  }
  Device* device;
  DrawFarPass pass;
  std::size_t passes;
  CameraView camera;
  VisibilityBuffer visible;
  std::size_t count;  // of units
  RestVertices rest;
  Buffer<LimbPose> limbs;
  Buffer<PosedBlock> blocks;
  Buffer<float> scale_table;
  Buffer<FarUnit> units;
  PosedVertices posed;
};

KernelCase draw_far_case() {
  return {"draw-far", 1e-4, [](Device& device, BenchFragments& all) {
            const auto pieces = std::make_shared<Pieces>(device, all);
            return ReadyKernel{[pieces] { pieces->run(); }, [pieces] { return pieces->error(); },
                               static_cast<double>(16 * pieces->count)};
          }};
}

}  // namespace

std::vector<KernelCase> foliage_cases() { return {pose_grass_case(), draw_blades_case(), draw_far_case()}; }

}  // namespace understory
