// Shared by image and geometry dumps.
#include "viz/vtk/field_data.hpp"

#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "viz/vtk/vtk_errors.hpp"

namespace understory {

void add_field_data(vtkDataSet* data, const GeometryInfo& info) {
  vtkNew<vtkDoubleArray> origin, time;
  origin->SetName("origin");
  origin->SetNumberOfComponents(3);
  origin->InsertNextTuple3(info.origin.x, info.origin.y, info.origin.z);
  time->SetName("TimeValue");
  time->InsertNextValue(info.time);
  vtkNew<vtkStringArray> surface, species;
  surface->SetName("owner_class");
  species->SetName("owner_species");
  vtkNew<vtkIntArray> instance;
  instance->SetName("owner_instance");
  for (const Owner& owner : info.owners) {
    surface->InsertNextValue(surface_class_name(owner.surface));
    species->InsertNextValue(owner.species.c_str());
    instance->InsertNextValue(owner.instance);
  }
  vtkFieldData* fields = data->GetFieldData();
  for (vtkAbstractArray* array : std::initializer_list<vtkAbstractArray*>{origin, time, surface, species, instance})
    fields->AddArray(array);
}

void write_vtk_xml(vtkXMLWriter* writer, vtkDataSet* data, const std::filesystem::path& path) {
  const VtkErrors errors(writer);
  const VtkErrors consequences(writer->GetExecutive());  // repeats the writer's errors; only kept from printing
  writer->SetInputData(data);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToLZ4();
  writer->SetCompressionLevel(1);
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    writer->SetFileName(temporary.c_str());
    const bool written = writer->Write() != 0;
    errors.rethrow(ErrorKind::input_output, path);
    if (!written || writer->GetErrorCode() != vtkErrorCode::NoError)
      throw Error(ErrorKind::input_output,
                  path.string() + ": cannot write: " + vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()));
  });
}

}  // namespace understory
