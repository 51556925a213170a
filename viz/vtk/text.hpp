// Words on pictures, set by VTK's FreeType renderer without any window.
#pragma once
#include <string>

#include "viz/vtk/picture.hpp"

namespace understory {

/// Pixels that `text` (one line) covers at a font size in pixels.
glm::ivec2 text_size(const std::string& text, int font_size);

/// Draws one line with its upper left corner at (x, y); what lies outside the picture is cut off.
void draw_text(Picture& picture, const std::string& text, int x, int y, int font_size, glm::u8vec3 colour);

}  // namespace understory
