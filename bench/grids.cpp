#include "bench/grids.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>

#include "bench/timing.hpp"
#include "host/frame/runner.hpp"
#include "host/trace/grid_bake.hpp"
#include "sim/plants/species.hpp"
#include "sim/pose.hpp"

namespace understory {
namespace {

constexpr int repetitions = 15;
constexpr double body_size = 0.5;  // m, before the number of bodies scales it

/// A ball of about `triangles` triangles with bumps, so that no two are alike.
RawMesh::Part bumpy_ball(std::size_t triangles, double diameter) {
  const auto rings =
      static_cast<std::uint32_t>(std::max(3.0, std::round(std::sqrt(static_cast<double>(triangles) / 4))));
  const std::uint32_t turns = 2 * rings;
  RawMesh::Part part;
  part.name = "ball";
  part.surface = SurfaceClass::occluder;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < turns; ++j) {
      const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / turns;
      const double radius = 0.5 * diameter * (1 + 0.05 * std::sin(7 * polar) * std::cos(5 * turn));
      part.positions.emplace_back(radius * std::sin(polar) * std::cos(turn), radius * std::sin(polar) * std::sin(turn),
                                  radius * std::cos(polar));
    }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < turns; ++j) {
      const std::uint32_t a = i * turns + j, b = i * turns + (j + 1) % turns;
      for (const std::uint32_t index : {a, a + turns, b, b, a + turns, b + turns}) part.triangles.push_back(index);
    }
  return part;
}

/// Level ground of 2 cells^2 triangles.
RawMesh::Part ground(std::uint32_t cells, double size) {
  RawMesh::Part part;
  part.name = "ground";
  part.surface = SurfaceClass::terrain;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x)
      part.positions.emplace_back(size * (double(x) / cells - 0.5), size * (double(y) / cells - 0.5), 0);
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, b = a + cells + 1;
      for (const std::uint32_t index : {a, a + 1, b, b, a + 1, b + 1}) part.triangles.push_back(index);
    }
  return part;
}

/// The same shape with every triangle cut into n^2.
RawMesh::Part subdivided(const RawMesh::Part& coarse, std::uint32_t n) {
  RawMesh::Part fine;
  fine.name = coarse.name;
  fine.surface = coarse.surface;
  for (std::size_t t = 0; t < coarse.triangles.size(); t += 3) {
    const auto corner = [&](std::size_t i) { return glm::dvec3(coarse.positions[coarse.triangles[t + i]]); };
    const glm::dvec3 along = (corner(1) - corner(0)) / double(n), across = (corner(2) - corner(0)) / double(n);
    for (std::uint32_t i = 0; i <= n; ++i) {
      const auto row = static_cast<std::uint32_t>(fine.positions.size()), above = row + n + 1 - i;
      for (std::uint32_t j = 0; j <= n - i; ++j)
        fine.positions.emplace_back(corner(0) + double(j) * along + double(i) * across);
      for (std::uint32_t j = 0; j + i < n; ++j) {
        fine.triangles.insert(fine.triangles.end(), {row + j, row + j + 1, above + j});
        if (j + i + 1 < n) fine.triangles.insert(fine.triangles.end(), {row + j + 1, above + j + 1, above + j});
      }
    }
  }
  return fine;
}

struct Layout {
  int columns = 8, rows = 5;        // bodies
  std::uint32_t cuts = 1;           // each of a body's 400 triangles is cut into cuts^2
  std::uint32_t ground_cells = 70;  // along a side
  int bodies() const { return columns * rows; }
};

/// Bodies on a square lattice, so near that four grids and more hold each point, or a single one whose grid does, seen
/// from above: 800 x 600 pixels.
struct Lattice {
  World world;
  double grid_half = 0;  // m: half an edge of a body's grid
};

double grid_half_of(double size, double epsilon) {
  return grid_extent({glm::dvec3(-size / 2), glm::dvec3(size / 2)}, epsilon).high.x;
}

