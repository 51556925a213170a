#include "host/app/bench_roofline.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "viz/vtk/png.hpp"

namespace understory {
namespace {

/// At the largest size, of those whose operations are counted.
bool is_shown(const BenchResult& result) {
  const bool whole = std::count(result.name.begin(), result.name.end(), '/') == 1 || result.name.ends_with("/dome") ||
                     result.name.ends_with("/each");
  return result.verified && result.name.starts_with("kernel/") && whole && result.flop_per_s > 0;
}

}  // namespace

ScatterChart roofline_chart(const BenchReport& report) {
  ScatterChart chart;
  chart.title = fmt::format("{}, {} compute units", report.device.name, report.device.compute_units);
  chart.x_title = "float operations per byte that has to move";
  chart.y_title = "GFLOP/s";
  chart.joined = false;
  chart.y_logarithmic = true;
  double least = 0.05, most = 100;
  for (const BenchResult& result : report.results) {
    if (!is_shown(result)) continue;
    const double scale = 1e-9 * result.flop_per_s * result.median_ms;
    ChartPoint point;
    point.x = point.x_low = point.x_high = result.operations_per_byte;
    point.y = 1e-9 * result.flop_per_s;
    point.y_low = scale / result.high_ms;
    point.y_high = scale / result.low_ms;
    point.marked = true;
    point.label = fmt::format("{}: {:.2f} of {}", result.name, result.roof_share, result.bound_by);
    chart.points.push_back(point);
    least = std::min(least, point.x);
    most = std::max(most, point.x);
  }
  const auto roof = [&](const char* name) { return report.roofs.contains(name) ? report.roofs.at(name) : 0.0; };
  const double memory = roof("copy_gb_per_s"), arithmetic = roof("multiply_add_gflop_per_s");
  if (memory <= 0 || arithmetic <= 0) return chart;
  const double ridge = arithmetic / memory;
  chart.lines.push_back({least, least * memory, ridge, arithmetic, ""});
  chart.lines.push_back({ridge, arithmetic, std::max(most, ridge), arithmetic,
                         fmt::format("multiply-add {:.0f} GFLOP/s; to its left copy {:.0f} GB/s", arithmetic, memory)});
  return chart;
}

void require_picture_name(const std::filesystem::path& file) {
  if (file.extension() != ".svg" && file.extension() != ".png")
    throw Error(ErrorKind::usage, "--roofline " + file.string() + ": allowed are names that end in .png or .svg");
}

void write_roofline(const BenchReport& report, const std::filesystem::path& file) {
  require_picture_name(file);
  const ScatterChart chart = roofline_chart(report);
  if (file.extension() == ".svg")
    write_file_atomically(file, chart_svg(chart));
  else
    write_png(file, draw_chart(chart));
}

}  // namespace understory
