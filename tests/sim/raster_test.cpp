// Height rasters: north is up whichever way the file runs, gaps are filled, and what is no terrain is refused.
#include "sim/files/raster.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <random>

#include "tests/support/errors.hpp"
#include "tests/support/temporary_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string grid =
    "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n1 2 3\n4 5 6\n";

HeightRaster read_text(const std::string& text, const std::string& name = "ground.asc") {
  return read_height_raster(TemporaryFile(name, text).path());
}

std::string refusal(const std::string& text, const std::string& name = "ground.asc") {
  return message_of(ErrorKind::invalid_input, [&] { read_text(text, name); });
}

/// A GeoTIFF of 3 x 2 heights 1..6 from the north, of 2 m cells, with the edits that a test makes.
template <class Edit>
std::filesystem::path geotiff(const TemporaryFolder& folder, Edit edit) {
  GDALAllRegister();
  const std::filesystem::path file = folder / "ground.tif";
  GDALDatasetUniquePtr dataset(
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), 3, 2, 1, GDT_Float64, nullptr));
  double corner[6] = {1000, 2, 0, 5000, 0, -2};
  dataset->SetGeoTransform(corner);
  double heights[6] = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 3, 2, heights, 3, 2, GDT_Float64, 0, 0, nullptr),
            CE_None);
  edit(*dataset);
  return file;
}

TEST(Raster, ReadsAnAsciiGridWithYUp) {
  const HeightRaster raster = read_text(grid);
  EXPECT_EQ(raster.columns, 3u);
  EXPECT_EQ(raster.rows, 2u);
  EXPECT_EQ(raster.cell_size, glm::dvec2(10, 10));
  EXPECT_EQ(raster.first, glm::dvec2(105, 205));  // the centre of the south-west cell
  EXPECT_EQ(raster.extent().high, glm::dvec2(125, 215));
  EXPECT_THAT(raster.heights, testing::ElementsAre(4, 5, 6, 1, 2, 3));
  EXPECT_EQ(raster.at(2, 1), 3);
  EXPECT_EQ(raster.filled, 0u);
}

TEST(Raster, FillsGapsFromTheirNeighbours) {
  const HeightRaster raster = read_text(
      "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 1 1\n1 -9999 3\n3 3 3\n");
  EXPECT_EQ(raster.filled, 1u);
  EXPECT_FLOAT_EQ(raster.at(1, 1), 2);  // the mean of 4 ones and 4 threes

  std::string wide = "ncols 40\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
  for (int i = 0; i < 80; ++i) wide += i == 7 ? "5 " : "-9999 ";
  const HeightRaster spread = read_text(wide);
  EXPECT_EQ(spread.filled, 79u);
  for (const float height : spread.heights) EXPECT_EQ(height, 5);
}

TEST(Raster, ReadsGeotiffsFromEitherEnd) {
  const TemporaryFolder folder;
  const HeightRaster north_first = read_height_raster(geotiff(folder, [](GDALDataset&) {}));
  EXPECT_EQ(north_first.first, glm::dvec2(1001, 4997));
  EXPECT_THAT(north_first.heights, testing::ElementsAre(4, 5, 6, 1, 2, 3));
  const HeightRaster south_first = read_height_raster(geotiff(folder, [](GDALDataset& dataset) {
    double corner[6] = {1000, 2, 0, 4996, 0, 2};
    dataset.SetGeoTransform(corner);
  }));
  EXPECT_EQ(south_first.first, glm::dvec2(1001, 4997));
  EXPECT_THAT(south_first.heights, testing::ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(Raster, TurnsFeetIntoMetres) {
  const TemporaryFolder folder;
  const HeightRaster raster = read_height_raster(geotiff(folder, [](GDALDataset& dataset) {
    OGRSpatialReference reference;
    reference.SetProjCS("local");
    reference.SetTM(0, 0, 1, 0, 0);
    reference.SetLinearUnits("foot", 0.3048);
    dataset.SetSpatialRef(&reference);
    dataset.GetRasterBand(1)->SetUnitType("ft");
  }));
  EXPECT_NEAR(raster.cell_size.x, 0.6096, 1e-9);
  EXPECT_NEAR(raster.at(0, 0), 4 * 0.3048, 1e-6);
}

TEST(Raster, SaysWhatIsWrong) {
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [] { read_height_raster("/no/such.tif"); }),
              HasSubstr("/no/such.tif: there is no such raster file"));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [] { read_height_raster("/tmp"); }), HasSubstr("not a file"));
  EXPECT_THAT(refusal("any text\n", "ground.tif"), AllOf(HasSubstr("ground.tif"), HasSubstr("not a raster")));
  EXPECT_THAT(refusal("ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n2\n"),
              HasSubstr("1 x 2 cells: allowed are 2 x 2"));
  EXPECT_THAT(refusal("ncols 100000\nnrows 100000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n"),
              HasSubstr("100000 x 100000 cells"));
  EXPECT_THAT(refusal("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value 7\n7 7\n7 7\n"),
              HasSubstr("without a single height"));
  EXPECT_THAT(refusal("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 5"),
              HasSubstr("cannot be read to its end"));

  const TemporaryFolder folder;
  const auto refused = [&](auto edit) {
    const std::filesystem::path file = geotiff(folder, edit);
    return message_of(ErrorKind::invalid_input, [&] { read_height_raster(file); });
  };
  EXPECT_THAT(refused([](GDALDataset& dataset) {
                OGRSpatialReference degrees;
                degrees.SetWellKnownGeogCS("WGS84");
                dataset.SetSpatialRef(&degrees);
              }),
              AllOf(HasSubstr("in degrees"), HasSubstr("gdalwarp")));
  EXPECT_THAT(refused([](GDALDataset& dataset) {
                double corner[6] = {1000, 2, 0.5, 5000, 0.5, -2};
                dataset.SetGeoTransform(corner);
              }),
              HasSubstr("rotated"));
}

TEST(Raster, RefusesWhatHasNoGeoreference) {
  const TemporaryFolder folder;
  GDALAllRegister();
  const std::filesystem::path file = folder / "plain.tif";
  GDALDatasetUniquePtr(
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), 3, 2, 1, GDT_Float32, nullptr));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { read_height_raster(file); }), HasSubstr("not georeferenced"));
}

TEST(Raster, SurvivesDamage) {
  std::mt19937 random(2);
  for (int round = 0; round < 300; ++round) {
    std::string damaged = grid.substr(0, round % 2 ? grid.size() : random() % grid.size());
    for (int k = 0; k < 2 && !damaged.empty(); ++k)
      damaged[random() % damaged.size()] = "0123456789-. \nnx"[random() % 16];
    try {
      for (const float height : read_text(damaged).heights) EXPECT_TRUE(std::isfinite(height));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_input) << error.what();
    }
  }
}

}  // namespace
}  // namespace understory
