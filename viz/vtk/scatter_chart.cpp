// A chart becomes a list of lines, dots and words in pixels; pictures and SVG are two ways to write that list.
#include "viz/vtk/scatter_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viz/vtk/text.hpp"

namespace understory {
namespace {

constexpr glm::u8vec3 page(255), ink(40), faint(225), plain(150), marked(190, 30, 45);
constexpr int width = 1100, plot_height = 560, left = 80, right = 30, top = 50, bottom = 70, line_height = 18;
constexpr int font_size = 13, title_size = 17;

struct Line {
  glm::dvec2 from, to;
  double thickness;
  glm::u8vec3 colour;
};
struct Dot {
  glm::dvec2 at;
  double radius;
  glm::u8vec3 colour;
};
enum class Align { begin, middle, end };
struct Words {
  std::string text;
  glm::dvec2 at;  // upper edge, at the left, in the middle, or at the right
  int size;
  Align align;
  glm::u8vec3 colour;
};

struct Drawing {
  int height = 0;
  std::vector<Line> lines;
  std::vector<Dot> dots;
  std::vector<Words> words;
};

/// Ticks at 1, 2 and 5 times powers of ten.
std::vector<double> logarithmic_ticks(double low, double high) {
  std::vector<double> ticks;
  for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor * decade >= low && factor * decade <= high) ticks.push_back(factor * decade);
  return ticks;
}

/// Ticks from 0 in steps of 1, 2 or 5 times a power of ten, about six of them.
std::vector<double> linear_ticks(double high) {
  const double rough = high / 6, decade = std::pow(10, std::floor(std::log10(rough)));
  const double step = decade * (rough > 5 * decade ? 10 : rough > 2 * decade ? 5 : rough > decade ? 2 : 1);
  std::vector<double> ticks;
  for (int i = 0; i * step <= high; ++i) ticks.push_back(i * step);
  return ticks;
}

/// From values to pixels.
class Axes {
 public:
  explicit Axes(const ScatterChart& chart) : y_logarithmic_(chart.y_logarithmic) {
    const auto hold = [&](double x_low, double x_high, double y_low, double y_high) {
      low_ = std::min(low_, x_low);
      high_ = std::max(high_, x_high);
      floor_ = std::min(floor_, y_low);
      top_ = std::max(top_, y_high);
    };
    for (const ChartPoint& point : chart.points) hold(point.x_low, point.x_high, point.y_low, point.y_high);
    for (const ChartLine& line : chart.lines)
      hold(std::min(line.x_from, line.x_to), std::max(line.x_from, line.x_to), std::min(line.y_from, line.y_to),
           std::max(line.y_from, line.y_to));
    if (low_ > high_) low_ = 0.5, high_ = 2;
    low_ /= 1.25;
    high_ *= 1.25;
    if (y_logarithmic_ && !(floor_ > 0 && floor_ <= top_)) floor_ = 0.5, top_ = 2;
    floor_ = y_logarithmic_ ? floor_ / 1.5 : 0;
    top_ = y_logarithmic_ ? top_ * 1.5 : top_ > 0 ? 1.05 * top_ : 1;
  }
  double x(double value) const {
    return left + (width - left - right) * std::log(value / low_) / std::log(high_ / low_);
  }
  double y(double value) const {
    const double share = y_logarithmic_ ? std::log(value / floor_) / std::log(top_ / floor_) : value / top_;
    return top + plot_height * (1 - share);
  }
  glm::dvec2 at(const ChartPoint& point) const { return {x(point.x), y(point.y)}; }

