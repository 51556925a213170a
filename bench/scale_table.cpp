// Writes FOLDER/scale.md and FOLDER/scale.svg: what each level of detail of SCENE costs and changes, and how time and
// memory grow with triangles, instances and pixels.  scale_table SCENE FOLDER
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

#include "bench/scale_detail.hpp"
#include "bench/scale_growth.hpp"
#include "bench/scale_plot.hpp"
#include "sim/files/atomic_file.hpp"

namespace understory {
namespace {

constexpr double mib = 1024.0 * 1024.0;

std::string detail_table(const std::string& scene, const std::vector<DetailRow>& rows) {
  std::string text = fmt::format(
      "## Levels of detail of `{}`\n\n"
      "Differences from brute force after a box filter of 8 x 8 pixels: of V, and of the sky-lit picture (0 to 1). "
      "One\n"
      "sample in the middle of every pixel, and 16 of them. The row *other samples* is brute force against itself "
      "with\n"
      "every sample moved by a third of their distance: what the number of samples alone leaves uncertain. The dolly\n"
      "moves the camera by 0.05 m from frame to frame and holds the wind still; its figures are the largest RMS and "
      "the\n"
      "largest single change of filtered V between two frames.\n\n"
      "| detail | million triangles | median ms (low, high) | frames/s | device MiB | V RMSE, 1 sample | V bias | "
      "picture "
      "| V RMSE, 16 samples | V bias | picture | dolly RMS | largest |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      scene);
  for (const DetailRow& row : rows) {
    const std::string cost =
        row.ms.median > 0 ? fmt::format("{:.2f} | {:.1f} ({:.1f}, {:.1f}) | {:.1f} | {:.0f}", row.triangles * 1e-6,
                                        row.ms.median, row.ms.low, row.ms.high, 1e3 / row.ms.median, row.device_mib)
                          : std::string("| | |");
    const std::string dolly =
        row.mean_change > 0 ? fmt::format("{:.4f} | {:.3f}", row.mean_change, row.largest_change) : std::string("|");
    text += fmt::format("| {} | {} | {:.4f} | {:+.4f} | {:.4f} | {:.4f} | {:+.4f} | {:.4f} | {} |\n", row.detail, cost,
                        row.one.rmse, row.one.bias, row.one.picture_rmse, row.many.rmse, row.many.bias,
                        row.many.picture_rmse, dolly);
  }
  return text + "\n";
}

struct Columns {
  std::vector<double> size, ms, device, bytes, instances;
};

Columns columns_of(const std::vector<GrowthPoint>& points) {
  Columns columns;
  for (const GrowthPoint& point : points) {
    columns.size.push_back(point.size);
    columns.ms.push_back(point.ms);
    columns.device.push_back(point.device_mib);
    columns.bytes.push_back(point.device_mib * mib);
    columns.instances.push_back(point.instances);
  }
  return columns;
}

std::string growth_table(const char* title, const char* unit, const std::vector<GrowthPoint>& points) {
  const Columns columns = columns_of(points);
  const LinearFit time = fit_line(columns.size, columns.ms), memory = fit_line(columns.size, columns.bytes);
  std::string text =
      fmt::format("## {}\n\n| million {} | plants and ground | ms | device MiB | world MiB |\n|---|---|---|---|---|\n",
                  title, unit);
  for (const GrowthPoint& point : points)
    text += fmt::format("| {:.2f} | {:.0f} | {:.1f} | {:.1f} | {:.1f} |\n", point.size, point.instances, point.ms,
                        point.device_mib, point.world_mib);
  return text +
         fmt::format(
             "\nTime: {:.1f} ms + {:.2f} ms per million {}; from one size to the next it grows by at most {:.2f} "
             "times as much as\nthe size. Memory: {:.1f} MiB + {:.1f} bytes per one of the {}.\n\n",
             time.first, time.slope, unit, time.worst_growth, memory.first / mib, memory.slope * 1e-6, unit);
}

std::string instance_text(const std::vector<GrowthPoint>& points) {
  const GrowthPoint &before = points[points.size() - 2], &last = points.back();
  return fmt::format(
      "A further instance, from {:.0f} to {:.0f} of them: {:.0f} bytes on the device. Posed vertices and limbs are "
      "drawn "
      "in\nbatches that share one buffer each; up to 256 crowns the lists of what shades each tile of the picture grow "
      "with\nthem (21,000 bytes for each crown at 800 x 500), beyond that they do not.\n\n",
      before.instances, last.instances,
      (last.device_mib - before.device_mib) * mib / (last.instances - before.instances));
}

void write_tables(const std::string& scene, const std::string& folder) {
  std::string text = fmt::format(
      "# Frames at scale\n\nMade by `build/release/bench/scale_table {} {}` (target scale_table); times are of the "
      "machine that ran it.\n\n",
      scene, folder);
  text += detail_table(scene, measure_detail(scene, 11));
  const std::vector<GrowthPoint> triangles = measure_triangle_growth(64), pixels = measure_pixel_growth(16);
  text += "![time and memory over triangles and pixels](scale.svg)\n\n";
  text += growth_table("Triangles", "triangles", triangles) + instance_text(triangles);
  text += growth_table("Pixels", "pixels", pixels);
  const Columns t = columns_of(triangles), p = columns_of(pixels);
  const std::string svg = svg_of(
      {{"Triangles", "million triangles drawn", "ms, MiB", {{"ms", t.size, t.ms}, {"device MiB", t.size, t.device}}},
       {"Pixels", "million pixels", "ms, MiB", {{"ms", p.size, p.ms}, {"device MiB", p.size, p.device}}}});
  write_file_atomically(folder + "/scale.md", text);
  write_file_atomically(folder + "/scale.svg", svg);
  fmt::print("{}", text);
}

}  // namespace
}  // namespace understory

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: scale_table SCENE FOLDER\n");
    return 2;
  }
  try {
    understory::write_tables(arguments[1], arguments[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scale_table: %s\n", error.what());
    return 1;
  }
  return 0;
}
