// Colour maps by linear interpolation between published stops; layout in pixels.
#include "viz/vtk/false_colour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "sim/error.hpp"
#include "viz/vtk/text.hpp"

namespace understory {
namespace {

using Stop = std::array<std::uint8_t, 3>;
// matplotlib's viridis at multiples of 1/8.
constexpr Stop viridis[] = {{68, 1, 84},    {71, 44, 122}, {59, 81, 139},  {44, 113, 142}, {33, 144, 141},
                            {39, 173, 129}, {92, 200, 99}, {170, 220, 50}, {253, 231, 37}};
// Moreland's diverging map at multiples of 1/8, its middle lifted to near white.
constexpr Stop cool_to_warm[] = {{59, 76, 192},   {98, 130, 234},  {141, 176, 254}, {184, 208, 249}, {238, 238, 238},
                                 {245, 196, 173}, {244, 154, 123}, {222, 96, 77},   {180, 4, 38}};

constexpr glm::u8vec3 background_colour(70), not_a_number_colour(255, 0, 255), paper(250), ink(30);
constexpr int title_height = 30, margin = 8, bar_width = 18, label_width = 52, font_size = 14, tick_count = 5;

}  // namespace

glm::u8vec3 map_colour(ColourMap map, float value, float low, float high) {
  if (std::isnan(value)) return not_a_number_colour;
  const std::span<const Stop> stops = map == ColourMap::viridis ? viridis : cool_to_warm;
  const float place = std::clamp((value - low) / (high - low), 0.0f, 1.0f) * static_cast<float>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const float above_share = place - static_cast<float>(below);
  glm::u8vec3 colour;
  for (std::size_t channel = 0; channel < 3; ++channel)
    colour[static_cast<int>(channel)] = static_cast<std::uint8_t>(
        std::lround(std::lerp(float(stops[below][channel]), float(stops[below + 1][channel]), above_share)));
  return colour;
}

Picture colour_plane(int width, int height, const Plane& plane, const std::vector<std::uint32_t>& validity,
                     const FalseColour& look) {
  Picture picture(width, height, background_colour);
  if (3 * plane.size() != picture.rgb.size() || (!validity.empty() && validity.size() != plane.size()))
    throw Error(ErrorKind::unexpected, fmt::format("false colour: {} values and {} flags for {} x {} pixels",
                                                   plane.size(), validity.size(), width, height));
  for (int y = 0, i = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!validity.empty() && (validity[at] & validity::background) != 0) continue;
      picture.set(x, y, map_colour(look.map, plane[at], look.low, look.high));
    }
  return picture;
}

Picture false_colour(int width, int height, const Plane& plane, const std::vector<std::uint32_t>& validity,
                     const FalseColour& look) {
  Picture picture(width + 3 * margin + bar_width + label_width, height + title_height, paper);
  paste(picture, colour_plane(width, height, plane, validity, look), 0, title_height);
  draw_text(picture, look.title, margin, margin, font_size, ink);
  const int left = width + margin, top = title_height + margin, length = std::max(1, height - 2 * margin);
  for (int y = 0; y < length; ++y) {
    const float share = 1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(length);
    const glm::u8vec3 colour = map_colour(look.map, std::lerp(look.low, look.high, share), look.low, look.high);
    for (int x = 0; x < bar_width && top + y < picture.height; ++x) picture.set(left + x, top + y, colour);
  }
  for (int tick = 0; tick <= tick_count; ++tick) {
    const float share = static_cast<float>(tick) / tick_count;
    const int y = top + static_cast<int>(std::lround((1 - share) * static_cast<float>(length - 1)));
    for (int x = 0; x < 4 && y < picture.height; ++x) picture.set(left + bar_width + x, y, ink);
    const std::string label = fmt::format("{:.2g}", std::lerp(look.low, look.high, share));
    const int text_height = text_size(label, font_size).y;
    draw_text(picture, label, left + bar_width + margin, y - text_height / 2, font_size, ink);
  }
  return picture;
}

Plane difference(const Plane& a, const Plane& b) {
  if (a.size() != b.size())
    throw Error(ErrorKind::unexpected, fmt::format("difference of {} and {} values", a.size(), b.size()));
  Plane result(a.size());
  std::transform(a.begin(), a.end(), b.begin(), result.begin(), std::minus<>());
  return result;
}

}  // namespace understory
