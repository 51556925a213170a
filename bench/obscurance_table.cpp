// obscurance_table > bench/obscurance.md: error and cost of every way to sample obscurance, on the meadow and on real
// plants, beside VTK's screen-space occlusion and traced truth. From the repository's root, UNDERSTORY_DATA set.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "bench/error_statistics.hpp"
#include "bench/obscurance_gbuffer.hpp"
#include "bench/obscurance_scene.hpp"
#include "host/trace/frame_truth.hpp"
#include "host/trace/truth.hpp"
#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"
#include "viz/vtk/screen_space_occlusion.hpp"

namespace understory {
namespace {

constexpr int truth_step = 16;  // every sixteenth pixel in both directions is traced
constexpr int repetitions = 9;

struct Settings {
  int size = 1024;
  int rays = 256;
};

Plane picked(const Plane& plane, const std::vector<std::size_t>& pixels) {
  Plane values;
  for (const std::size_t i : pixels) values.push_back(plane[i]);
  return values;
}

double rmse(const Plane& a, const Plane& b) { return error_statistics(a, b, {}, {}).rmse; }

/// V of these pixels, traced up to `reach` metres; all the way under the dome when it is infinite.
Plane traced(const Tracer& tracer, const Frame& frame, const std::vector<std::size_t>& pixels, float reach, int rays) {
  std::vector<glm::vec3> positions, normals;
  for (const std::size_t i : pixels) {
    positions.push_back({frame.position[0][i], frame.position[1][i], frame.position[2][i]});
    normals.push_back({frame.normal[0][i], frame.normal[1][i], frame.normal[2][i]});
  }
  TruthOptions options;
  options.rays = rays;
  options.max_distance = reach;
  options.eye = glm::vec3(glm::dvec3(glm::inverse(frame.world_to_camera)[3]));
  return trace_truth(tracer, positions, normals, options).visibility;
}

void print_ways(ObscuranceScene& scene, const Plane& near_truth, const Plane& truth,
                const std::vector<std::size_t>& pixels, const NearField& options) {
  const std::vector<std::size_t> all = scene.drawn_pixels(1);
  const Plane converged = scene.shade_points(many_points(2048), options), exact = picked(converged, all);
  fmt::print(
      "Converged (2048 points): RMSE {:.4f} against traced obscurance, {:.4f} against traced visibility; the two "
      "traced differ by {:.4f}.\n\n",
      rmse(picked(converged, pixels), near_truth), rmse(picked(converged, pixels), truth), rmse(near_truth, truth));
  fmt::print(
      "| way | RMSE against converged | against traced obscurance | against traced visibility | ms |\n"
      "|---|---|---|---|---|\n");
  const std::vector<ObscuranceWay> ways = obscurance_ways();
  const std::vector<double> cost = scene.cost(ways, options, repetitions);
  const auto print = [&](const std::string& name, const Plane& plane, double ms) {
    fmt::print("| {} | {:.4f} | {:.4f} | {:.4f} | {:.1f} |\n", name, rmse(picked(plane, all), exact),
               rmse(picked(plane, pixels), near_truth), rmse(picked(plane, pixels), truth), ms);
  };
  for (std::size_t i = 0; i < ways.size(); ++i) print(ways[i].name(), scene.shade(ways[i], options), cost[i]);
  const Plane blurred = scene.blurred(scene.shade(ways.front(), options), options);
  print("lines 5, blur 4", blurred, cost.front() + cost.back());
  const auto of = [&](ObscuranceWay::Kind kind, int samples) {
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (ways[i].kind == kind && ways[i].samples == samples) return cost[i];
    return 0.0;
  };
  using Kind = ObscuranceWay::Kind;
  fmt::print(
      "\nCost lines 5 : points 12 = {:.2f} (bar 0.65), lines 9 : points 33 = {:.2f} (bar 0.45); blur {:.1f} ms.\n",
      of(Kind::lines, 5) / of(Kind::points, 12), of(Kind::lines, 9) / of(Kind::points, 33), cost.back());
}

/// Lines, blurred, against the same truth.
struct Tuned {
  const char* falloff;
  double share;      // radius over the length of the rays
  double thickness;  // radii
  int lines;
};

/// What chose the defaults (thickness), and the preset that is judged beside VTK's pass: the last.
std::vector<Tuned> tuned_settings() {
  std::vector<Tuned> all;
  for (const double thickness : {0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0, 0.0})
    all.push_back({"cosine", 1, thickness, 5});
  for (const double share : {0.6, 0.8}) all.push_back({"cosine", share, 5, 5});
  all.push_back({"cosine", 0.6, 5, 12});
  all.push_back({"quadratic", 0.6, 6, 12});
  for (const double thickness : {0.0, 4.0, 5.0, 6.0}) all.push_back({"constant", 0.6, thickness, 12});
  return all;
}

struct TunedResult {
  double rmse, ms;
};

TunedResult print_tuned(ObscuranceScene& scene, const Plane& near_truth, const std::vector<std::size_t>& pixels,
                        double reach) {
  fmt::print(
      "| lines, blur 4 | falloff | radius, m | thickness, radii | RMSE against traced obscurance | bias | ms |\n"
      "|---|---|---|---|---|---|---|\n");
  TunedResult last{};
  for (const Tuned& tuned : tuned_settings()) {
    NearField options;
    options.falloff = tuned.falloff;
    options.radius = tuned.share * reach;
    options.thickness = tuned.thickness * options.radius;
    const ObscuranceWay way{ObscuranceWay::Kind::lines, tuned.lines, 1};
    const std::vector<double> cost = scene.cost({way}, options, 3);
    const Plane plane = scene.blurred(scene.shade(way, options), options);
    const ErrorStatistics errors = error_statistics(picked(plane, pixels), near_truth, {}, {});
    last = {errors.rmse, cost[0] + cost[1]};
    fmt::print("| {} | {} | {:.2f} | {} | {:.4f} | {:+.4f} | {:.1f} |\n", tuned.lines, tuned.falloff, options.radius,
               tuned.thickness > 0 ? fmt::format("{}", tuned.thickness) : "endless", errors.rmse, errors.bias, last.ms);
  }
  fmt::print("\n");
  return last;
}

/// What chose the thickness that rays take of surfaces, and the number of rays.
void print_rays(ObscuranceScene& scene, const Plane& near_truth, const std::vector<std::size_t>& pixels, double reach) {
  fmt::print("| rays | length, m | thickness, m | RMSE against traced obscurance | bias | blurred | bias | ms |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  const auto print = [&](int rays, double thickness) {
    NearField options;
    options.radius = reach;
    options.thickness = thickness;
    const ObscuranceWay way{ObscuranceWay::Kind::rays, rays, 1};
    const Plane plane = scene.shade(way, options);
    const ErrorStatistics plain = error_statistics(picked(plane, pixels), near_truth, {}, {}),
                          blurred = error_statistics(picked(scene.blurred(plane, options), pixels), near_truth, {}, {});
    fmt::print("| {} | {:.2f} | {} | {:.4f} | {:+.4f} | {:.4f} | {:+.4f} | {:.1f} |\n", rays, reach, thickness,
               plain.rmse, plain.bias, blurred.rmse, blurred.bias, scene.cost({way}, options, 3).front());
  };
  const double usual = std::min(0.05, 0.1 * reach);  // as frames have it
  for (const int rays : {4, 8, 16, 32, 64}) print(rays, usual);
  for (const double factor : {0.5, 2.0, 4.0}) print(16, factor * usual);
  fmt::print("\n");
}

void print_peer(ObscuranceScene& scene, const PosedGeometry& geometry, const Plane& near_truth,
                const std::vector<std::size_t>& pixels, double reach, const TunedResult& ours) {
  for (const bool blur : {false, true}) {
    const ScreenSpaceOcclusion peer = vtk_screen_space_occlusion(geometry, scene.frame(), reach, 32, blur, 3);
    fmt::print(
        "vtkSSAOPass, 32 samples{}: {:.0f} ms (with {:.0f}, without {:.0f}), RMSE {:.4f} against traced obscurance; "
        "the last row above, RMSE {:.4f}, is {:.1f} times as cheap.\n",
        blur ? ", blur" : "", peer.pass_ms, peer.with_ms, peer.without_ms, rmse(picked(peer.open, pixels), near_truth),
        ours.rmse, peer.pass_ms / ours.ms);
  }
}

/// How much V changes from one frame to the next, of the pixels that show something in both.
void print_steadiness(ObscuranceScene& before, ObscuranceScene& after, const NearField& options) {
  using Kind = ObscuranceWay::Kind;
  fmt::print("\nCamera moved by 0.1 pixel, mean |change| of V:");
  for (const ObscuranceWay& way : {ObscuranceWay{Kind::lines, 12, 1}, ObscuranceWay{Kind::points, 12, 1},
                                   ObscuranceWay{Kind::lines, 5, 1}, ObscuranceWay{Kind::points, 6, 1}}) {
    const Plane a = before.shade(way, options), b = after.shade(way, options);
    const std::vector<std::size_t> pixels = before.drawn_pixels(1);
    fmt::print(" {} {:.5f};", way.name(), error_statistics(picked(a, pixels), picked(b, pixels), {}, {}).mae);
  }
  fmt::print("\n\n");
}

Scene loaded(const char* file, const Settings& settings) {
  const std::string size = std::to_string(settings.size);
  return load_scene(file, {"image.width=" + size, "image.height=" + size});
}

void print_scene(Device& device, const char* title, const char* file, const Settings& settings) {
  const World world = build_world(loaded(file, settings));
  FrameRunner runner(device, world);
  const Frame frame = runner.render(0, 1), moved = runner.render(0, 1, {0.1, 0});
  const PosedGeometry geometry = runner.posed_geometry();
  const Tracer tracer = tracer_of(geometry);
  ObscuranceScene scene(device, frame), moved_scene(device, moved);
  const std::vector<std::size_t> pixels = scene.drawn_pixels(truth_step);
  const Plane truth = traced(tracer, frame, pixels, std::numeric_limits<float>::infinity(), settings.rays);
  for (const double radius : {0.25, 1.0}) {
    const Plane near_truth = traced(tracer, frame, pixels, static_cast<float>(radius), settings.rays);
    NearField options;
    options.radius = radius;
    options.falloff = "cosine";
    for (const double thickness : {5 * radius, 0.0}) {
      options.thickness = thickness;
      const std::string depth = fmt::format("falloff cosine, {}", thickness > 0 ? "5 radii thick" : "endlessly thick");
      fmt::print("## {}, radius {} m, {}\n\n", title, radius, depth);
      print_ways(scene, near_truth, truth, pixels, options);
      print_steadiness(scene, moved_scene, options);
    }
    const TunedResult tuned = print_tuned(scene, near_truth, pixels, radius);
    print_rays(scene, near_truth, pixels, radius);
    print_peer(scene, geometry, near_truth, pixels, radius, tuned);
    fmt::print("\n");
    std::fflush(stdout);
  }
}

/// Whole frames with the near field as a factor, as a limit, and without it, against traced visibility.
void print_combination(Device& device, const char* file, const Settings& settings) {
  const Scene scene = loaded(file, settings);
  const World world = build_world(scene);
  FrameRunner runner(device, world);
  const Frame without = runner.render(0, 1);
  const Tracer tracer = tracer_of(runner.posed_geometry());
  const std::vector<std::size_t> pixels = ObscuranceScene(device, without).drawn_pixels(truth_step);
  const Plane truth = traced(tracer, without, pixels, std::numeric_limits<float>::infinity(), settings.rays);
  fmt::print("## The near field among the other terms: {}\n\n| near | RMSE | bias |\n|---|---|---|\n", file);
  const auto print = [&](const std::string& name, const Frame& frame) {
    const ErrorStatistics errors = error_statistics(picked(frame.visibility, pixels), truth, {}, {});
    fmt::print("| {} | {:.4f} | {:+.4f} |\n", name, errors.rmse, errors.bias);
  };
  print("none", without);
  for (const double radius : {0.1, 0.25, 0.5, 1.0})
    for (const char* combine : {"product", "minimum"}) {
      Methods methods = scene.methods;
      methods.near = "obscurance-line";
      methods.near_field.samples = 9;
      methods.near_field.radius = radius;
      methods.near_field.combine = combine;
      runner.choose(methods);
      print(fmt::format("lines 9, {} m, {}", radius, combine), runner.render(0, 1));
      methods.near = "screen-rays";
      methods.near_field.samples = 16;
      runner.choose(methods);
      print(fmt::format("rays 16, {} m, {}", radius, combine), runner.render(0, 1));
    }
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace understory

int main(int count, char** arguments) {
  using namespace understory;
  try {
    Settings settings;
    if (count > 1) settings.size = std::atoi(arguments[1]);
    const char* data = std::getenv("UNDERSTORY_DATA");
    if (!data) throw Error(ErrorKind::usage, "obscurance_table needs UNDERSTORY_DATA, the folder of real plants");
    Device device;
    fmt::print(
        "# Obscurance\n\nWritten by `build/release/bench/obscurance_table > bench/obscurance.md` on {}, {} compute "
        "units, {} x {} pixels. ms: processor time of all threads over the number of processors, least of {}.\n"
        "Traced obscurance: cosine-weighted rays as long as the radius; traced visibility: V_c under the dome.\n\n",
        device.info().name, device.info().compute_units, settings.size, settings.size, repetitions);
    print_scene(device, "Meadow", "sim/scenes/meadow.yaml", settings);
    print_scene(device, "Real plants", "bench/scenes/real.yaml", settings);
    print_combination(device, "sim/scenes/meadow.yaml", settings);
    print_gbuffer(device, data);
  } catch (const std::exception& error) {
    fmt::print(stderr, "obscurance_table: {}\n", error.what());
    return 1;
  }
  return 0;
}
