// Points with intervals and ceilings over a logarithmic and a linear or logarithmic axis, the marked ones numbered:
// charts of time and error, and of speed under its roofs. The same drawing as PNG and as SVG, without a display and
// without OpenGL.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "viz/vtk/picture.hpp"

namespace understory {

struct ChartPoint {
  double x = 1, x_low = 1, x_high = 1;  // above 0
  double y = 0, y_low = 0, y_high = 0;  // at least 0
  bool marked = false;                  // numbered in order of x, named below the chart
  std::string label;
};

/// A ceiling: straight on the page, named where it ends.
struct ChartLine {
  double x_from = 1, y_from = 1, x_to = 1, y_to = 1;  // above 0
  std::string label;
};

struct ScatterChart {
  std::string title, x_title, y_title;
  std::vector<ChartPoint> points;
  std::vector<ChartLine> lines = {};
  bool joined = true;          // marked points, each lower than all before it, by a staircase
  bool y_logarithmic = false;  // all y above 0
};

Picture draw_chart(const ScatterChart& chart);
std::string chart_svg(const ScatterChart& chart);

}  // namespace understory
