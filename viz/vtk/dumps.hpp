// Frames and posed geometry as files for ParaView, VTK and mesh tools. All appear whole or not at all.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "sim/frame.hpp"

namespace understory {

/// What the files say beside the triangles.
struct GeometryInfo {
  glm::dvec3 origin{0};       // world coordinates of the positions' zero
  double time = 0;            // s
  std::vector<Owner> owners;  // what `PosedGeometry::owner` indexes
};

/// Image data (.vti), one point per pixel, x to the right and y up: visibility, terms, depth, owner, validity, normal,
/// position, height_above_root; field data origin, TimeValue and the owner table. LZ4.
void write_image_data(const std::filesystem::path& path, const Frame& frame);

/// Poly data (.vtp), float positions relative to the origin; cell data owner and surface; field data as above. LZ4.
void write_poly_data(const std::filesystem::path& path, const PosedGeometry& geometry, const GeometryInfo& info);

/// Binary little-endian PLY: float x y z; faces of three with `uint owner`. Comments hold origin, time and owners.
void write_ply(const std::filesystem::path& path, const PosedGeometry& geometry, const GeometryInfo& info);

/// One file of a time series; `file` is relative to the series' folder.
struct SeriesEntry {
  double time = 0;  // s
  std::string file;
};

/// ParaView's collection (.pvd): opening it opens all frames with their times.
void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries);

}  // namespace understory
