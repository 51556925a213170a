// PNG is made in memory, so that a full disk is our error and not a message on the terminal.
#include "viz/vtk/png.hpp"

#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <string_view>

#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "viz/vtk/picture_image.hpp"
#include "viz/vtk/vtk_errors.hpp"

namespace understory {

void write_png(const std::filesystem::path& path, const Picture& picture) {
  if (picture.width < 1 || picture.height < 1)
    throw Error(ErrorKind::unexpected, path.string() + ": a picture without pixels cannot be written");
  vtkNew<vtkImageData> image;
  copy_to_image(picture, image);
  vtkNew<vtkPNGWriter> writer;
  const VtkErrors errors(writer);
  writer->SetInputData(image);
  writer->SetWriteToMemory(true);
  writer->Write();
  errors.rethrow(ErrorKind::input_output, path);
  vtkUnsignedCharArray* bytes = writer->GetResult();
  write_file_atomically(path, {reinterpret_cast<const char*>(bytes->GetPointer(0)),
                               static_cast<std::size_t>(bytes->GetNumberOfValues())});
}

Picture read_png(const std::filesystem::path& path) {
  vtkNew<vtkPNGReader> reader;
  const VtkErrors errors(reader);
  if (!std::filesystem::exists(path)) throw Error(ErrorKind::invalid_input, path.string() + ": no such file");
  if (!reader->CanReadFile(path.c_str())) throw Error(ErrorKind::invalid_input, path.string() + ": no PNG file");
  reader->SetFileName(path.c_str());
  reader->Update();
  errors.rethrow(ErrorKind::invalid_input, path);
  if (reader->GetOutput()->GetScalarType() != VTK_UNSIGNED_CHAR)
    throw Error(ErrorKind::invalid_input, path.string() + ": only 8-bit PNG is read");
  return picture_from_image(reader->GetOutput());
}

}  // namespace understory
