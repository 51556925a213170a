// Contact sheet, movie and time series of a run, made from the files of its frames.
#include <fmt/format.h>

#include <algorithm>

#include "host/app/frame_files.hpp"
#include "host/app/run_folder.hpp"
#include "viz/vtk/contact_sheet.hpp"
#include "viz/vtk/dumps.hpp"
#include "viz/vtk/movie.hpp"
#include "viz/vtk/png.hpp"

namespace understory {
namespace {

constexpr std::size_t sheet_cells = 24;
constexpr int sheet_columns = 4, sheet_picture_width = 240;

/// The two pictures of a frame: its PNG files, or made from its EXR file; none for a run without either.
std::vector<Picture> pictures_of(const std::filesystem::path& folder, const FrameRecord& frame) {
  const std::string picture = frame_file_name("frame", frame.index, "png");
  if (frame.files.contains(picture))
    return {read_png(folder / picture), read_png(folder / frame_file_name("visibility", frame.index, "png"))};
  const std::string planes = frame_file_name("frame", frame.index, "exr");
  if (!frame.files.contains(planes)) return {};
  FramePictures pictures;
  pictures.add(read_frame_exr(folder / planes));
  return {pictures.sky_lit(), pictures.visibility()};
}

/// Frames per second of the movie: that of the scene divided by the stride between frames.
double rate_of(const RunRecord& record, double scene_rate) {
  if (record.frames.size() < 2) return scene_rate;
  const double span = record.frames.rbegin()->second.time_s - record.frames.begin()->second.time_s;
  return static_cast<double>(record.frames.size() - 1) / span;
}

/// Nothing for a run without such files.
void write_time_series(const std::filesystem::path& folder, const RunRecord& record, const char* name,
                       const char* extension) {
  std::vector<SeriesEntry> entries;
  for (const auto& [index, frame] : record.frames)
    if (const std::string file = frame_file_name("frame", index, extension); frame.files.contains(file))
      entries.push_back({frame.time_s, file});
  if (!entries.empty()) write_series(folder / name, entries);
}

void write_pictures(const std::filesystem::path& folder, const RunRecord& record, double rate) {
  MovieWriter movie(folder / "movie.ogv", rate);
  std::vector<ContactCell> cells;
  const std::size_t stride = (record.frames.size() + sheet_cells - 1) / sheet_cells;
  std::size_t position = 0;
  for (const auto& [index, frame] : record.frames) {
    const std::vector<Picture> pictures = pictures_of(folder, frame);
    if (pictures.empty()) return;
    movie.add(pictures[0]);
    if (position++ % stride == 0)
      cells.push_back({shrink(pictures[0], std::min(sheet_picture_width, pictures[0].width)),
                       shrink(pictures[1], std::min(sheet_picture_width, pictures[1].width)),
                       fmt::format("frame {}, {:.3f} s", index, frame.time_s)});
  }
  movie.finish();
  write_png(folder / "contact_sheet.png", contact_sheet(cells, sheet_columns, sheet_picture_width));
}

}  // namespace

void write_products(const std::filesystem::path& folder, const RunRecord& record, const Scene& scene) {
  write_time_series(folder, record, "planes.pvd", "vti");
  write_time_series(folder, record, "geometry.pvd", "vtp");
  write_pictures(folder, record, rate_of(record, scene.time.frames_per_second));
}

}  // namespace understory
