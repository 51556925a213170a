// Posed triangles as VTK poly data; our own vectors are lent to VTK where their layout allows.
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedIntArray.h>
#include <vtkXMLPolyDataWriter.h>

#include "viz/vtk/dumps.hpp"
#include "viz/vtk/field_data.hpp"

namespace understory {
namespace {

/// VTK takes mutable pointers; writing does not use that.
template <class T>
T* lent(const std::vector<T>& values) {
  return const_cast<T*>(values.data());
}

void set_points(vtkPolyData* data, const PosedGeometry& geometry) {
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetArray(lent(geometry.positions), static_cast<vtkIdType>(geometry.positions.size()), 1);
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  data->SetPoints(points);
}

void set_triangles(vtkPolyData* data, const PosedGeometry& geometry) {
  const auto count = static_cast<vtkIdType>(geometry.owner.size());
  vtkNew<vtkTypeInt32Array> offsets, corners;
  offsets->SetNumberOfValues(count + 1);
  for (vtkIdType i = 0; i <= count; ++i) offsets->SetValue(i, static_cast<std::int32_t>(3 * i));
  corners->SetNumberOfValues(3 * count);
  for (vtkIdType i = 0; i < 3 * count; ++i)
    corners->SetValue(i, static_cast<std::int32_t>(geometry.triangles[static_cast<std::size_t>(i)]));
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, corners);
  data->SetPolys(cells);
}

void set_owners(vtkPolyData* data, const PosedGeometry& geometry, const std::vector<Owner>& owners) {
  vtkNew<vtkUnsignedIntArray> owner;
  owner->SetName("owner");
  owner->SetArray(lent(geometry.owner), static_cast<vtkIdType>(geometry.owner.size()), 1);
  data->GetCellData()->SetScalars(owner);
  vtkNew<vtkUnsignedCharArray> surface;
  surface->SetName("surface");
  surface->SetNumberOfValues(static_cast<vtkIdType>(geometry.owner.size()));
  for (std::size_t i = 0; i < geometry.owner.size(); ++i)
    surface->SetValue(static_cast<vtkIdType>(i), static_cast<unsigned char>(owners.at(geometry.owner[i]).surface));
  data->GetCellData()->AddArray(surface);
}

}  // namespace

void write_poly_data(const std::filesystem::path& path, const PosedGeometry& geometry, const GeometryInfo& info) {
  vtkNew<vtkPolyData> data;
  set_points(data, geometry);
  set_triangles(data, geometry);
  set_owners(data, geometry, info.owners);
  add_field_data(data, info);
  vtkNew<vtkXMLPolyDataWriter> writer;
  write_vtk_xml(writer, data, path);
}

}  // namespace understory
