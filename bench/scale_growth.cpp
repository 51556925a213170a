#include "bench/scale_growth.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include "bench/timing.hpp"
#include "host/frame/runner.hpp"
#include "sim/world.hpp"

namespace understory {
namespace {

constexpr int trees_a_side = 16;  // of the largest wood
constexpr double spacing = 12;    // m
constexpr int leaves = 48'000;    // about 125,000 triangles with the wood
constexpr double million = 1e6, mib = 1024.0 * 1024.0;
constexpr int least_frames = 7, most_frames = 25;  // of each size, timed
constexpr double enough_ms = 600;                  // and no more frames than take so long

/// Trees stand on a grid, in the largest wood also amid every four; smaller ones are its trees of every k-th place, so
/// that all sizes fill the view alike.
Scene wood(int trees) {
  Scene scene;
  scene.name = "wood";
  scene.detail = "culled";
  scene.image = {800, 500};
  const double edge = trees_a_side * spacing;
  scene.camera.position = {0, -1.5 * edge, 0.9 * edge};
  scene.camera.target = {0, 0, 0};
  scene.camera.vertical_fov = 0.75;
  scene.terrain.extent = {{-edge, -edge}, {edge, edge}};
  SpeciesSource birch;
  birch.name = "birch";
  birch.generator = "birch";
  birch.leaves = leaves;
  scene.species = {birch};
  PlantPlacement placement;
  placement.species = "birch";
  const int places = trees_a_side * trees_a_side;
  for (int k = 0; k < trees; ++k) {
    const int place = static_cast<int>(static_cast<long>(k) * places / trees);
    const double shift = trees > places && k % 2 == 1 ? 0.5 : 0;
    placement.spots.push_back({{(place % trees_a_side + shift - 0.5 * (trees_a_side - 1)) * spacing,
                                (place / trees_a_side + shift - 0.5 * (trees_a_side - 1)) * spacing},
                               0.1 * place,
                               1});
  }
  scene.plants = {placement};
  return scene;
}

double resident_mib() {
  std::ifstream statm("/proc/self/statm");
  double whole = 0, resident = 0;
  statm >> whole >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / mib;
}

GrowthPoint measure(const Scene& scene) {
  GrowthPoint point;
  const double before = resident_mib();
  const World world = build_world(scene);
  point.world_mib = resident_mib() - before;
  Device device;
  FrameRunner runner(device, world);
  Frame frame;
  runner.render(frame, 0, 0);
  std::vector<double> ms;
  double all_ms = 0;
  for (int k = 1; k <= least_frames || (k <= most_frames && all_ms < enough_ms); ++k) {
    ms.push_back(wall_milliseconds(device, [&] { runner.render(frame, k, 0.1 * k); }));
    all_ms += ms.back();
  }
  point.ms = spread_of(ms).median;
  point.size = static_cast<double>(runner.drawn_triangles()) / million;
  point.instances = static_cast<double>(world.instances.size());
  point.device_mib = static_cast<double>(device.peak_buffer_bytes()) / mib;
  return point;
}

}  // namespace

LinearFit fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0, xy = 0;
  LinearFit fit;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    if (i > 0) fit.worst_growth = std::max(fit.worst_growth, y[i] / y[i - 1] / (x[i] / x[i - 1]));
  }
  fit.slope = xy / xx;
  fit.first = mean_y - fit.slope * mean_x;
  return fit;
}

std::vector<GrowthPoint> measure_triangle_growth(int most_million) {
  std::vector<GrowthPoint> points;
  for (int size = 1; size <= most_million; size *= 2) points.push_back(measure(wood(8 * size)));
  return points;
}

std::vector<GrowthPoint> measure_pixel_growth(double most) {
  std::vector<GrowthPoint> points;
  for (double size = 0.25; size <= most; size *= 2) {
    Scene scene = wood(8);
    scene.image.height = static_cast<int>(std::lround(std::sqrt(size * million / 1.6)));
    scene.image.width = static_cast<int>(std::lround(size * million / scene.image.height));
    points.push_back(measure(scene));
    points.back().size = double(scene.image.width) * scene.image.height / million;
  }
  return points;
}

}  // namespace understory
