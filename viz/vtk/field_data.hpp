// Field data that every VTK dump carries: origin, time, owner table. For viz/vtk only.
#pragma once
#include <vtkDataSet.h>
#include <vtkXMLWriter.h>

#include <filesystem>

#include "viz/vtk/dumps.hpp"

namespace understory {

/// Adds `origin` (3 doubles), `TimeValue` (s; ParaView's name), `owner_class`, `owner_species`, `owner_instance`.
void add_field_data(vtkDataSet* data, const GeometryInfo& info);

/// Appended raw bytes, LZ4, under a temporary name. Throws Error(input_output).
void write_vtk_xml(vtkXMLWriter* writer, vtkDataSet* data, const std::filesystem::path& path);

}  // namespace understory
