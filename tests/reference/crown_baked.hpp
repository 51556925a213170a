// A texel of a baked face in double, in another form than the kernel's: V as the mean of its corners weighted by the
// opposite areas.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace understory::reference {

/// `place`: in the texel, [0, 1]. `tilt`: what the value is multiplied with before it is limited to [0, 1].
inline double texel_visibility(std::uint32_t texel, glm::dvec2 place, double tilt = 1) {
  double sum = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const double value = static_cast<double>(texel / (1u << (8 * corner)) % 256) / 127.5 - 0.5;
    const double across = corner % 2 == 0 ? 1 - place.x : place.x, along = corner / 2 == 0 ? 1 - place.y : place.y;
    sum += across * along * value;
  }
  return std::clamp(sum * tilt, 0.0, 1.0);
}

/// The same from a packed place: shares of 12 bits each and the tilt in 128ths.
inline double texel_visibility(std::uint32_t texel, std::uint32_t packed) {
  return texel_visibility(texel, {packed % 4096 / 4095.0, packed / 4096 % 4096 / 4095.0}, packed / 16777216 / 128.0);
}

/// V on one side of a face at shares `place` of its corners b and c. `face`: first texel, columns | rows << 8 as baked.
inline double face_visibility(const std::vector<std::uint32_t>& texels, std::array<std::uint32_t, 2> face, bool front,
                              glm::dvec2 place) {
  const std::uint32_t columns = face[1] % 256, rows = face[1] / 256;
  const double x = place.x * columns, y = place.y * rows;
  const auto column = std::min(static_cast<std::uint32_t>(std::max(x, 0.0)), columns - 1);
  const auto row = std::min(static_cast<std::uint32_t>(std::max(y, 0.0)), rows - 1);
  const std::size_t texel = face[0] + (front ? 0 : columns * rows) + row * columns + column;
  return texel_visibility(texels[texel], {std::clamp(x - column, 0.0, 1.0), std::clamp(y - row, 0.0, 1.0)});
}

}  // namespace understory::reference
