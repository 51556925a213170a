// Height rasters (GeoTIFF, ESRI ASCII grid and what else GDAL opens) as a plain grid of metres.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/scene.hpp"

namespace understory {

inline constexpr std::uint64_t largest_raster_cells = 64'000'000;

/// Heights on a regular grid; the sample of cell (column, row) lies at its centre.
struct HeightRaster {
  std::uint32_t columns = 0, rows = 0;  // at least 2 each
  glm::dvec2 cell_size{1};              // m between samples along x (east) and y (north), positive
  glm::dvec2 first{0};                  // georeferenced x, y of the south-west sample, m
  std::vector<float> heights;           // m; columns * rows, row-major, southernmost row first (y up), finite
  std::uint64_t filled = 0;             // samples without data in the file, interpolated from their neighbours

  float at(std::uint32_t column, std::uint32_t row) const { return heights[std::size_t{row} * columns + column]; }
  /// Georeferenced rectangle from the first sample to the last.
  Region extent() const { return {first, first + cell_size * glm::dvec2(columns - 1, rows - 1)}; }
};

/// Reads the first band. Feet and other linear units become metres. Throws Error(invalid_input) naming the file:
/// missing, not a raster, too large, rotated, not georeferenced, in degrees instead of a linear unit, or without a
/// single height.
HeightRaster read_height_raster(const std::filesystem::path& file);

}  // namespace understory
