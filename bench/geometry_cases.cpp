// Posing, drawing and resolving on made-up geometry whose answers are known in closed form: straight limbs, and cards
// that face the camera, each hiding the three behind it.
#include <array>
#include <bit>
#include <cmath>
#include <memory>

#include "bench/kernel_cases.hpp"
#include "bench/posed_offset.hpp"
#include "host/passes/pose_mesh.hpp"
#include "host/passes/rasterise.hpp"
#include "host/passes/resolve.hpp"
#include "sim/prototype.hpp"

namespace understory {
namespace {

// Limbs of 64 blocks of vertices each, turned and moved, not bent.

glm::dvec3 rest_vertex(std::size_t i) {
  return {0.001 * double(i % 977), 0.002 * double(i % 491), 0.003 * double(i % 331)};
}

LimbPose straight_limb(std::size_t number) {
  LimbPose limb{};
  limb.to_limb[0] = limb.to_limb[5] = limb.to_limb[10] = 1;
  const double turn = 0.1 * double(number);
  limb.to_scene[0] = limb.to_scene[5] = static_cast<float>(std::cos(turn));
  limb.to_scene[1] = -static_cast<float>(std::sin(turn));
  limb.to_scene[4] = static_cast<float>(std::sin(turn));
  limb.to_scene[10] = 1;
  limb.to_scene[3] = static_cast<float>(number % 32);
  return limb;
}

glm::dvec3 on_limb(const LimbPose& limb, glm::dvec3 p) {
  const auto row = [&](int r) {
    const float* m = limb.to_scene + 4 * r;
    return double(m[0]) * p.x + double(m[1]) * p.y + double(m[2]) * p.z + double(m[3]);
  };
  return {row(0), row(1), row(2)};
}

struct MeshToPose {
  MeshToPose(Device& device, std::size_t vertices) : pass(device) {
    const std::size_t count = vertices / vertex_block;
    std::vector<float> axes[3];
    std::vector<PosedBlock> rows;
    for (std::size_t i = 0; i < vertices; ++i)
      for (int axis = 0; axis < 3; ++axis) axes[axis].push_back(static_cast<float>(rest_vertex(i)[axis]));
    for (std::size_t i = 0; i < count; ++i)
      rows.push_back({static_cast<record_uint>(i), static_cast<record_uint>(i / 64)});
    for (std::size_t i = 0; i <= count / 64; ++i) limbs.push_back(straight_limb(i));
    const std::vector<std::int8_t> flutter(vertices, 50);
    rest = {uploaded(device, axes[0], "rest"),
            uploaded(device, axes[1], "rest"),
            uploaded(device, axes[2], "rest"),
            uploaded(device, flutter, "flutter"),
            uploaded(device, flutter, "flutter"),
            uploaded(device, flutter, "flutter"),
            Buffer<std::uint8_t>(device, vertices, "phase")};
    rest.flutter_phase.write(std::vector<std::uint8_t>(vertices, 3));
    blocks = uploaded(device, rows, "blocks");
    limb_table = uploaded(device, limbs, "limbs");
    posed.points = Buffer<std::array<float, 4>>(device, vertices, "posed");
  }
  PoseMeshPass pass;
  RestVertices rest;
  Buffer<PosedBlock> blocks;
  std::vector<LimbPose> limbs;
  Buffer<LimbPose> limb_table;
  PosedVertices posed;
};

KernelCase pose_mesh_case() {
  return {"pose-mesh", 1e-4, [](Device& device, BenchFragments& all) {
            const std::size_t vertices = all.planes.padded_fragments;
            const auto mesh = std::make_shared<MeshToPose>(device, vertices);
            ReadyKernel ready;
            ready.run = [mesh] { mesh->pass.run(mesh->rest, mesh->blocks, mesh->limb_table, mesh->posed); };
            ready.error = [mesh] {
              return largest_offset(mesh->posed, [&](std::size_t i) {
                return on_limb(mesh->limbs[i / vertex_block / 64], rest_vertex(i));
              });
            };
            ready.items = static_cast<double>(vertices);
            return ready;
          }};
}

// Four layers of cards over the whole image, 10, 12, 14 and 16 m away in an order that differs from card to card. Cards
// of a mesh are two triangles of 4 x 4 pixels, those of grass a strip of five as wide and four times as high.

constexpr std::size_t layers = 4, card = 4;
constexpr double nearest_depth = 10, focal = 1024;

struct Cards {
  Cards(Device& device, const FragmentPlanes& image, bool grass);
  /// Largest error of depth over the pixels that cards fill; 1 where another card is seen than the nearest.
  double drawing_error() const;
  double resolving_error() const;
  void draw() { drawing.run(triangles, posed, camera, visible); }
  void see() { resolving.run(visible, triangles, posed, RestGeometry{blades, 0}, camera, planes); }

