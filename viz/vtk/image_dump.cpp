// A frame's planes as VTK image data. VTK counts rows from the bottom, so they are turned over.
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedIntArray.h>
#include <vtkXMLImageDataWriter.h>

#include <array>
#include <span>

#include "viz/vtk/dumps.hpp"
#include "viz/vtk/field_data.hpp"

namespace understory {
namespace {

/// One VTK array whose components are planes of the frame.
template <class Array, class T>
void add_planes(vtkImageData* image, const std::string& name, std::span<const std::vector<T>* const> planes) {
  int dimensions[3];
  image->GetDimensions(dimensions);
  const auto width = static_cast<std::size_t>(dimensions[0]), height = static_cast<std::size_t>(dimensions[1]);
  vtkNew<Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(static_cast<int>(planes.size()));
  array->SetNumberOfTuples(static_cast<vtkIdType>(width * height));
  T* value = array->GetPointer(0);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      for (const auto* plane : planes) *value++ = (*plane)[(height - 1 - y) * width + x];
  image->GetPointData()->AddArray(array);
}

void add_float(vtkImageData* image, const std::string& name, const Plane& plane) {
  const std::array<const Plane*, 1> planes{&plane};
  if (!plane.empty()) add_planes<vtkFloatArray, float>(image, name, planes);
}

void add_vector(vtkImageData* image, const std::string& name, const std::array<Plane, 3>& vector) {
  const std::array<const Plane*, 3> planes{&vector[0], &vector[1], &vector[2]};
  add_planes<vtkFloatArray, float>(image, name, planes);
}

void add_integer(vtkImageData* image, const std::string& name, const std::vector<std::uint32_t>& plane) {
  const std::array<const std::vector<std::uint32_t>*, 1> planes{&plane};
  add_planes<vtkUnsignedIntArray, std::uint32_t>(image, name, planes);
}

}  // namespace

void write_image_data(const std::filesystem::path& path, const Frame& frame) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(frame.width, frame.height, 1);
  add_float(image, "visibility", frame.visibility);
  for (const auto& [method, plane] : frame.terms) add_float(image, method, plane);
  add_float(image, "depth", frame.depth);
  add_float(image, "height_above_root", frame.height_above_root);
  add_integer(image, "owner", frame.owner);
  add_integer(image, "validity", frame.validity);
  add_vector(image, "normal", frame.normal);
  add_vector(image, "position", frame.position);
  image->GetPointData()->SetActiveScalars("visibility");
  add_field_data(image, {frame.origin, frame.time, frame.owners});
  vtkNew<vtkXMLImageDataWriter> writer;
  write_vtk_xml(writer, image, path);
}

}  // namespace understory
