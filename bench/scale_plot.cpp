#include "bench/scale_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

constexpr double width = 420, height = 320, left = 60, right = 20, top = 40, bottom = 50;  // of a panel, pixels
constexpr const char* colours[] = {"#1b7837", "#762a83", "#b35806"};

/// Powers of two around all values.
struct Axis {
  double low = 1e300, high = 0;
  void add(const std::vector<double>& values) {
    for (const double v : values) low = std::min(low, v), high = std::max(high, v);
  }
  void round_out() {
    low = std::exp2(std::floor(std::log2(low)));
    high = std::exp2(std::max(std::ceil(std::log2(high)), std::log2(low) + 1));
  }
  double share(double value) const { return std::log2(value / low) / std::log2(high / low); }
};

std::string panel_svg(const Panel& panel, double x0) {
  Axis across, up;
  for (const Curve& curve : panel.curves) across.add(curve.x), up.add(curve.y);
  across.round_out();
  up.round_out();
  const auto px = [&](double x) { return x0 + left + across.share(x) * (width - left - right); };
  const auto py = [&](double y) { return height - bottom - up.share(y) * (height - top - bottom); };
  std::string svg = fmt::format("<text x='{}' y='20' font-weight='bold'>{}</text>\n", x0 + left, panel.title);
  for (double x = across.low; x <= across.high * 1.001; x *= 2)
    svg += fmt::format(
        "<line x1='{0:.1f}' y1='{1}' x2='{0:.1f}' y2='{2}' stroke='#ddd'/><text x='{0:.1f}' y='{3}' "
        "text-anchor='middle'>{4:g}</text>\n",
        px(x), top, height - bottom, height - bottom + 16, x);
  for (double y = up.low; y <= up.high * 1.001; y *= 2)
    svg += fmt::format(
        "<line x1='{1}' y1='{0:.1f}' x2='{2}' y2='{0:.1f}' stroke='#ddd'/><text x='{3}' y='{0:.1f}' "
        "text-anchor='end'>{4:g}</text>\n",
        py(y), x0 + left, x0 + width - right, x0 + left - 5, y);
  svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>\n", x0 + width / 2, height - 12,
                     panel.x_name);
  svg += fmt::format("<text x='{}' y='{}'>{}</text>\n", x0 + 8, top - 8, panel.y_name);
  int number = 0;
  for (const Curve& curve : panel.curves) {
    const char* colour = colours[static_cast<std::size_t>(number) % std::size(colours)];
    std::string points;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      points += fmt::format("{:.1f},{:.1f} ", px(curve.x[i]), py(curve.y[i]));
      svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' fill='{}'/>\n", px(curve.x[i]), py(curve.y[i]), colour);
    }
    svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='2'/>\n", points, colour);
    svg += fmt::format("<text x='{}' y='{}' fill='{}'>{}</text>\n", x0 + left + 10, top + 16 + 16 * number++, colour,
                       curve.name);
    const double end = std::min(across.high, curve.x.front() * up.high / curve.y.front());
    svg += fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='{}' stroke-dasharray='4 4'/>\n",
                       px(curve.x.front()), py(curve.y.front()), px(end), py(curve.y.front() * end / curve.x.front()),
                       colour);
  }
  return svg;
}

}  // namespace

std::string svg_of(const std::vector<Panel>& panels) {
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0:g}' height='{1:g}' font-family='sans-serif' font-size='12'>\n"
      "<rect width='{0:g}' height='{1:g}' fill='white'/>\n",
      width * static_cast<double>(panels.size()), height);
  for (std::size_t i = 0; i < panels.size(); ++i) svg += panel_svg(panels[i], width * static_cast<double>(i));
  return svg + "</svg>\n";
}

}  // namespace understory
