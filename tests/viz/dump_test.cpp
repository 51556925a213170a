// Dumps read back by VTK's own readers: same numbers, upright, with owners, origin and time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUtilities.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "sim/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viz/synthetic_frame.hpp"
#include "viz/vtk/dumps.hpp"

namespace understory {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A fan of 37 triangles; owners take turns.
PosedGeometry fan() {
  PosedGeometry geometry;
  geometry.positions = {0, 0, 0};
  for (int i = 0; i <= 37; ++i) {
    const float angle = 0.1f * static_cast<float>(i);
    for (const float value : {std::cos(angle), std::sin(angle), 0.01f * static_cast<float>(i)})
      geometry.positions.push_back(value);
    if (i == 0) continue;
    for (const int corner : {0, i, i + 1}) geometry.triangles.push_back(static_cast<std::uint32_t>(corner));
    geometry.owner.push_back(static_cast<std::uint32_t>(1 + i % 4));
  }
  return geometry;
}

GeometryInfo info_of(const Frame& frame) { return {frame.origin, frame.time, frame.owners}; }

void expect_field_data(vtkFieldData* fields, const Frame& frame) {
  ASSERT_NE(fields->GetArray("origin"), nullptr);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(fields->GetArray("origin")->GetComponent(0, axis), frame.origin[axis]);
  ASSERT_NE(fields->GetArray("TimeValue"), nullptr);
  EXPECT_EQ(fields->GetArray("TimeValue")->GetComponent(0, 0), frame.time);
  auto* species = vtkStringArray::SafeDownCast(fields->GetAbstractArray("owner_species"));
  ASSERT_NE(species, nullptr);
  ASSERT_EQ(species->GetNumberOfValues(), static_cast<vtkIdType>(frame.owners.size()));
  EXPECT_EQ(std::string(species->GetValue(2).c_str()), frame.owners[2].species);
}

TEST(ImageDump, HoldsEveryPlaneUpright) {
  const TemporaryFolder folder;
  const Frame frame = synthetic_frame(53, 31, 0.4);
  write_image_data(folder / "frame.vti", frame);
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName((folder / "frame.vti").c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  int dimensions[3];
  image->GetDimensions(dimensions);
  EXPECT_THAT(dimensions, testing::ElementsAre(53, 31, 1));
  vtkPointData* points = image->GetPointData();
  for (const char* name : {"visibility", "open-dome", "solid-angle", "depth", "owner", "validity", "normal", "position",
                           "height_above_root"})
    ASSERT_NE(points->GetArray(name), nullptr) << name;
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 53; ++x) {
      const auto i = static_cast<std::size_t>(y * 53 + x);
      const vtkIdType tuple = (30 - y) * 53 + x;
      ASSERT_EQ(points->GetArray("visibility")->GetComponent(tuple, 0), frame.visibility[i]);
      ASSERT_EQ(points->GetArray("depth")->GetComponent(tuple, 0), frame.depth[i]);
      ASSERT_EQ(points->GetArray("owner")->GetComponent(tuple, 0), frame.owner[i]);
      ASSERT_EQ(points->GetArray("position")->GetComponent(tuple, 1), frame.position[1][i]);
      ASSERT_EQ(points->GetArray("normal")->GetComponent(tuple, 2), frame.normal[2][i]);
    }
  expect_field_data(image->GetFieldData(), frame);
}

TEST(GeometryDump, HoldsTrianglesAndOwners) {
  const TemporaryFolder folder;
  const PosedGeometry geometry = fan();
  const Frame frame = synthetic_frame(4, 4);
  write_poly_data(folder / "frame.vtp", geometry, info_of(frame));
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder / "frame.vtp").c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  ASSERT_EQ(data->GetNumberOfPolys(), 37);
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < 37; ++cell) {
    data->GetCellPoints(cell, corners);
    ASSERT_EQ(corners->GetNumberOfIds(), 3);
    for (vtkIdType corner = 0; corner < 3; ++corner)
      EXPECT_EQ(corners->GetId(corner), geometry.triangles[static_cast<std::size_t>(3 * cell + corner)]);
    const std::uint32_t owner = geometry.owner[static_cast<std::size_t>(cell)];
    EXPECT_EQ(data->GetCellData()->GetArray("owner")->GetComponent(cell, 0), owner);
    EXPECT_EQ(data->GetCellData()->GetArray("surface")->GetComponent(cell, 0),
              static_cast<double>(frame.owners[owner].surface));
  }
  double point[3];
  data->GetPoint(17, point);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(point[axis], geometry.positions[3 * 17 + axis]);
  expect_field_data(data->GetFieldData(), frame);
}