  void draw(const ScatterChart& chart, Drawing& drawing) const {
    const double floor = top + plot_height, wall = width - right;
    for (const double tick : logarithmic_ticks(low_, high_)) {
      drawing.lines.push_back({{x(tick), top}, {x(tick), floor}, 1, faint});
      drawing.words.push_back({fmt::format("{:g}", tick), {x(tick), floor + 6}, font_size, Align::middle, ink});
    }
    for (const double tick : y_logarithmic_ ? logarithmic_ticks(floor_, top_) : linear_ticks(top_)) {
      drawing.lines.push_back({{left, y(tick)}, {wall, y(tick)}, 1, faint});
      drawing.words.push_back({fmt::format("{:g}", tick), {left - 8, y(tick) - 7}, font_size, Align::end, ink});
    }
    drawing.lines.push_back({{left, floor}, {wall, floor}, 1.5, ink});
    drawing.lines.push_back({{left, top}, {left, floor}, 1.5, ink});
    drawing.words.push_back({chart.title, {left, 12}, title_size, Align::begin, ink});
    drawing.words.push_back({chart.x_title, {(left + wall) / 2, floor + 28}, font_size, Align::middle, ink});
    drawing.words.push_back({chart.y_title, {left, 34}, font_size, Align::begin, ink});
  }

 private:
  bool y_logarithmic_;
  double low_ = 1e300, high_ = 0, floor_ = 1e300, top_ = 0;
};

void draw_point(const ChartPoint& point, const Axes& axes, Drawing& drawing) {
  const glm::u8vec3 colour = point.marked ? marked : plain;
  const glm::dvec2 at = axes.at(point);
  drawing.lines.push_back({{axes.x(point.x_low), at.y}, {axes.x(point.x_high), at.y}, 1, colour});
  drawing.lines.push_back({{at.x, axes.y(point.y_low)}, {at.x, axes.y(point.y_high)}, 1, colour});
  drawing.dots.push_back({at, point.marked ? 5.0 : 3.0, colour});
}

/// The numbers of the marked points, each where it covers no other.
void draw_numbers(const std::vector<ChartPoint>& points, const Axes& axes, Drawing& drawing) {
  constexpr glm::dvec2 room(20, 16);
  constexpr glm::dvec2 places[] = {{8, -18}, {8, 4}, {-24, -18}, {-24, 4}, {-6, -24}, {-6, 10}, {22, -30}, {22, 16}};
  std::vector<glm::dvec2> taken;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto is_free = [&](glm::dvec2 corner) {
      return std::none_of(taken.begin(), taken.end(), [&](glm::dvec2 other) {
        return std::abs(other.x - corner.x) < room.x && std::abs(other.y - corner.y) < room.y;
      });
    };
    const glm::dvec2 at = axes.at(points[i]);
    const auto place = std::find_if(std::begin(places), std::end(places), [&](auto one) { return is_free(at + one); });
    const glm::dvec2 corner = at + (place == std::end(places) ? places[0] : *place);
    taken.push_back(corner);
    drawing.words.push_back({std::to_string(i + 1), corner, font_size, Align::begin, marked});
  }
}