  Device* device;
  bool is_grass;
  std::size_t columns, rows, card_height;  // cards of one layer
  CameraView camera{};
  TriangleTables triangles;
  PosedVertices posed;
  RestBlades blades;
  RasterisePass drawing;
  VisibilityBuffer visible;
  ResolvePass resolving;
  FragmentPlanes planes;

 private:
  std::size_t cards() const { return layers * columns * rows; }
  /// Which layer is nearest, of the cards of one place.
  static std::size_t nearest_layer(std::size_t place) { return place * 2654435761u >> 7 & 3; }
  /// The place in the image that a card covers, and how far away it is. Grass comes in groups of whole cards.
  glm::dvec3 corner(std::size_t number, double x, double y) const {
    const std::size_t place = number / layers, layer = number % layers;
    const double depth = nearest_depth + 2 * double((layer + layers - nearest_layer(place)) % layers);
    const double px = double(card) * (double(place % columns) + x),
                 py = double(card_height) * (double(place / columns) + y);
    return depth * glm::dvec3((px - double(camera.centre_x)) / focal, (double(camera.centre_y) - py) / focal, -1);
  }
  void lay_out_mesh();
  void lay_out_grass();
};

Cards::Cards(Device& the_device, const FragmentPlanes& image, bool grass)
    : device(&the_device),
      is_grass(grass),
      columns(image.row_length / card),
      rows(0),
      card_height(grass ? 4 * card : card),
      drawing(the_device, !grass, grass, the_device.info().atomic64),
      resolving(the_device, {}, the_device.info().atomic64) {
  const std::size_t height = std::max<std::size_t>(image.fragments / image.row_length, card_height);
  rows = height / card_height;
  camera.right[0] = 1;
  camera.down[1] = -1;
  camera.forward[2] = -1;
  camera.focal = static_cast<float>(focal);
  camera.centre_x = static_cast<float>(image.row_length / 2);
  camera.centre_y = static_cast<float>(height / 2);
  camera.near_plane = 0.1f;
  camera.width = static_cast<record_int>(image.row_length);
  camera.height = static_cast<record_int>(height);
  if (grass)
    lay_out_grass();
  else
    lay_out_mesh();
  const std::size_t pixels = image.row_length * height;
  visible.words = Buffer<std::uint32_t>(the_device, 2 * pixels, "visibility buffer");
  planes = allocate_planes(the_device, image.row_length, height, false);
}

void Cards::lay_out_mesh() {
  const std::size_t count = (2 * cards() + triangles_per_chunk - 1) / triangles_per_chunk;
  std::vector<std::array<float, 4>> points;
  std::vector<std::uint32_t> index[3];
  std::vector<TriangleChunk> chunks;
  for (std::size_t number = 0; number < cards(); ++number) {
    for (const auto& [x, y] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}}) {
      const glm::vec3 p(corner(number, x, y));
      points.push_back({p.x, p.y, p.z, 0});
    }
    const auto first = static_cast<std::uint32_t>(4 * number);
    for (const std::array<std::uint32_t, 3>& triangle : {std::array{0u, 1u, 2u}, std::array{0u, 2u, 3u}})
      for (std::size_t k = 0; k < 3; ++k) index[k].push_back(first + triangle[k]);
  }
  for (auto& plane : index) plane.resize(count * triangles_per_chunk, 0);  // no area
  for (std::size_t i = 0; i < count; ++i)
    chunks.push_back({0, static_cast<record_uint>(i * triangles_per_chunk), triangles_per_chunk, 1});
  posed.points = uploaded(*device, points, "cards");
  triangles.index_a = uploaded(*device, index[0], "corners");
  triangles.index_b = uploaded(*device, index[1], "corners");
  triangles.index_c = uploaded(*device, index[2], "corners");
  triangles.chunks = uploaded(*device, chunks, "chunks");
  triangles.mesh_chunks = static_cast<std::uint32_t>(count);
}