TEST(GeometryDump, SameGeometrySameBytes) {
  const TemporaryFolder folder;
  const GeometryInfo info = info_of(synthetic_frame(4, 4));
  for (const std::string name : {"a", "b"}) {
    write_poly_data(folder / (name + ".vtp"), fan(), info);
    write_image_data(folder / (name + ".vti"), synthetic_frame(19, 11));
    write_ply(folder / (name + ".ply"), fan(), info);
  }
  for (const std::string extension : {".vtp", ".vti", ".ply"})
    EXPECT_EQ(bytes_of(folder / ("a" + extension)), bytes_of(folder / ("b" + extension))) << extension;
}

TEST(PlyDump, IsReadByVtkAndHasOwnersPerFace) {
  const TemporaryFolder folder;
  const PosedGeometry geometry = fan();
  write_ply(folder / "frame.ply", geometry, info_of(synthetic_frame(4, 4)));
  vtkNew<vtkPLYReader> reader;
  reader->SetFileName((folder / "frame.ply").c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  ASSERT_EQ(data->GetNumberOfPolys(), 37);
  ASSERT_EQ(data->GetNumberOfPoints(), static_cast<vtkIdType>(geometry.positions.size() / 3));
  vtkNew<vtkIdList> corners;
  data->GetCellPoints(36, corners);
  EXPECT_EQ(corners->GetId(2), 38);

  const std::string bytes = bytes_of(folder / "frame.ply");
  EXPECT_THAT(bytes, testing::HasSubstr("comment origin 691234.5 5335678.25 512\n"));
  EXPECT_THAT(bytes, testing::HasSubstr("comment owner 2 leaf 1 broad \"leaf\"\n"));
  const std::size_t faces = bytes.find("end_header\n") + 11 + geometry.positions.size() * 4;
  ASSERT_EQ(bytes.size(), faces + 17 * geometry.owner.size());
  for (std::size_t face = 0; face < geometry.owner.size(); ++face) {
    std::uint32_t owner = 0;
    std::memcpy(&owner, bytes.data() + faces + 17 * face + 13, 4);
    EXPECT_EQ(owner, geometry.owner[face]);
  }
}

TEST(Series, NamesFilesAndTimes) {
  const TemporaryFolder folder;
  write_series(folder / "frames.pvd", {{0, "frame_0000.vtp"}, {0.1, "a<&\">/frame_0001.vtp"}});
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile((folder / "frames.pvd").c_str()));
  ASSERT_NE(root, nullptr);
  vtkXMLDataElement* collection = root->FindNestedElementWithName("Collection");
  ASSERT_NE(collection, nullptr);
  ASSERT_EQ(collection->GetNumberOfNestedElements(), 2);
  EXPECT_STREQ(collection->GetNestedElement(0)->GetAttribute("file"), "frame_0000.vtp");
  EXPECT_STREQ(collection->GetNestedElement(1)->GetAttribute("file"), "a<&\">/frame_0001.vtp");
  double time = 0;
  ASSERT_TRUE(collection->GetNestedElement(1)->GetScalarAttribute("timestep", time));
  EXPECT_EQ(time, 0.1);
}

TEST(Dumps, AnUnwritableFolderIsOneError) {
  const TemporaryFolder folder;
  const GeometryInfo info = info_of(synthetic_frame(4, 4));
  const auto kind_of = [](auto call) {
    try {
      call();
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::unexpected;
  };
  testing::internal::CaptureStderr();
  EXPECT_EQ(kind_of([&] { write_poly_data(folder / "missing/a.vtp", fan(), info); }), ErrorKind::input_output);
  EXPECT_EQ(kind_of([&] { write_image_data(folder / "missing/a.vti", synthetic_frame(5, 5)); }),
            ErrorKind::input_output);
  EXPECT_EQ(kind_of([&] { write_ply(folder / "missing/a.ply", fan(), info); }), ErrorKind::input_output);
  EXPECT_EQ(kind_of([&] { write_series(folder / "missing/a.pvd", {}); }), ErrorKind::input_output);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Dumps, AFullDiskIsOneErrorAndKeepsTheOldFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const TemporaryFolder folder;
  std::ofstream(folder / "a.vtp") << "old";
  // The temporary name of this process leads to a device that is always full.
  std::filesystem::create_symlink("/dev/full", folder / (".a.tmp-" + std::to_string(::getpid()) + ".vtp"));
  testing::internal::CaptureStderr();
  try {
    write_poly_data(folder / "a.vtp", fan(), info_of(synthetic_frame(4, 4)));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input_output);
    EXPECT_THAT(error.what(), testing::HasSubstr("a.vtp"));
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(bytes_of(folder / "a.vtp"), "old");
}

}  // namespace
}  // namespace understory
