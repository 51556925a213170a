#include "bench/obscurance_gbuffer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/error_statistics.hpp"
#include "bench/obscurance_scene.hpp"
#include "sim/error.hpp"
#include "viz/exr/gbuffer.hpp"
#include "viz/exr/image.hpp"

namespace understory {
namespace {

struct Row {
  std::string name;
  ErrorStatistics errors;
};

std::string describe(const ObscuranceWay& way, const NearField& options) {
  std::string text = fmt::format("{}, {} m", way.name(), options.radius);
  if (options.second_radius > 0) text += fmt::format(" and {} m, {}", options.second_radius, options.radii);
  if (options.normals != "buffer") text += ", normals: " + options.normals;
  if (options.falloff != "constant") text += ", " + options.falloff;
  if (options.thickness > 0) text += fmt::format(", {} m thick", options.thickness);
  return text;
}

/// Radii alone and in pairs, thicknesses in radii, falloffs, with and without normals.
std::vector<NearField> settings() {
  std::vector<NearField> all;
  const auto add = [&](double radius, double second, const char* radii, double thickness, const char* falloff,
                       const char* normals) {
    NearField options;
    options.radius = radius;
    options.second_radius = second;
    options.radii = radii;
    options.thickness = thickness * radius;
    options.falloff = falloff;
    options.normals = normals;
    all.push_back(options);
  };
  for (const char* falloff : {"constant", "quadratic", "cosine"})
    for (const double thickness : {0.0, 4.0, 8.0, 16.0})
      for (const double radius : {0.25, 0.5, 1.0, 2.0, 3.0}) add(radius, 0, "product", thickness, falloff, "buffer");
  for (const char* radii : {"product", "minimum"})
    for (const char* falloff : {"constant", "quadratic", "cosine"})
      for (const double thickness : {0.0, 16.0}) {
        add(0.25, 1, radii, thickness, falloff, "buffer");
        add(0.5, 2, radii, thickness, falloff, "buffer");
      }
  for (const double radius : {0.25, 1.0}) add(radius, 0, "product", 0, "constant", "none");
  return all;
}

/// The file's only channel of a name that ends so, or the first.
Plane ambient_occlusion(const std::filesystem::path& path) {
  const ExrImage image = read_exr(path);
  if (image.floats.empty()) throw Error(ErrorKind::invalid_input, path.string() + ": no float channel");
  return image.floats.begin()->second;
}

}  // namespace

void print_gbuffer(Device& device, const std::filesystem::path& data) {
  const Gbuffer gbuffer = read_gbuffer(data / "gbuffer/gbuffer_walnut_meadow.exr");
  const Plane truth = ambient_occlusion(data / "gbuffer/gbuffer_walnut_meadow_ao.exr");
  ObscuranceScene scene(device, gbuffer.frame);
  const std::vector<std::size_t> pixels = scene.drawn_pixels(1);
  const auto picked = [&](const Plane& plane) {
    Plane values;
    for (const std::size_t i : pixels) values.push_back(plane[i]);
    return values;
  };
  const Plane exact = picked(truth);
  std::vector<Row> rows;
  using Kind = ObscuranceWay::Kind;
  for (const NearField& options : settings())
    for (const ObscuranceWay& way : {ObscuranceWay{Kind::lines, 5, 1}, ObscuranceWay{Kind::lines, 16, 1},
                                     ObscuranceWay{Kind::points, 12, 1}, ObscuranceWay{Kind::areas, 1, 1}}) {
      if (way.kind == Kind::areas && options.falloff != "constant") continue;
      const Plane shaded = scene.shade(way, options);
      rows.push_back({describe(way, options), error_statistics(picked(shaded), exact, {}, {})});
      if (way.kind != Kind::lines) continue;
      const Plane blurred = scene.blurred(shaded, options);
      rows.push_back({describe(way, options) + ", blur 4", error_statistics(picked(blurred), exact, {}, {})});
    }
  for (const double thickness : {0.03, 0.05, 0.1})
    for (const int rays : {4, 8, 16, 32, 64}) {
      NearField options;
      options.radius = 3;
      options.thickness = thickness;
      const ObscuranceWay way{Kind::rays, rays, 1};
      const Plane shaded = scene.shade(way, options), blurred = scene.blurred(shaded, options);
      rows.push_back({describe(way, options), error_statistics(picked(shaded), exact, {}, {})});
      rows.push_back({describe(way, options) + ", blur 4", error_statistics(picked(blurred), exact, {}, {})});
    }
  const auto best = std::min_element(rows.begin(), rows.end(),
                                     [](const Row& a, const Row& b) { return a.errors.rmse < b.errors.rmse; });
  fmt::print(
      "## Walnut meadow, a G-buffer of Blender, against its Cycles AO pass (256 cosine-weighted rays, 3 m)\n\n"
      "Best: {}, RMSE {:.4f} (bar 0.10); the best constant has {:.4f}.\n\n| setting | RMSE | bias |\n|---|---|---|\n",
      best->name, best->errors.rmse, best->errors.best_constant);
  for (const Row& row : rows) fmt::print("| {} | {:.4f} | {:+.4f} |\n", row.name, row.errors.rmse, row.errors.bias);
}

}  // namespace understory
