#include "bench/grid_features.hpp"

#include <algorithm>
#include <memory>

#include "bench/timing.hpp"
#include "host/frame/runner.hpp"

namespace understory {
namespace {

constexpr int repetitions = 15;

struct Feature {
  const char *name, *occluders, *combine;
  bool environment = false, gloss = false;
};
constexpr Feature features[] = {{"solid-angle-cosine", "solid-angle-cosine", "merge"},
                                {"grid", "grid", "merge"},
                                {"multiply", "grid-cone", "multiply"},
                                {"simple", "grid-cone", "simple"},
                                {"simple+environment", "grid-cone", "simple", true},
                                {"merge", "grid-cone", "merge"},
                                {"union", "grid-cone", "union"},
                                {"merge+environment", "grid-cone", "merge", true},
                                {"merge+environment+gloss", "grid-cone", "merge", true, true}};

Scene walker_on_flat_ground() {
  Scene scene;
  scene.name = "walker";
  scene.image = {800, 600};
  scene.camera.position = {0, -4, 1.4};
  scene.camera.target = {0, 0, 0.85};
  scene.camera.vertical_fov = 0.55;
  scene.methods.crowns = "none";
  OccluderSource walker;
  walker.name = "walker";
  walker.generator = "walker";
  walker.keyframes = {{-2, {-2.6, 0, 0}, {}}, {0, {0, 0, 0}, {}}, {2, {2.6, 0, 0}, {}}};
  scene.occluders.push_back(walker);
  return scene;
}

/// A sky that is brighter and bluer above: the map's content does not change the cost.
std::shared_ptr<const EnvironmentMap> clear_sky() {
  EnvironmentMap map{64, 32, {}};
  for (int row = 0; row < map.height; ++row)
    map.radiance.insert(map.radiance.end(), 64, glm::vec3(1, 1, 1.5f - 0.02f * static_cast<float>(row)));
  return std::make_shared<const EnvironmentMap>(map);
}

struct Measured {
  World world;
  std::unique_ptr<FrameRunner> runner;
  std::string occluders;
  std::vector<double> samples;
  bool sound = true;

  void render(int index) {
    const Frame frame = runner->render(index, -0.5 + 0.07 * index);
    double sum = frame.pass_ms.at(occluders);
    if (const auto light = frame.pass_ms.find("environment"); light != frame.pass_ms.end()) sum += light->second;
    samples.push_back(sum);
    sound = sound &&
            std::all_of(frame.visibility.begin(), frame.visibility.end(), [](float v) { return v >= 0 && v <= 1; });
    for (const Plane& light : frame.ambient_light)
      sound = sound && std::all_of(light.begin(), light.end(), [](float l) { return l >= 0 && l <= 1.5f; });
  }
};

}  // namespace

void bench_grid_features(Device& device, const BenchOptions& options, BenchReport& report) {
  std::vector<std::pair<std::string, std::unique_ptr<Measured>>> all;
  for (const Feature& feature : features) {
    const std::string name = std::string("grid/feature/") + feature.name;
    if (name.find(options.filter) == std::string::npos) continue;
    if (options.progress) options.progress(name);
    auto measured = std::make_unique<Measured>();
    Scene scene = walker_on_flat_ground();
    scene.methods.occluders = measured->occluders = feature.occluders;
    scene.methods.combine = feature.combine;
    scene.environment.gloss = feature.gloss ? 0.3 : 0;
    measured->world = build_world(scene);
    if (feature.environment) measured->world.environment = clear_sky();
    measured->runner = std::make_unique<FrameRunner>(device, measured->world);
    measured->runner->render(0, 0);
    all.emplace_back(name, std::move(measured));
  }
  for (int i = 0; i < repetitions; ++i)
    for (const auto& [name, measured] : all) measured->render(i);
  for (const auto& [name, measured] : all) {
    BenchResult result;
    result.name = name;
    result.verified = measured->sound;
    const Spread95 spread = spread_of(measured->samples);
    result.median_ms = spread.median;
    result.low_ms = *std::min_element(measured->samples.begin(), measured->samples.end());
    result.high_ms = spread.high;
    if (result.verified) result.items_per_s = 800 * 600 / (spread.median * 1e-3);
    report.results.push_back(result);
  }
}

}  // namespace understory
