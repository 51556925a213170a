#include "bench/grid_accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/grid_receivers.hpp"
#include "host/frame/runner.hpp"
#include "host/trace/truth.hpp"
#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"

namespace understory {
namespace {

/// How bodies shade others, as users type it; the rule matters to grids of cones only.
struct Variant {
  const char *method, *combine;
  std::string name() const { return std::string(method) + (*combine ? std::string(" ") + combine : ""); }
};
constexpr Variant variants[] = {{"solid-angle-cosine", ""},    {"grid", ""},
                                {"grid-self-paper", ""},       {"grid-cone-paper", "multiply"},
                                {"grid-cone-paper", "simple"}, {"grid-cone-paper", "merge"},
                                {"grid-cone", "multiply"},     {"grid-cone", "simple"},
                                {"grid-cone", "merge"},        {"grid-cone", "union"}};

/// V of a kind of receiver in all frames of a scene: truth, and one row of values per variant.
struct Samples {
  std::vector<float> truth, halfwidth;
  std::vector<std::vector<float>> values{std::size(variants)};
};

Scene bodies_over_ground(const std::filesystem::path& file) {
  Scene scene = load_scene(file);
  if (scene.occluders.empty())
    throw Error(ErrorKind::invalid_input, file.string() + ": occluders: none; grids are those of moving bodies");
  scene.plants.clear();
  scene.grass.clear();
  scene.species.clear();
  scene.sky = Sky::sphere;  // the occluders' term knows no horizon
  scene.methods.crowns = "none";
  return scene;
}

Truth truth_at(const Tracer& tracer, const Frame& frame, glm::vec3 eye, const std::vector<std::size_t>& pixels,
               int rays) {
  std::vector<glm::vec3> positions, normals;
  for (const std::size_t i : pixels) {
    positions.emplace_back(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
    normals.emplace_back(frame.normal[0][i], frame.normal[1][i], frame.normal[2][i]);
  }
  TruthOptions options;
  options.rays = rays;
  options.sky = Sky::sphere;
  options.eye = eye;
  return trace_truth(tracer, positions, normals, options);
}

void add_truth(const Truth& truth, Samples& samples) {
  samples.truth.insert(samples.truth.end(), truth.visibility.begin(), truth.visibility.end());
  samples.halfwidth.insert(samples.halfwidth.end(), truth.halfwidth.begin(), truth.halfwidth.end());
}

/// One after the other.
Samples joined(std::initializer_list<const Samples*> parts) {
  Samples all;
  const auto append = [](std::vector<float>& to, const std::vector<float>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const Samples* part : parts) {
    append(all.truth, part->truth);
    append(all.halfwidth, part->halfwidth);
    for (std::size_t variant = 0; variant < all.values.size(); ++variant)
      append(all.values[variant], part->values[variant]);
  }
  return all;
}

GridAccuracyRow row_of(const std::string& scene, const std::string& receivers, const Samples& samples,
                       std::size_t variant) {
  GridAccuracyRow row{scene, receivers, variants[variant].name()};
  const std::vector<float>& values = samples.values[variant];
  row.fragments = values.size();
  std::vector<double> errors;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double error = double(values[i]) - double(samples.truth[i]), noise = double(samples.halfwidth[i]) / 1.96;
    row.rmse += error * error;
    row.bias += error;
    row.mean_truth += double(samples.truth[i]);
    row.truth_noise += noise * noise;
    errors.push_back(std::abs(error));
  }
  if (errors.empty()) return row;
  const double count = static_cast<double>(errors.size());
  row.rmse = std::sqrt(row.rmse / count);
  row.bias /= count;
  row.mean_truth /= count;
  row.truth_noise = std::sqrt(row.truth_noise / count);
  const auto rank = errors.begin() + static_cast<std::ptrdiff_t>(0.99 * (count - 1));
  std::nth_element(errors.begin(), rank, errors.end());
  row.p99 = *rank;
  return row;
}

void measure_scene(Device& device, const std::filesystem::path& file, const GridAccuracyOptions& options,
                   GridAccuracyReport& report) {
  const Scene scene = bodies_over_ground(file);
  const World world = build_world(scene);
  FrameRunner runner(device, world);
  Samples ground, near, contact, bodies;
  const int frames = std::min(options.frames, scene.time.frames);
  std::vector<GridReceivers> receivers;
  for (std::size_t variant = 0; variant < std::size(variants); ++variant) {
    if (options.progress) options.progress(scene.name + ", " + variants[variant].name());
    Methods methods = scene.methods;
    methods.occluders = variants[variant].method;
    if (*variants[variant].combine) methods.combine = variants[variant].combine;
    runner.choose(methods);
    for (int f = 0; f < frames; ++f) {
      const int index = (2 * f + 1) * scene.time.frames / (2 * frames);
      const Frame frame = runner.render(index, scene.time.at(index));
      if (variant == 0) {
        const PosedGeometry geometry = runner.posed_geometry();
        receivers.push_back(grid_receivers(world, frame, geometry, options.fragments));
        const std::vector<glm::vec3> corners = occluder_corners(frame, geometry);
        std::vector<std::uint32_t> indices(corners.size());
        std::iota(indices.begin(), indices.end(), 0u);
        const Tracer tracer(corners, indices);
        const glm::vec3 eye(scene.camera.position);
        add_truth(truth_at(tracer, frame, eye, receivers.back().ground, options.rays), ground);
        add_truth(truth_at(tracer, frame, eye, receivers.back().near, options.rays), near);
        add_truth(truth_at(tracer, frame, eye, receivers.back().contact, options.rays), contact);
        add_truth(truth_at(tracer, frame, eye, receivers.back().bodies, options.rays), bodies);
      }
      const Plane& term = frame.terms.at(methods.occluders);
      const GridReceivers& here = receivers[static_cast<std::size_t>(f)];
      for (const std::size_t i : here.ground) ground.values[variant].push_back(term[i]);
      for (const std::size_t i : here.near) near.values[variant].push_back(term[i]);
      for (const std::size_t i : here.contact) contact.values[variant].push_back(term[i]);
      for (const std::size_t i : here.bodies) bodies.values[variant].push_back(term[i]);
    }
    report.rows.push_back(row_of(scene.name, "ground", ground, variant));
    report.rows.push_back(row_of(scene.name, "near", near, variant));
    report.rows.push_back(row_of(scene.name, "contact", contact, variant));
    report.rows.push_back(row_of(scene.name, "bodies", bodies, variant));
    report.rows.push_back(row_of(scene.name, "all", joined({&ground, &contact, &bodies}), variant));
  }
}

const GridAccuracyRow& row_for(const GridAccuracyReport& report, const std::string& scene, const std::string& receivers,
                               const std::string& method) {
  return *std::find_if(report.rows.begin(), report.rows.end(), [&](const GridAccuracyRow& row) {
    return row.scene == scene && row.receivers == receivers && row.method == method;
  });
}

std::string table_of(const GridAccuracyReport& report, const std::string& receivers, const std::string& title) {
  std::vector<std::string> scenes;
  for (const GridAccuracyRow& row : report.rows)
    if (std::find(scenes.begin(), scenes.end(), row.scene) == scenes.end()) scenes.push_back(row.scene);
  std::string text = fmt::format("\n## {}\n\n|", title), rule = "\n|---|", about;
  const std::string first = variants[0].name();
  for (const std::string& scene : scenes) {
    const GridAccuracyRow& row = row_for(report, scene, receivers, first);
    text += fmt::format(" | {}", scene);
    rule += "---|";
    about += fmt::format(" {}, {:.3f}, {:.4f} |", row.fragments, row.mean_truth, row.truth_noise);
  }
  text += " |" + rule + "\n| fragments, mean V, truth noise |" + about + "\n";
  for (const Variant& variant : variants) {
    text += fmt::format("| {} |", variant.name());
    for (const std::string& scene : scenes) {
      const GridAccuracyRow& row = row_for(report, scene, receivers, variant.name());
      text += fmt::format(" {:.4f} ({:+.3f}, {:.3f}) |", row.rmse, row.bias, row.p99);
    }
    text += "\n";
  }
  for (const char* combined : {"merge", "union"}) {
    text += fmt::format("| grid-cone {} / multiply |", combined);
    for (const std::string& scene : scenes) {
      const double whole = row_for(report, scene, receivers, "grid-cone multiply").rmse;
      const double ratio = row_for(report, scene, receivers, std::string("grid-cone ") + combined).rmse / whole;
      text += whole > 0 ? fmt::format(" {:.2f} |", ratio) : " both 0 |";
    }
    text += "\n";
  }
  return text;
}

}  // namespace

GridAccuracyReport measure_grid_accuracy(const GridAccuracyOptions& options) {
  Device device(options.device);
  GridAccuracyReport report{device.info(), options.rays, options.frames, {}};
  for (const std::filesystem::path& file : options.scenes) measure_scene(device, file, options, report);
  return report;
}

std::string grid_accuracy_markdown(const GridAccuracyReport& report) {
  std::string text = fmt::format(
      "# How moving bodies shade others\n\nMade by `understory bench --grids` (bench/README.md), never by hand; on {}. "
      "V_c of the occluders "
      "alone, `sky: sphere`, over\nfragments within some body's grid; truth of {} rays a fragment, up to {} frames a "
      "scene. "
      "Each entry is RMSE (bias, 99 % of\n|error| are not above). Truth noise: its root mean square standard error.\n",
      report.device.name, report.rays, report.frames);
  text += table_of(report, "ground", "Ground, at least one cell of the body's grid from the body");
  text +=
      table_of(report, "near", "Of this ground, where grids of epsilon 0.02 would reach: the shadows that one sees");
  text += table_of(report, "contact", "Ground within one cell of a body: contact");
  text += table_of(report, "bodies", "The bodies themselves");
  text += table_of(report, "all", "All of them");
  return text;
}

}  // namespace understory
