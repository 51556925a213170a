// What a VTK object complains of, kept instead of printed. For viz/vtk only.
#pragma once
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkObject.h>

#include <filesystem>
#include <string>

#include "sim/error.hpp"

namespace understory {

/// Listens as long as it lives.
class VtkErrors {
 public:
  explicit VtkErrors(vtkObject* object);
  VtkErrors(const VtkErrors&) = delete;
  VtkErrors& operator=(const VtkErrors&) = delete;
  ~VtkErrors();
  /// Throws Error(kind) with the file's name when anything was said.
  void rethrow(ErrorKind kind, const std::filesystem::path& path) const;

 private:
  class Listener;
  vtkObject* object_;
  Listener* listener_;
  unsigned long tag_;
};

}  // namespace understory
