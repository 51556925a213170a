// Occlusion grids as VTK image data, there and back.
#include "viz/vtk/grid_file.hpp"

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>

#include <fstream>

#include "sim/random.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

OcclusionGrid made_up(bool cone) {
  OcclusionGrid grid;
  grid.size = {5, 4, 3};
  grid.low = {-1, -2, 0.5f};
  grid.high = {1, 2, 3};
  grid.border = 0.125f;
  Random random(1, stream_of("grid file"));
  for (std::size_t i = 0; i < grid.samples(); ++i) {
    grid.share.push_back(static_cast<float>(random.uniform()));
    if (cone)
      grid.direction.emplace_back(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
  }
  return grid;
}

TEST(GridFile, KeepsFloatsAndRoundsBytes) {
  const TemporaryFolder folder;
  for (const bool cone : {false, true})
    for (const GridEncoding encoding : {GridEncoding::floats, GridEncoding::bytes}) {
      const OcclusionGrid grid = made_up(cone);
      write_grid(folder / "grid.vti", grid, encoding);
      const OcclusionGrid back = read_grid(folder / "grid.vti");
      const float share = encoding == GridEncoding::bytes ? 1 / 509.0f : 0,
                  direction = encoding == GridEncoding::bytes ? 1 / 1015.0f : 0;
      EXPECT_EQ(back.size, grid.size);
      EXPECT_EQ(back.border, grid.border);
      EXPECT_EQ(back.has_direction(), cone);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(back.low[axis], grid.low[axis], 1e-6f);
        EXPECT_NEAR(back.high[axis], grid.high[axis], 1e-6f);
      }
      for (std::size_t i = 0; i < grid.samples(); ++i) {
        EXPECT_NEAR(back.share[i], grid.share[i], share);
        for (int axis = 0; cone && axis < 3; ++axis)
          EXPECT_NEAR(back.direction[i][axis], grid.direction[i][axis], direction);
      }
    }
}

TEST(GridFile, IsImageDataForEverybody) {
  const TemporaryFolder folder;
  write_grid(folder / "grid.vti", made_up(true), GridEncoding::bytes);
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName((folder / "grid.vti").c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  EXPECT_EQ(image->GetNumberOfPoints(), 60);
  ASSERT_NE(image->GetPointData()->GetArray("occlusion"), nullptr);
  EXPECT_EQ(image->GetPointData()->GetArray("occlusion")->GetDataType(), VTK_UNSIGNED_CHAR);
  EXPECT_EQ(image->GetPointData()->GetArray("direction")->GetNumberOfComponents(), 3);
}

TEST(GridFile, RefusesOtherFiles) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& name) {
    return message_of(ErrorKind::invalid_input, [&] { read_grid(folder / name); });
  };
  EXPECT_NE(message("none.vti").find("there is no such file"), std::string::npos);
  std::ofstream(folder / "text.vti") << "not a grid";
  EXPECT_NE(message("text.vti").find("text.vti"), std::string::npos);
}

}  // namespace
}  // namespace understory
