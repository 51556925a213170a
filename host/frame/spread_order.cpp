#include "host/frame/spread_order.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "sim/random.hpp"

namespace understory {
namespace {

constexpr int curve_bits = 16;  // per axis

/// Place of a cell on the Morton curve: the bits of its three numbers by turns.
std::uint64_t morton(const glm::uvec3& cell) {
  std::uint64_t place = 0;
  for (int bit = curve_bits - 1; bit >= 0; --bit)
    for (int axis = 0; axis < 3; ++axis) place = 2 * place + ((cell[axis] >> bit) & 1u);
  return place;
}

std::uint32_t reversed(std::uint32_t value) {
  std::uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit) result = 2 * result + ((value >> bit) & 1u);
  return result;
}

}  // namespace

std::vector<std::size_t> spread_order(const std::vector<glm::vec3>& points, std::uint64_t seed) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::vec3& point : points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  const glm::vec3 size = high - low;
  const float edge = std::max({size.x, size.y, size.z, std::numeric_limits<float>::min()});
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    order.emplace_back(morton(glm::uvec3((points[i] - low) / edge * float((1 << curve_bits) - 1))), i);
  std::sort(order.begin(), order.end());
  const auto shift = static_cast<std::uint32_t>(mix_bits(seed));
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i].first = static_cast<std::uint32_t>(reversed(static_cast<std::uint32_t>(i)) + shift);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> numbers;
  for (const auto& [key, i] : order) numbers.push_back(i);
  return numbers;
}

}  // namespace understory