Lattice make_lattice(const Layout& layout, const Methods& methods) {
  Lattice lattice;
  lattice.grid_half = grid_half_of(body_size, methods.grid.epsilon);
  const double spacing = 0.9 * lattice.grid_half;
  // No wider than what four grids hold in either direction.
  const double width = layout.bodies() == 1 ? 1.6 * lattice.grid_half
                                            : spacing * std::min(layout.columns - 3.0, (layout.rows - 1.5) / 0.75);
  const double height = width * 0.75;
  Scene scene;
  scene.name = "lattice";
  scene.image = {800, 600};
  scene.camera.vertical_fov = 0.6;
  scene.camera.position = {0, 0, 0.5 * height / std::tan(0.3)};
  scene.camera.target = {0, 0, 0};
  scene.methods = methods;
  OccluderSource source;
  OccluderPart ball;
  ball.shape = OccluderPart::Shape::ellipsoid;
  ball.size = glm::dvec3(body_size);
  source.parts.push_back(ball);
  for (int row = 0; row < layout.rows; ++row)
    for (int column = 0; column < layout.columns; ++column) {
      source.name = "ball " + std::to_string(row * layout.columns + column);
      const glm::dvec3 at(spacing * (column - 0.5 * (layout.columns - 1)), spacing * (row - 0.5 * (layout.rows - 1)),
                          0.6 * body_size);
      // All of them move.
      source.keyframes = {{0, at, {0, 0, 0}}, {1, at + glm::dvec3(0.02 * spacing, 0, 0), {0, 0, 0.3}}};
      scene.occluders.push_back(source);
    }
  lattice.world = build_world(scene);
  RawMesh bumpy, plane;
  bumpy.parts.push_back(subdivided(bumpy_ball(400, body_size), layout.cuts));
  plane.parts.push_back(ground(layout.ground_cells, 4 * width));
  const Prototype body = rigid_prototype("ball", bumpy), floor = rigid_prototype("ground", plane);
  // One prototype for all: the same triangles are uploaded and posed for each body all the same.
  for (const Instance& instance : lattice.world.instances)
    lattice.world.prototypes[instance.prototype] = instance.role == Instance::Role::terrain ? floor : body;
  return lattice;
}

/// Fewest grids that hold a covered fragment.
int fewest_grids(const Lattice& lattice, const Frame& frame) {
  const Pose pose = pose_at(lattice.world, frame.time, glm::dvec3(0));
  std::vector<glm::dmat4> to_body;
  for (std::size_t i = 0; i < lattice.world.instances.size(); ++i) {
    if (lattice.world.instances[i].role != Instance::Role::occluder) continue;
    const float* m = pose.limbs[pose.first_limb[i]].to_scene;  // a stiff part: its own to_limb is the identity
    glm::dmat4 to_scene(1);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) to_scene[column][row] = double(m[4 * row + column]);
    to_body.push_back(glm::inverse(to_scene));
  }
  int fewest = 1 << 30;
  for (std::size_t i = 0; i < frame.pixels(); i += 37) {
    if (frame.validity[i] & validity::background) continue;
    const glm::dvec4 p(frame.position[0][i], frame.position[1][i], frame.position[2][i], 1);
    fewest = std::min(fewest, static_cast<int>(std::count_if(to_body.begin(), to_body.end(), [&](const glm::dmat4& m) {
                        const glm::dvec3 q = glm::abs(glm::dvec3(m * p));
                        return std::max({q.x, q.y, q.z}) <= lattice.grid_half;
                      })));
  }
  return fewest;
}

/// One row of the table: a lattice that is rendered again and again.
struct Timed {
  std::string name;
  Layout layout;
  Methods methods;
};

