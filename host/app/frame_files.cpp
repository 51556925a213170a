// Writes what a frame is dumped to, and hashes it.
#include "host/app/frame_files.hpp"

#include <algorithm>

#include "host/app/checksum.hpp"
#include "host/app/run_folder.hpp"
#include "viz/vtk/dumps.hpp"
#include "viz/vtk/png.hpp"

namespace understory {
namespace {

std::map<std::uint32_t, std::uint64_t> count_flags(const std::vector<std::uint32_t>& validity) {
  std::map<std::uint32_t, std::uint64_t> counts;
  for (std::uint32_t flags : validity)
    for (; flags != 0; flags &= flags - 1) ++counts[flags & (~flags + 1)];  // lowest bit first
  return counts;
}

}  // namespace

FrameFiles::FrameFiles(const std::filesystem::path& folder, const RunRecord& record, const Methods& methods)
    : folder_(folder),
      dumps_(record.dumps),
      supersample_(record.supersample),
      attributes_{record.seed, methods, record.scene_sha256, "", "", ""} {}

bool FrameFiles::dumps(const char* format) const {
  return std::find(dumps_.begin(), dumps_.end(), format) != dumps_.end();
}

void FrameFiles::compute(FrameRunner& runner, int index, double time, FrameOutput& output) const {
  output.frame = runner.render(index, time);
  if (dumps("vtk") || dumps("ply")) output.geometry = runner.posed_geometry();
  if (!dumps("png") || supersample_ == 1) return;
  Frame sample;
  for (int row = 0; row < supersample_; ++row)
    for (int column = 0; column < supersample_; ++column) {
      const glm::dvec2 offset = (glm::dvec2(column, row) + 0.5) / double(supersample_) - 0.5;
      runner.render(sample, index, time, offset);
      for (const auto& [pass, ms] : sample.pass_ms) output.frame.pass_ms[pass] += ms;
      output.samples.add(sample);
    }
}

FrameRecord FrameFiles::write(const FrameOutput& output) const {
  const Frame& frame = output.frame;
  FrameRecord record;
  record.index = frame.index;
  record.time_s = frame.time;
  record.passes = frame.pass_ms;
  record.validity = count_flags(frame.validity);
  record.chosen = output.chosen;
  ExrAttributes attributes = attributes_;
  if (!output.chosen.empty()) {
    attributes.methods = output.methods;
    attributes.adaptive = output.chosen;
  }
  const auto write_one = [&](const char* stem, const char* extension, auto write) {
    const std::string name = frame_file_name(stem, frame.index, extension);
    write(folder_ / name);
    record.files[name] = sha256_of_file(folder_ / name);
    if (record.sha256.empty()) record.sha256 = record.files[name];
  };
  if (dumps("exr")) write_one("frame", "exr", [&](const auto& path) { write_frame_exr(path, frame, attributes); });
  if (dumps("png")) {
    FramePictures pictures = output.samples;
    if (supersample_ == 1) pictures.add(frame);
    write_one("frame", "png", [&](const auto& path) { write_png(path, pictures.sky_lit()); });
    write_one("visibility", "png", [&](const auto& path) { write_png(path, pictures.visibility()); });
  }
  const GeometryInfo geometry{frame.origin, frame.time, frame.owners};
  if (dumps("vtk")) {
    write_one("frame", "vti", [&](const auto& path) { write_image_data(path, frame); });
    write_one("frame", "vtp", [&](const auto& path) { write_poly_data(path, output.geometry, geometry); });
  }
  if (dumps("ply")) write_one("frame", "ply", [&](const auto& path) { write_ply(path, output.geometry, geometry); });
  return record;
}

}  // namespace understory