void Cards::lay_out_grass() {
  const std::size_t groups = (cards() + blades_per_group - 1) / blades_per_group;
  std::vector<std::array<float, 4>> points(groups * blades_per_group * vertices_per_blade, {0, 0, 0, 0});
  constexpr double x[] = {0, 1, 0, 1, 0, 1, 0.5}, y[] = {1, 1, 0.75, 0.75, 0.5, 0.5, 0};
  for (std::size_t number = 0; number < cards(); ++number)
    for (std::size_t k = 0; k < vertices_per_blade; ++k) {
      const glm::vec3 p(corner(number, x[k], y[k]));
      const std::size_t group = number / blades_per_group;
      points[(group * vertices_per_blade + k) * blades_per_group + number % blades_per_group] = {p.x, p.y, p.z, 0};
    }
  std::vector<TriangleChunk> chunks;
  for (std::size_t group = 0; group < groups; ++group)
    for (std::size_t k = 0; k < triangles_per_blade; ++k)
      chunks.push_back({static_cast<record_uint>((group * vertices_per_blade + k) * blades_per_group),
                        static_cast<record_uint>(group * blades_per_group), blades_per_group, 1});
  posed.points = uploaded(*device, points, "blades");
  triangles.chunks = uploaded(*device, chunks, "chunks");
  triangles.grass_chunks = static_cast<std::uint32_t>(chunks.size());
}

double Cards::drawing_error() const {
  const std::vector<std::uint32_t> words = visible.words.read();
  const std::size_t pixels = words.size() / 2, width = static_cast<std::size_t>(camera.width);
  const bool wide = device->info().atomic64;  // visibility_buffer.h
  double largest = 0;
  for (std::size_t pixel = 0; pixel < pixels; pixel += 97) {
    const std::size_t px = pixel % width, py = pixel / width;
    if (py / card_height >= rows || 2 * (py % card_height) < card_height) continue;  // tips of blades leave gaps
    const double depth = double(std::bit_cast<float>(words[wide ? 2 * pixel + 1 : pixel]));
    const std::size_t triangle = words[wide ? 2 * pixel : pixels + pixel];
    // Five chunks of grass hold 256 blades, one of a mesh 128 cards.
    const std::size_t number =
        is_grass ? triangle / (triangles_per_blade * blades_per_group) * blades_per_group + triangle % blades_per_group
                 : triangle / 2;
    const std::size_t place = py / card_height * columns + px / card;
    if (number != place * layers + nearest_layer(place)) return 1;
    const double error = std::abs(depth - nearest_depth);
    largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
  }
  return largest;
}

double Cards::resolving_error() const {
  const std::vector<float> z = planes.position_z.read(), nz = planes.normal_z.read(), x = planes.position_x.read();
  const std::vector<std::uint32_t> owner = planes.owner.read();
  const std::size_t width = static_cast<std::size_t>(camera.width);
  double largest = 0;
  for (std::size_t i = 0; i < rows * card_height * width; i += 97) {
    const double expected_x = (double(i % width) + 0.5 - double(camera.centre_x)) / focal * nearest_depth;
    const double error = std::max({std::abs(double(z[i]) + nearest_depth), std::abs(double(nz[i]) - 1),
                                   std::abs(double(x[i]) - expected_x), owner[i] == 1 ? 0.0 : 1.0});
    largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
  }
  return largest;
}

KernelCase rasterise_case(bool grass) {
  return {grass ? "rasterise-grass" : "rasterise-mesh", 1e-4, [grass](Device& device, BenchFragments& all) {
            const auto cards = std::make_shared<Cards>(device, all.planes, grass);
            const std::uint32_t chunks = cards->triangles.chunk_count();
            return ReadyKernel{[cards] { cards->draw(); }, [cards] { return cards->drawing_error(); },
                               double(chunks) * triangles_per_chunk};
          }};
}

KernelCase resolve_case() {
  return {"resolve", 1e-4, [](Device& device, BenchFragments& all) {
            const auto cards = std::make_shared<Cards>(device, all.planes, false);
            cards->draw();
            return ReadyKernel{[cards] { cards->see(); }, [cards] { return cards->resolving_error(); },
                               static_cast<double>(cards->planes.padded_fragments)};
          }};
}

}  // namespace

std::vector<KernelCase> geometry_cases() {
  return {pose_mesh_case(), rasterise_case(false), rasterise_case(true), resolve_case()};
}

}  // namespace understory