/// The rows in turn, frame by frame, so that drift of the machine meets all alike: their ratios are what matters.
void bench_lattices(Device& device, const std::vector<Timed>& rows, BenchReport& report) {
  struct Running {
    Lattice lattice;
    std::unique_ptr<FrameRunner> runner;
    std::vector<double> samples;
    Frame frame;
  };
  std::vector<std::unique_ptr<Running>> all;
  for (const Timed& row : rows) {
    all.push_back(std::make_unique<Running>());
    all.back()->lattice = make_lattice(row.layout, row.methods);
    all.back()->runner = std::make_unique<FrameRunner>(device, all.back()->lattice.world);
    all.back()->runner->render(0, 0.1);
  }
  for (int i = 0; i < repetitions; ++i)
    for (std::size_t k = 0; k < rows.size(); ++k) {
      Running& running = *all[i % 2 == 0 ? k : rows.size() - 1 - k];
      running.frame = running.runner->render(i, 0.1 + 0.05 * i);
      running.samples.push_back(running.frame.pass_ms.at(running.lattice.world.scene.methods.occluders));
    }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Running& running = *all[k];
    const std::vector<float>& v = running.frame.visibility;
    const bool sound = std::all_of(v.begin(), v.end(), [](float share) { return share >= 0 && share <= 1; });
    const int least = rows[k].layout.bodies() == 1 ? 1 : 4;
    BenchResult result;
    result.name = rows[k].name;
    result.verified = sound && fewest_grids(running.lattice, running.frame) >= least;
    const Spread95 spread = spread_of(running.samples);
    result.median_ms = spread.median;
    result.low_ms = *std::min_element(running.samples.begin(), running.samples.end());
    result.high_ms = spread.high;
    result.items_per_s = static_cast<double>(v.size()) / (spread.median * 1e-3);
    report.results.push_back(result);
  }
}

void bench_bake(const std::string& name, std::size_t triangles, BenchReport& report) {
  const RawMesh::Part ball = bumpy_ball(triangles, 1);
  GridSettings settings;
  std::vector<double> samples;
  bool sound = true;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const OcclusionGrid grid = bake_grid(ball.positions, ball.triangles, settings);
    samples.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    // From a ball's cone at the middle of the lower left quarter of the box.
    const glm::dvec3 at = 0.5 * glm::dvec3(grid.low);
    const double distance = glm::length(at);
    const double share = (1 - std::sqrt(1 - 0.25 / (distance * distance))) / 2;
    sound = sound && std::abs(double(occluded_at(grid, at).share) - share) < 0.02;
  }
  const Spread95 spread = spread_of(samples);
  BenchResult result;
  result.name = name;
  result.verified = sound;
  result.median_ms = result.wall_ms = spread.median;
  result.low_ms = spread.low;
  result.high_ms = spread.high;
  result.items_per_s = 32.0 * 32 * 32 * settings.rays / (spread.median * 1e-3);  // rays
  report.results.push_back(result);
}

}  // namespace

void bench_grids(Device& device, const BenchOptions& options, BenchReport& report) {
  const auto wanted = [&](const std::string& name) {
    if (name.find(options.filter) == std::string::npos) return false;
    if (options.progress) options.progress(name);
    return true;
  };
  const auto bench_wanted = [&](const std::vector<Timed>& rows) {
    std::vector<Timed> some;
    for (const Timed& row : rows)
      if (wanted(row.name)) some.push_back(row);
    if (!some.empty()) bench_lattices(device, some, report);
  };
  Methods scalar, multiply, merge, all_once;
  scalar.occluders = "grid";
  multiply.occluders = merge.occluders = all_once.occluders = "grid-cone";
  multiply.combine = "multiply";
  merge.combine = "merge";
  all_once.combine = "union";
  for (const Layout& layout : {Layout{8, 5}, Layout{40, 25}}) {
    const std::string name = "grid/occluders-" + std::to_string(layout.bodies()) + "/";
    bench_wanted({{name + "grid", layout, scalar},
                  {name + "grid-cone-multiply", layout, multiply},
                  {name + "grid-cone-merge", layout, merge},
                  {name + "grid-cone-union", layout, all_once}});
  }
  // Flat: the same picture of more triangles.
  bench_wanted(
      {{"grid/one-occluder-400-triangles", {1, 1}, merge}, {"grid/one-occluder-1000000-triangles", {1, 1, 50}, merge}});
  bench_wanted({{"grid/40-occluders-400-triangles-each", {8, 5}, merge},
                {"grid/40-occluders-25600-triangles-each", {8, 5, 8}, merge}});
  bench_wanted({{"grid/scene-triangles-9800", {8, 5}, merge}, {"grid/scene-triangles-980000", {8, 5, 1, 700}, merge}});
  for (const std::size_t triangles : {400u, 1'100'000u})
    if (const std::string name = "grid/bake-" + std::to_string(triangles); wanted(name))
      bench_bake(name, triangles, report);
}

}  // namespace understory
