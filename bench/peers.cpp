#include "bench/peers.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>

#include "bench/fragments.hpp"
#include "bench/plain_loops.hpp"
#include "bench/timing.hpp"
#include "host/frame/runner.hpp"
#include "host/trace/crown_baked.hpp"
#include "host/trace/crown_field.hpp"
#include "host/trace/frame_truth.hpp"
#include "kernels/shared/grass_height.h"
#include "kernels/shared/sphere_cap.h"
#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"
#include "viz/vtk/screen_space_occlusion.hpp"

namespace understory {
namespace {

bool is_wanted(const BenchOptions& options, const std::string& name) {
  if (name.find(options.filter) == std::string::npos) return false;
  if (options.progress) options.progress(name);
  return true;
}

StopRule host_rule(const BenchOptions& options) {
  return options.repetitions > 0 ? exactly(options.repetitions) : StopRule{};
}

/// Wall times of `action`, which does `items` of something.
BenchResult timed(Device& device, const std::string& name, const std::string& item, double items,
                  const std::function<void()>& action, const StopRule& stop) {
  const MeasuredTime time = time_in_turn(device, {action}, stop).front();
  BenchResult result;
  result.name = name;
  result.item = item;
  result.items = items;
  result.median_ms = result.wall_ms = time.wall_ms.median;
  result.low_ms = result.wall_low_ms = time.wall_ms.low;
  result.high_ms = result.wall_high_ms = time.wall_ms.high;
  result.runs = time.runs;
  result.noisy = stop.precision > 0 && time.wall_ms.half_width() > stop.precision;
  if (time.wall_ms.median > 0) result.items_per_s = items / (time.wall_ms.median * 1e-3);
  result.verified = true;
  return result;
}

/// The bench's fragments in host memory.
struct HostFragments {
  HostFragments(Device& device, std::size_t count, BenchFragments::Cover filled_by)
      : all(device, count, filled_by),
        planes{all.planes.position_x.read(),        all.planes.position_y.read(),  all.planes.position_z.read(),
               all.planes.normal_x.read(),          all.planes.normal_y.read(),    all.planes.normal_z.read(),
               all.planes.height_above_root.read(), all.planes.blade_length.read()},
        owner(all.planes.owner.read()),
        visibility(owner.size()) {
    for (const Owner& row : all.owner_rows()) {
      crown_row.push_back(row.crown);
      surface.push_back(static_cast<std::uint32_t>(row.surface));
    }
  }
  PlainFragments plain() const {
    return {planes[0].data(), planes[1].data(), planes[2].data(), planes[3].data(), planes[4].data(),
            planes[5].data(), planes[6].data(), planes[7].data(), owner.data()};
  }
  BenchFragments all;
  std::vector<float> planes[8];
  std::vector<std::uint32_t> owner, surface;
  std::vector<std::int32_t> crown_row;
  std::vector<float> visibility;
};

/// `loop` on blocks of fragments, on all cores.
void on_all_cores(std::size_t count, const std::function<void(std::size_t, std::size_t)>& loop) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1 << 14),
                    [&](const auto& range) { loop(range.begin(), range.end()); });
}

void bench_loop(Device& device, const BenchOptions& options, const std::string& name, BenchFragments::Cover filled_by,
                const std::function<void(HostFragments&, std::size_t, std::size_t)>& loop,
                const std::function<double(const HostFragments&, const BenchFragment&)>& reference,
                BenchReport& report) {
  if (!is_wanted(options, name)) return;
  HostFragments host(device, *std::max_element(options.fragments.begin(), options.fragments.end()), filled_by);
  const std::size_t count = host.owner.size();
  const auto run = [&] { on_all_cores(count, [&](std::size_t begin, std::size_t end) { loop(host, begin, end); }); };
  BenchResult result = timed(device, name, "fragment", static_cast<double>(count), run, host_rule(options));
  for (std::size_t i = 0; i < count; i += 101)
    result.max_error =
        std::max(result.max_error, std::abs(double(host.visibility[i]) - reference(host, host.all.at(i))));
  result.verified = result.max_error <= 1e-5;
  report.results.push_back(result);
}