Drawing drawing_of(const ScatterChart& chart) {
  const Axes axes(chart);
  Drawing drawing;
  axes.draw(chart, drawing);
  for (const ChartLine& line : chart.lines) {
    const glm::dvec2 from(axes.x(line.x_from), axes.y(line.y_from)), to(axes.x(line.x_to), axes.y(line.y_to));
    drawing.lines.push_back({from, to, 2, ink});
    drawing.words.push_back({line.label, to - glm::dvec2(6, 20), font_size, Align::end, ink});
  }
  std::vector<ChartPoint> front;
  for (const ChartPoint& point : chart.points) {
    if (point.marked)
      front.push_back(point);
    else
      draw_point(point, axes, drawing);
  }
  std::stable_sort(front.begin(), front.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const ChartPoint* last = nullptr;
  for (const ChartPoint& point : front) {
    if (!chart.joined || (last && point.y >= last->y)) continue;  // as good as the last within intervals: no step
    if (last) {
      const glm::dvec2 from = axes.at(*last), to = axes.at(point), corner(to.x, from.y);
      drawing.lines.push_back({from, corner, 1, marked});
      drawing.lines.push_back({corner, to, 1, marked});
    }
    last = &point;
  }
  for (const ChartPoint& point : front) draw_point(point, axes, drawing);
  draw_numbers(front, axes, drawing);
  double line = top + plot_height + bottom - 10;
  for (std::size_t i = 0; i < front.size(); ++i, line += line_height)
    drawing.words.push_back({fmt::format("{}  {}", i + 1, front[i].label), {left, line}, font_size, Align::begin, ink});
  drawing.height = static_cast<int>(line) + 12;
  return drawing;
}

/// Hard-edged at `scale` times the size, to be shrunk.
void fill_where(Picture& picture, glm::dvec2 low, glm::dvec2 high, glm::u8vec3 colour, const auto& is_inside) {
  const auto first = [](double v) { return std::max(0, static_cast<int>(std::floor(v))); };
  for (int y = first(low.y); y < std::min(picture.height, static_cast<int>(std::ceil(high.y)) + 1); ++y)
    for (int x = first(low.x); x < std::min(picture.width, static_cast<int>(std::ceil(high.x)) + 1); ++x)
      if (is_inside(glm::dvec2(x + 0.5, y + 0.5))) picture.set(x, y, colour);
}

double distance_to_line(glm::dvec2 p, glm::dvec2 from, glm::dvec2 to) {
  const glm::dvec2 along = to - from;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - from, along) / length2, 0.0, 1.0) : 0;
  return glm::length(p - (from + t * along));
}

std::string svg_colour(glm::u8vec3 colour) { return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b); }

std::string svg_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else
      escaped += c;
  }
  return escaped;
}

}  // namespace

Picture draw_chart(const ScatterChart& chart) {
  constexpr int scale = 3;
  const Drawing drawing = drawing_of(chart);
  Picture large(scale * width, scale * drawing.height, page);
  for (const Line& line : drawing.lines) {
    const glm::dvec2 from = double{scale} * line.from, to = double{scale} * line.to;
    const double reach = 0.5 * scale * line.thickness;
    fill_where(large, glm::min(from, to) - reach, glm::max(from, to) + reach, line.colour,
               [&](glm::dvec2 p) { return distance_to_line(p, from, to) <= reach; });
  }
  for (const Dot& dot : drawing.dots) {
    const glm::dvec2 at = double{scale} * dot.at;
    const double radius = scale * dot.radius;
    fill_where(large, at - radius, at + radius, dot.colour,
               [&](glm::dvec2 p) { return glm::length(p - at) <= radius; });
  }
  Picture picture = shrink(large, width);
  for (const Words& words : drawing.words) {
    const double share = words.align == Align::begin ? 0 : words.align == Align::middle ? 0.5 : 1;
    const int back = static_cast<int>(share * text_size(words.text, words.size).x);
    draw_text(picture, words.text, static_cast<int>(words.at.x) - back, static_cast<int>(words.at.y), words.size,
              words.colour);
  }
  return picture;
}

std::string chart_svg(const ScatterChart& chart) {
  const Drawing drawing = drawing_of(chart);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Arial, Helvetica, sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"{2}\"/>\n",
      width, drawing.height, svg_colour(page));
  for (const Line& line : drawing.lines)
    svg += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-width=\"{:g}\" "
        "stroke-linecap=\"round\"/>\n",
        line.from.x, line.from.y, line.to.x, line.to.y, svg_colour(line.colour), line.thickness);
  for (const Dot& dot : drawing.dots)
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\" fill=\"{}\"/>\n", dot.at.x, dot.at.y, dot.radius,
                       svg_colour(dot.colour));
  for (const Words& words : drawing.words) {
    const char* anchor = words.align == Align::begin ? "start" : words.align == Align::middle ? "middle" : "end";
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n",
                       words.at.x, words.at.y + 0.85 * words.size, words.size, anchor, svg_colour(words.colour),
                       svg_text(words.text));
  }
  return svg + "</svg>\n";
}

}  // namespace understory
