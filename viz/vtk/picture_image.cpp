// Row by row, upside down.
#include "viz/vtk/picture_image.hpp"

#include <algorithm>

namespace understory {

void copy_to_image(const Picture& picture, vtkImageData* image) {
  int dimensions[3];
  image->GetDimensions(dimensions);
  if (dimensions[0] != picture.width || dimensions[1] != picture.height ||
      image->GetScalarType() != VTK_UNSIGNED_CHAR || image->GetNumberOfScalarComponents() != 3) {
    image->SetDimensions(picture.width, picture.height, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  }
  auto* target = static_cast<unsigned char*>(image->GetScalarPointer());
  const std::ptrdiff_t stride = 3 * std::ptrdiff_t{picture.width};
  for (int row = 0; row < picture.height; ++row) {
    const auto from = picture.rgb.begin() + row * stride;
    std::copy(from, from + stride, target + (picture.height - 1 - row) * stride);
  }
  image->Modified();
}

Picture picture_from_image(vtkImageData* image) {
  int dimensions[3];
  image->GetDimensions(dimensions);
  const int components = image->GetNumberOfScalarComponents();
  const auto* source = static_cast<const unsigned char*>(image->GetScalarPointer());
  Picture picture(dimensions[0], dimensions[1], glm::u8vec3(0));
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const unsigned char* pixel = source + components * (std::ptrdiff_t{picture.height - 1 - y} * picture.width + x);
      picture.set(x, y, components < 3 ? glm::u8vec3(pixel[0]) : glm::u8vec3(pixel[0], pixel[1], pixel[2]));
    }
  return picture;
}

}  // namespace understory
