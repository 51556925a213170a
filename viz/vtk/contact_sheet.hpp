// Many frames on one page: what a person looks at first after a run.
#pragma once
#include <string>
#include <vector>

#include "viz/vtk/picture.hpp"

namespace understory {

struct ContactCell {
  Picture left, right;  // for instance the sky-lit picture and V; kept small by the caller (see shrink) or not
  std::string caption;
};

/// Pairs side by side with a caption below, in rows of `columns` pairs. Left pictures are shrunk to `picture_width`,
/// right ones to the same height.
Picture contact_sheet(const std::vector<ContactCell>& cells, int columns, int picture_width);

}  // namespace understory
