// Curves over a size, both on logarithmic axes, as an SVG picture.
#pragma once
#include <string>
#include <vector>

namespace understory {

struct Curve {
  std::string name;
  std::vector<double> x, y;  // above 0
};

/// One panel beside the other, each with its own axes and a dashed line of slope 1 through its first point.
struct Panel {
  std::string title, x_name, y_name;
  std::vector<Curve> curves;
};
std::string svg_of(const std::vector<Panel>& panels);

}  // namespace understory