void bench_loops(Device& device, const BenchOptions& options, BenchReport& report) {
  bench_loop(
      device, options, "peer/c++-loop/sphere-cap", BenchFragments::Cover::crowns,
      [](HostFragments& host, std::size_t begin, std::size_t end) {
        plain_sphere_cap(host.plain(), host.crown_row.data(), host.all.crown_rows().data(), host.visibility.data(),
                         begin, end);
      },
      [](const HostFragments& host, const BenchFragment& f) {
        const std::int32_t row = host.crown_row[f.owner];
        if (row < 0) return 1.0;
        const CrownRecord& crown = host.all.crown_rows()[static_cast<std::size_t>(row)];
        const glm::dvec3 p = glm::dvec3(f.position) - glm::dvec3(crown.x, crown.y, crown.z), n(f.normal);
        return sphere_cap(p.x, p.y, p.z, n.x, n.y, n.z, double(crown.radius), double(crown.alpha_rho));
      },
      report);
  bench_loop(
      device, options, "peer/c++-loop/grass-height", BenchFragments::Cover::grass,
      [](HostFragments& host, std::size_t begin, std::size_t end) {
        plain_grass_height(host.plain(), host.surface.data(), static_cast<std::uint32_t>(SurfaceClass::blade),
                           host.visibility.data(), begin, end);
      },
      [](const HostFragments&, const BenchFragment& f) {
        return grass_height(double(f.height), double(f.blade_length));
      },
      report);
}

/// One generated tree over flat ground.
Scene tree_scene(int leaves, glm::ivec2 size) {
  Scene scene;
  scene.name = "tree";
  scene.seed = 3;
  scene.image = {size.x, size.y};
  scene.camera.position = {0, -25, 6};
  scene.camera.target = {0, 0, 7};
  scene.camera.vertical_fov = 0.7;
  scene.wind.speed = 0;
  SpeciesSource species;
  species.name = species.generator = "broadleaf";
  species.leaves = leaves;
  scene.species.push_back(species);
  PlantPlacement placement;
  placement.species = species.name;
  placement.spots.push_back({{0, 0}, 0, 1});
  scene.plants.push_back(placement);
  return scene;
}

double covered_pixels(const Frame& frame) {
  return static_cast<double>(std::count_if(frame.validity.begin(), frame.validity.end(),
                                           [](std::uint32_t code) { return (code & validity::background) == 0; }));
}

bool is_sound(const Frame& frame) {
  return std::all_of(frame.visibility.begin(), frame.visibility.end(), [](float v) { return v >= 0 && v <= 1; });
}

/// A frame, its triangles, and what traces them.
struct Traced {
  Traced(Device& device, const Scene& the_scene) : scene(the_scene), world(build_world(scene)) {
    FrameRunner runner(device, world);
    frame = runner.render(0, scene.time.at(0));
    geometry = runner.posed_geometry();
    tracer.emplace(tracer_of(geometry));
  }
  Scene scene;
  World world;
  Frame frame;
  PosedGeometry geometry;
  std::optional<Tracer> tracer;
};

/// Rays over seconds: an item is a ray, or a fragment.
void bench_rays(Device& device, const std::string& name, const Traced& traced, int rays, bool count_rays,
                BenchReport& report) {
  Frame truth = traced.frame;
  TruthOptions settings;
  settings.rays = rays;
  settings.sky = traced.scene.sky;
  const double covered = covered_pixels(traced.frame);
  BenchResult result = timed(
      device, name, count_rays ? "ray" : "fragment", count_rays ? covered * rays : covered,
      [&] { trace_frame(*traced.tracer, settings, truth, {}); }, exactly(3));
  result.verified = is_sound(truth);
  report.results.push_back(result);
}

/// One ray a pixel is less than an interval can be had from: the rays alone.
void bench_single_rays(Device& device, const std::string& name, const Traced& traced, BenchReport& report) {
  std::vector<Ray> rays;
  const Frame& frame = traced.frame;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.validity[i] & validity::background) continue;
    const glm::vec3 n(frame.normal[0][i], frame.normal[1][i], frame.normal[2][i]);
    const glm::vec3 p(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
    const double turn = 2.399963 * double(i), share = double(i % 1021) / 1021, flat = std::sqrt(share);
    const glm::vec3 side =
        glm::normalize(glm::cross(n, std::abs(n.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0)));
    const glm::vec3 direction = float(flat * std::cos(turn)) * side +
                                float(flat * std::sin(turn)) * glm::cross(n, side) + float(std::sqrt(1 - share)) * n;
    rays.push_back({p + 1e-4f * n, 0, direction, std::numeric_limits<float>::infinity()});
  }
  std::vector<std::uint8_t> blocked(rays.size());
  const auto trace = [&] {
    on_all_cores(rays.size(), [&](std::size_t begin, std::size_t end) {
      const std::size_t count = end - begin;
      traced.tracer->blocked(std::span(rays).subspan(begin, count), std::span(blocked).subspan(begin, count));
    });
  };
  BenchResult result = timed(device, name, "fragment", double(rays.size()), trace, exactly(9));
  const auto hits = std::count(blocked.begin(), blocked.end(), std::uint8_t{1});
  result.verified = hits > 0 && hits < std::ssize(blocked);
  report.results.push_back(result);
}

