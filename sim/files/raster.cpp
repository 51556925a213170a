// Height rasters through GDAL, checked for what a terrain needs: metres, north up, finite heights.
#include "sim/files/raster.hpp"

#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>

#include "sim/error.hpp"
#include "sim/files/text.hpp"

namespace understory {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorKind::invalid_input, file.string() + ": " + what);
}

/// GDAL's own messages go nowhere while this lives; the last one is still there for ours.
struct QuietGdal {
  QuietGdal() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

GDALDatasetUniquePtr open(const std::filesystem::path& file) {
  std::error_code failure;
  if (!std::filesystem::exists(file, failure)) refuse(file, "there is no such raster file");
  if (!std::filesystem::is_regular_file(file, failure)) refuse(file, "not a file");
  GDALAllRegister();
  GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset) refuse(file, "not a raster that GDAL reads: " + readable(CPLGetLastErrorMsg()));
  if (dataset->GetRasterCount() == 0) refuse(file, "the raster has no band");
  return dataset;
}

/// Metres per horizontal unit of the raster; 1 if it names no unit.
double metres_per_unit(const std::filesystem::path& file, const GDALDataset& dataset) {
  const OGRSpatialReference* reference = dataset.GetSpatialRef();
  if (!reference) return 1;
  if (reference->IsGeographic()) {
    refuse(file, "its coordinates are in degrees: allowed is a projected raster (gdalwarp -t_srs EPSG:... makes one)");
  }
  return reference->GetLinearUnits();
}

/// Metres per unit of height: GDAL names feet in several ways.
double metres_per_height(const GDALRasterBand& band) {
  const std::string unit = const_cast<GDALRasterBand&>(band).GetUnitType();
  if (matches_pattern(unit, "*us*f*t*")) return 1200.0 / 3937.0;  // US survey foot
  return matches_pattern(unit, "f*t*") ? 0.3048 : 1;
}

void place(const std::filesystem::path& file, GDALDataset& dataset, HeightRaster& raster) {
  double t[6];  // x = t0 + column t1 + row t2; y = t3 + column t4 + row t5
  if (dataset.GetGeoTransform(t) != CE_None) {
    refuse(file, "not georeferenced, so its cell size is unknown (gdal_translate -a_ullr adds it)");
  }
  if (t[2] != 0 || t[4] != 0 || !(t[1] > 0) || t[5] == 0 || !std::isfinite(t[0] + t[1] + t[3] + t[5])) {
    refuse(file, "rotated or mirrored: allowed is a raster with north up (gdalwarp makes one)");
  }
  const double unit = metres_per_unit(file, dataset);
  raster.cell_size = glm::dvec2(t[1], std::abs(t[5])) * unit;
  const double south = t[5] < 0 ? t[3] + t[5] * raster.rows : t[3];
  raster.first = glm::dvec2(t[0], south) * unit + 0.5 * raster.cell_size;
  raster.heights.resize(std::size_t{raster.columns} * raster.rows);
  // A negative line step puts a raster that starts in the north upside down, as y wants it.
  const bool from_north = t[5] < 0;
  const GSpacing line = static_cast<GSpacing>(raster.columns) * static_cast<GSpacing>(sizeof(float));
  float* start = raster.heights.data() + (from_north ? std::size_t{raster.columns} * (raster.rows - 1) : 0);
  const CPLErr failure =
      dataset.GetRasterBand(1)->RasterIO(GF_Read, 0, 0, static_cast<int>(raster.columns), static_cast<int>(raster.rows),
                                         start, static_cast<int>(raster.columns), static_cast<int>(raster.rows),
                                         GDT_Float32, sizeof(float), from_north ? -line : line, nullptr);
  if (failure != CE_None) refuse(file, "cannot be read to its end: " + readable(CPLGetLastErrorMsg()));
}

/// Cells without data get the mean of the neighbours that have some, ring after ring.
void fill_gaps(const std::filesystem::path& file, HeightRaster& raster) {
  const auto columns = static_cast<std::ptrdiff_t>(raster.columns), rows = static_cast<std::ptrdiff_t>(raster.rows);
  std::vector<std::ptrdiff_t> gaps;
  for (std::ptrdiff_t i = 0; i < columns * rows; ++i) {
    if (!std::isfinite(raster.heights[i])) gaps.push_back(i);
  }
  raster.filled = gaps.size();
  if (gaps.size() == raster.heights.size()) refuse(file, "without a single height: all cells are no-data");
  while (!gaps.empty()) {
    std::vector<std::pair<std::ptrdiff_t, float>> found;
    std::vector<std::ptrdiff_t> open;
    for (const std::ptrdiff_t gap : gaps) {
      double sum = 0;
      int count = 0;
      for (std::ptrdiff_t row = std::max<std::ptrdiff_t>(gap / columns - 1, 0);
           row <= std::min(gap / columns + 1, rows - 1); ++row) {
        for (std::ptrdiff_t column = std::max<std::ptrdiff_t>(gap % columns - 1, 0);
             column <= std::min(gap % columns + 1, columns - 1); ++column) {
          const float height = raster.heights[row * columns + column];
          if (std::isfinite(height)) sum += height, ++count;
        }
      }
      if (count) {
        found.emplace_back(gap, static_cast<float>(sum / count));
      } else {
        open.push_back(gap);
      }
    }
    for (const auto& [gap, height] : found) raster.heights[gap] = height;
    gaps = std::move(open);
  }
}

}  // namespace

HeightRaster read_height_raster(const std::filesystem::path& file) {
  const QuietGdal quiet;
  const GDALDatasetUniquePtr dataset = open(file);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  const int columns = band.GetXSize(), rows = band.GetYSize();
  if (columns < 2 || rows < 2 || std::uint64_t(columns) * std::uint64_t(rows) > largest_raster_cells) {
    refuse(file, fmt::format("{} x {} cells: allowed are 2 x 2 to {} in all", columns, rows, largest_raster_cells));
  }
  HeightRaster raster;
  raster.columns = static_cast<std::uint32_t>(columns);
  raster.rows = static_cast<std::uint32_t>(rows);
  place(file, *dataset, raster);

  int has_no_data = 0;
  const auto no_data = static_cast<float>(band.GetNoDataValue(&has_no_data));
  const double metres = metres_per_height(band), scale = band.GetScale() * metres, offset = band.GetOffset() * metres;
  for (float& height : raster.heights) {
    const bool missing = !std::isfinite(height) || (has_no_data && height == no_data);
    height = missing ? NAN : static_cast<float>(height * scale + offset);
  }
  fill_gaps(file, raster);
  return raster;
}

}  // namespace understory
