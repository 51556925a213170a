// Points with intervals over a logarithmic and a linear axis, the marked ones numbered and joined: a chart of time and
// error. The same drawing as PNG and as SVG, without a display and without OpenGL.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "viz/vtk/picture.hpp"

namespace understory {

struct ChartPoint {
  double x = 1, x_low = 1, x_high = 1;  // above 0
  double y = 0, y_low = 0, y_high = 0;  // at least 0
  bool marked = false;                  // numbered in order of x, joined by a staircase, named below the chart
  std::string label;
};

struct ScatterChart {
  std::string title, x_title, y_title;
  std::vector<ChartPoint> points;
};

Picture draw_chart(const ScatterChart& chart);
std::string chart_svg(const ScatterChart& chart);

}  // namespace understory
