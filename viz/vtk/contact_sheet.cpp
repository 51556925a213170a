// Cells of equal size on a dark page.
#include "viz/vtk/contact_sheet.hpp"

#include <algorithm>

#include "viz/vtk/text.hpp"

namespace understory {

Picture contact_sheet(const std::vector<ContactCell>& cells, int columns, int picture_width) {
  constexpr glm::u8vec3 page(32), caption_colour(220);
  constexpr int gap = 10, caption_height = 22, font_size = 13;
  std::vector<Picture> pairs;
  int width = 1, height = 1;
  for (const ContactCell& cell : cells) {
    const Picture left = shrink(cell.left, picture_width);
    pairs.push_back(side_by_side(left, shrink(cell.right, cell.right.width * left.height / cell.right.height)));
    width = std::max(width, pairs.back().width);
    height = std::max(height, pairs.back().height);
  }
  const int count = static_cast<int>(cells.size());
  const int used_columns = std::clamp(columns, 1, std::max(1, count)), rows = (count + used_columns - 1) / used_columns;
  Picture sheet(gap + used_columns * (width + gap), gap + rows * (height + caption_height + gap), page);
  for (int i = 0; i < count; ++i) {
    const int x = gap + i % used_columns * (width + gap), y = gap + i / used_columns * (height + caption_height + gap);
    paste(sheet, pairs[static_cast<std::size_t>(i)], x, y);
    draw_text(sheet, cells[static_cast<std::size_t>(i)].caption, x, y + height + 4, font_size, caption_colour);
  }
  return sheet;
}

}  // namespace understory
