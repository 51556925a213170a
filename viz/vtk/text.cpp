// vtkTextRenderer gives an RGBA image with the bottom row first; it is blended over the picture.
#include "viz/vtk/text.hpp"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

namespace understory {
namespace {

void render(const std::string& text, int font_size, glm::u8vec3 colour, vtkImageData* image, int size[2]) {
  vtkNew<vtkTextProperty> property;
  property->SetFontFamilyToArial();
  property->SetFontSize(font_size);
  property->SetColor(colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
  property->SetVerticalJustificationToTop();
  vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
  renderer->SetScaleToPowerOfTwo(false);
  if (text.empty() || !renderer->RenderString(property.Get(), vtkStdString(text), image, size, 72))
    size[0] = size[1] = 0;
}

}  // namespace

glm::ivec2 text_size(const std::string& text, int font_size) {
  vtkNew<vtkImageData> image;
  int size[2];
  render(text, font_size, glm::u8vec3(0), image, size);
  return {size[0], size[1]};
}

void draw_text(Picture& picture, const std::string& text, int x, int y, int font_size, glm::u8vec3 colour) {
  vtkNew<vtkImageData> image;
  int size[2];
  render(text, font_size, colour, image, size);
  if (size[0] == 0) return;
  int dimensions[3];
  image->GetDimensions(dimensions);
  const auto* rgba = static_cast<const unsigned char*>(image->GetScalarPointer());
  for (int row = 0; row < size[1] && row < dimensions[1]; ++row)
    for (int column = 0; column < size[0] && column < dimensions[0]; ++column) {
      if (x + column < 0 || x + column >= picture.width || y + row < 0 || y + row >= picture.height) continue;
      const unsigned char* pixel = rgba + 4 * ((dimensions[1] - 1 - row) * dimensions[0] + column);
      const glm::vec3 below(picture.at(x + column, y + row)), above(pixel[0], pixel[1], pixel[2]);
      picture.set(x + column, y + row,
                  glm::u8vec3(glm::round(glm::mix(below, above, static_cast<float>(pixel[3]) / 255))));
    }
}

}  // namespace understory