void bench_screen_space(const std::string& name, const Traced& traced, BenchReport& report) {
  BenchResult result;
  result.name = name;
  result.item = "fragment";
  try {
    const ScreenSpaceOcclusion ssao = vtk_screen_space_occlusion(traced.geometry, traced.frame, 0.25, 32, false, 3);
    result.items = covered_pixels(traced.frame);
    result.median_ms = result.low_ms = result.high_ms = result.wall_ms = ssao.pass_ms;
    if (ssao.pass_ms > 0) result.items_per_s = result.items / (ssao.pass_ms * 1e-3);
    result.runs = 3;
    result.verified = std::all_of(ssao.open.begin(), ssao.open.end(), [](float v) { return v >= 0 && v <= 1; });
    report.results.push_back(result);
  } catch (const Error& error) {  // no EGL here: a peer is missing, nothing of ours is wrong
    if (error.kind() != ErrorKind::no_device) throw;
  }
}

void bench_tracing(Device& device, const BenchOptions& options, BenchReport& report) {
  std::optional<Traced> tree;
  const auto wanted = [&](const std::string& name) {
    if (!is_wanted(options, name)) return false;
    if (!tree) tree.emplace(device, tree_scene(100'000, {512, 512}));
    return true;
  };
  if (const std::string name = "peer/embree/1-ray"; wanted(name)) bench_single_rays(device, name, *tree, report);
  for (const int rays : {16, 128})
    if (const std::string name = fmt::format("peer/embree/{}-rays", rays); wanted(name))
      bench_rays(device, name, *tree, rays, false, report);
  if (const std::string name = "peer/vtk-ssao/32-samples"; wanted(name)) bench_screen_space(name, *tree, report);
  if (const std::string name = "truth/broadleaf"; wanted(name)) bench_rays(device, name, *tree, 64, true, report);
  const char* data = std::getenv("UNDERSTORY_DATA");
  const std::filesystem::path oak = "bench/scenes/black_oak.yaml";
  if (data && *data && std::filesystem::exists(oak))
    if (const std::string name = "truth/black-oak"; is_wanted(options, name)) {
      Traced traced(device, load_scene(oak));
      bench_rays(device, name, traced, 64, true, report);
    }
}

/// Bars are for a million triangles: rates tell.
void bench_bakes(Device& device, const BenchOptions& options, BenchReport& report) {
  std::optional<World> world;
  const auto bake = [&](const std::string& name, int leaves, const std::function<bool(const Prototype&)>& baked) {
    if (!is_wanted(options, name)) return;
    world.emplace(build_world(tree_scene(leaves, {64, 64})));
    const auto tree = std::max_element(
        world->prototypes.begin(), world->prototypes.end(),
        [](const Prototype& a, const Prototype& b) { return a.triangle_count() < b.triangle_count(); });
    bool sound = true;
    BenchResult result = timed(
        device, name, "triangle", static_cast<double>(tree->triangle_count()), [&] { sound = baked(*tree) && sound; },
        once);
    result.verified = sound;
    report.results.push_back(result);
  };
  bake("bake/crown-field", 240'000, [](const Prototype& tree) {
    const CrownField field = bake_crown_field(tree, {});
    const double v = field_visibility(field, 0.5f * (tree.low + tree.high), {0, 0, 1});
    return v >= 0 && v < 0.9;  // the middle of a crown
  });
  bake("bake/crown-baked", 5'000, [](const Prototype& tree) {
    const CrownBaked baked = bake_crown_faces(tree, {});
    return baked.faces.size() == tree.triangle_count() && !baked.texels.empty();
  });
}

}  // namespace

void bench_peers(Device& device, const BenchOptions& options, BenchReport& report) {
  bench_loops(device, options, report);
  bench_tracing(device, options, report);
  bench_bakes(device, options, report);
}

}  // namespace understory
