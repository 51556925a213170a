// Conversions and copying, row by row.
#include "viz/vtk/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace understory {
namespace {

constexpr int encoding_steps = 1 << 14;  // finer than a byte's step everywhere on the curve
constexpr glm::u8vec3 gap_colour(24);

std::uint8_t to_byte(float encoded) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(encoded, 0.0f, 1.0f)));
}

const std::vector<std::uint8_t>& encoding_table() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> bytes(encoding_steps + 1);
    for (int i = 0; i <= encoding_steps; ++i)
      bytes[static_cast<std::size_t>(i)] = to_byte(encode_srgb(static_cast<float>(i) / encoding_steps));
    return bytes;
  }();
  return table;
}

const std::array<float, 256>& decoding_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = decode_srgb(static_cast<float>(i) / 255);
    return values;
  }();
  return table;
}

std::uint8_t encode_byte(float linear) {
  return encoding_table()[static_cast<std::size_t>(std::clamp(linear, 0.0f, 1.0f) * encoding_steps + 0.5f)];
}

/// A film's answer to light: dark shadows, soft highlights. K. Narkowicz 2016, "ACES Filmic Tone Mapping Curve".
float film(float light) { return light * (2.51f * light + 0.03f) / (light * (2.43f * light + 0.59f) + 0.14f); }

}  // namespace

Picture::Picture(int columns, int rows, glm::u8vec3 fill)
    : width(columns), height(rows), rgb(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = fill[static_cast<glm::length_t>(i % 3)];
}

glm::u8vec3 Picture::at(int x, int y) const {
  const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  return {rgb[i], rgb[i + 1], rgb[i + 2]};
}

void Picture::set(int x, int y, glm::u8vec3 colour) {
  const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  for (int channel = 0; channel < 3; ++channel) rgb[i + static_cast<std::size_t>(channel)] = colour[channel];
}

float encode_srgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float decode_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

Picture develop(const LightPicture& light, float exposure) {
  Picture picture(light.width, light.height, glm::u8vec3(0));
  for (std::size_t i = 0; i < light.light.size(); ++i)
    for (int channel = 0; channel < 3; ++channel)
      picture.rgb[3 * i + static_cast<std::size_t>(channel)] = encode_byte(film(exposure * light.light[i][channel]));
  return picture;
}

Picture shrink(const Picture& picture, int width) {
  const int columns = std::clamp(width, 1, std::max(1, picture.width));
  const int rows = std::max(1, static_cast<int>(std::lround(double{1} * picture.height * columns / picture.width)));
  Picture result(columns, rows, glm::u8vec3(0));
  const auto& decode = decoding_table();
  const auto edge = [](int i, int count, int size) { return static_cast<double>(i) * size / count; };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double left = edge(x, columns, picture.width), right = edge(x + 1, columns, picture.width);
      const double top = edge(y, rows, picture.height), bottom = edge(y + 1, rows, picture.height);
      glm::dvec3 sum(0);
      double area = 0;
      for (int v = static_cast<int>(top); v < std::min(picture.height, static_cast<int>(std::ceil(bottom))); ++v)
        for (int u = static_cast<int>(left); u < std::min(picture.width, static_cast<int>(std::ceil(right))); ++u) {
          const double share = (std::min(right, u + 1.0) - std::max(left, double(u))) *
                               (std::min(bottom, v + 1.0) - std::max(top, double(v)));
          const glm::u8vec3 colour = picture.at(u, v);
          sum += share * glm::dvec3(decode[colour.r], decode[colour.g], decode[colour.b]);
          area += share;
        }
      sum /= area;
      result.set(x, y, {encode_byte(float(sum.r)), encode_byte(float(sum.g)), encode_byte(float(sum.b))});
    }
  return result;
}

void paste(Picture& target, const Picture& source, int x, int y) {
  const int first = std::max(0, -x), last = std::min(source.width, target.width - x);
  for (int row = std::max(0, -y); row < std::min(source.height, target.height - y) && first < last; ++row) {
    const auto from = source.rgb.begin() + 3 * (std::ptrdiff_t{row} * source.width + first);
    std::copy(from, from + 3 * std::ptrdiff_t{last - first},
              target.rgb.begin() + 3 * (std::ptrdiff_t{y + row} * target.width + x + first));
  }
}

Picture side_by_side(const Picture& left, const Picture& right) {
  constexpr int gap = 4;
  Picture result(left.width + gap + right.width, std::max(left.height, right.height), gap_colour);
  paste(result, left, 0, 0);
  paste(result, right, left.width + gap, 0);
  return result;
}

}  // namespace understory
