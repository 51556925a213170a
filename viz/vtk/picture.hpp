// Pictures as bytes and as light, and the few things done to them. No VTK here: plain data that every writer takes.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace understory {

/// 8-bit sRGB, 3 bytes a pixel, row-major, top row first.
struct Picture {
  Picture() = default;
  Picture(int columns, int rows, glm::u8vec3 fill);
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  glm::u8vec3 at(int x, int y) const;
  void set(int x, int y, glm::u8vec3 colour);
};

/// Linear RGB radiance, 1 = the mean of the sky; row-major, top row first.
struct LightPicture {
  int width = 0, height = 0;
  std::vector<glm::vec3> light;
};

/// The sRGB transfer function (IEC 61966-2-1), both ways, on [0, 1].
float encode_srgb(float linear);
float decode_srgb(float encoded);

/// Exposes light as a camera would, through a film curve, then sRGB.
Picture develop(const LightPicture& light, float exposure);

/// Area average in linear light; `width` at most the picture's, height in proportion (at least 1).
Picture shrink(const Picture& picture, int width);

/// Copies what fits of `source` to (x, y), its upper left corner.
void paste(Picture& target, const Picture& source, int x, int y);

/// Left and right of each other on the taller one's height, a thin gap between.
Picture side_by_side(const Picture& left, const Picture& right);

}  // namespace understory
