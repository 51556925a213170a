#include "viz/vtk/grid_file.hpp"

#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSignedCharArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>

#include <cmath>

#include "sim/error.hpp"
#include "viz/vtk/field_data.hpp"
#include "viz/vtk/vtk_errors.hpp"

namespace understory {
namespace {

template <class Array, class Value>
void add_array(vtkImageData* image, const char* name, int components, std::size_t samples, const Value& value) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(samples));
  auto* to = array->GetPointer(0);
  for (std::size_t i = 0; i < samples; ++i)
    for (int c = 0; c < components; ++c) *to++ = static_cast<std::remove_reference_t<decltype(*to)>>(value(i, c));
  image->GetPointData()->AddArray(array);
}

void add_bytes(vtkImageData* image, const OcclusionGrid& grid) {
  if (!grid.has_direction()) {
    const std::vector<std::uint8_t> packed = packed_share(grid);
    add_array<vtkUnsignedCharArray>(image, "occlusion", 1, grid.samples(),
                                    [&](std::size_t i, int) { return packed[i]; });
    return;
  }
  const std::vector<std::uint8_t> packed = packed_cone(grid);
  add_array<vtkUnsignedCharArray>(image, "occlusion", 1, grid.samples(),
                                  [&](std::size_t i, int) { return packed[4 * i + 3]; });
  add_array<vtkSignedCharArray>(image, "direction", 3, grid.samples(), [&](std::size_t i, int c) {
    return static_cast<int>(packed[4 * i + static_cast<std::size_t>(c)]) - 128;
  });
}

void add_floats(vtkImageData* image, const OcclusionGrid& grid) {
  add_array<vtkFloatArray>(image, "occlusion", 1, grid.samples(), [&](std::size_t i, int) { return grid.share[i]; });
  if (grid.has_direction())
    add_array<vtkFloatArray>(image, "direction", 3, grid.samples(),
                             [&](std::size_t i, int c) { return grid.direction[i][c]; });
}

[[noreturn]] void refuse(const std::filesystem::path& path, const char* what) {
  throw Error(ErrorKind::invalid_input, path.string() + ": " + what + "; allowed: what `understory bake` wrote");
}

/// The array, of these components, as bytes or floats.
vtkDataArray* array_of(vtkImageData* image, const char* name, int components, std::size_t samples,
                       const std::filesystem::path& path) {
  vtkDataArray* array = image->GetPointData()->GetArray(name);
  if (!array || array->GetNumberOfComponents() != components ||
      array->GetNumberOfTuples() != static_cast<vtkIdType>(samples))
    refuse(path, "not an occlusion grid");
  return array;
}

}  // namespace

void write_grid(const std::filesystem::path& path, const OcclusionGrid& grid, GridEncoding encoding) {
  if (grid.stretch != 0)
    throw Error(ErrorKind::unexpected, path.string() + ": image data hold evenly spread samples only");
  vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(grid.size[0]), static_cast<int>(grid.size[1]), static_cast<int>(grid.size[2]));
  const glm::dvec3 cells(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
  const glm::dvec3 spacing = (glm::dvec3(grid.high) - glm::dvec3(grid.low)) / cells;
  image->SetOrigin(double(grid.low.x), double(grid.low.y), double(grid.low.z));
  image->SetSpacing(spacing.x, spacing.y, spacing.z);
  encoding == GridEncoding::bytes ? add_bytes(image, grid) : add_floats(image, grid);
  image->GetPointData()->SetActiveScalars("occlusion");
  vtkNew<vtkFloatArray> border;
  border->SetName("border");
  border->InsertNextValue(grid.border);
  image->GetFieldData()->AddArray(border);
  vtkNew<vtkXMLImageDataWriter> writer;
  write_vtk_xml(writer, image, path);
}

OcclusionGrid read_grid(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) refuse(path, "there is no such file");
  vtkNew<vtkXMLImageDataReader> reader;
  const VtkErrors errors(reader);
  if (!reader->CanReadFile(path.c_str())) refuse(path, "not VTK image data");
  reader->SetFileName(path.c_str());
  reader->Update();
  errors.rethrow(ErrorKind::invalid_input, path);
  vtkImageData* image = reader->GetOutput();
  OcclusionGrid grid;
  int size[3];
  image->GetDimensions(size);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (size[axis] < static_cast<int>(least_grid_size) || size[axis] > static_cast<int>(largest_grid_size))
      refuse(path, "not an occlusion grid by its size");
    grid.size[axis] = static_cast<std::uint32_t>(size[axis]);
    const int c = static_cast<int>(axis);
    grid.low[c] = static_cast<float>(image->GetOrigin()[c]);
    grid.high[c] = static_cast<float>(image->GetOrigin()[c] + image->GetSpacing()[c] * (size[axis] - 1));
  }
  vtkDataArray* share = array_of(image, "occlusion", 1, grid.samples(), path);
  const bool bytes = vtkUnsignedCharArray::SafeDownCast(share) != nullptr;
  for (std::size_t i = 0; i < grid.samples(); ++i)
    grid.share.push_back(static_cast<float>(share->GetComponent(static_cast<vtkIdType>(i), 0)) /
                         (bytes ? 255.0f : 1.0f));
  if (image->GetPointData()->HasArray("direction")) {
    vtkDataArray* direction = array_of(image, "direction", 3, grid.samples(), path);
    for (std::size_t i = 0; i < grid.samples(); ++i) {
      glm::vec3 d(0);
      for (int c = 0; c < 3; ++c)
        d[c] = static_cast<float>(direction->GetComponent(static_cast<vtkIdType>(i), c)) / (bytes ? 4 * 127.0f : 1.0f);
      grid.direction.push_back(d);
    }
  }
  if (vtkDataArray* border = image->GetFieldData()->GetArray("border"); border && border->GetNumberOfTuples() > 0)
    grid.border = static_cast<float>(border->GetComponent(0, 0));
  return grid;
}

}  // namespace understory
