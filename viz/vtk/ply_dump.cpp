// PLY and the ParaView series: a few lines of text and packed records, for which VTK has no writer (vtkPLYWriter knows
// no face properties, and there is none for .pvd).
#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "viz/vtk/dumps.hpp"

namespace understory {
namespace {

static_assert(std::endian::native == std::endian::little, "records are copied as they lie in memory");

/// A PLY comment ends with its line.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

std::string ply_header(const PosedGeometry& geometry, const GeometryInfo& info) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "comment units m, z up, relative to origin\n";
  header += fmt::format("comment origin {} {} {}\n", info.origin.x, info.origin.y, info.origin.z);
  header += fmt::format("comment time_s {}\n", info.time);
  for (std::size_t row = 0; row < info.owners.size(); ++row)
    header += fmt::format("comment owner {} {} {} {}\n", row, surface_class_name(info.owners[row].surface),
                          info.owners[row].instance, one_line(info.owners[row].species));
  header += fmt::format("element vertex {}\nproperty float x\nproperty float y\nproperty float z\n",
                        geometry.positions.size() / 3);
  header += fmt::format("element face {}\nproperty list uchar int vertex_indices\nproperty uint owner\nend_header\n",
                        geometry.owner.size());
  return header;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

}  // namespace

void write_ply(const std::filesystem::path& path, const PosedGeometry& geometry, const GeometryInfo& info) {
  if (geometry.triangles.size() != 3 * geometry.owner.size())
    throw Error(ErrorKind::unexpected, fmt::format("{}: {} corners and {} owners of triangles", path.string(),
                                                   geometry.triangles.size(), geometry.owner.size()));
  constexpr std::size_t face_bytes = 1 + 3 * 4 + 4;
  const std::string header = ply_header(geometry, info);
  const std::size_t position_bytes = geometry.positions.size() * sizeof(float);
  std::string bytes(header.size() + position_bytes + face_bytes * geometry.owner.size(), '\0');
  std::memcpy(bytes.data(), header.data(), header.size());
  char* at = bytes.data() + header.size();
  if (position_bytes > 0) std::memcpy(at, geometry.positions.data(), position_bytes);
  at += position_bytes;
  for (std::size_t face = 0; face < geometry.owner.size(); ++face, at += face_bytes) {
    *at = 3;
    std::memcpy(at + 1, &geometry.triangles[3 * face], 12);
    std::memcpy(at + 13, &geometry.owner[face], 4);
  }
  write_file_atomically(path, bytes);
}

void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const SeriesEntry& entry : entries)
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time, escaped(entry.file));
  text += "  </Collection>\n</VTKFile>\n";
  write_file_atomically(path, text);
}

}  // namespace understory
