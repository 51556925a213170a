// Between our pictures and VTK's images, whose first row is the bottom one. For viz/vtk only.
#pragma once
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include "viz/vtk/picture.hpp"

namespace understory {

/// Fills `image` with three unsigned char components; allocates when the size changes.
void copy_to_image(const Picture& picture, vtkImageData* image);
Picture picture_from_image(vtkImageData* image);

}  // namespace understory
