#include "host/trace/directions.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace understory {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

std::uint32_t hash(std::uint32_t x) {  // finaliser of MurmurHash3
  x ^= x >> 16;
  x *= 0x85ebca6bu;
  x ^= x >> 13;
  x *= 0xc2b2ae35u;
  return x ^ (x >> 16);
}

/// Each output bit depends on the input bits below it only (Laine and Karras 2011).
std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  return x ^ (x * 0x8d22f6e6u);
}

/// Owen scrambling of a number whose bits are reversed already.
std::uint32_t scramble_reversed(std::uint32_t reversed, std::uint32_t seed) {
  return reverse_bits(laine_karras(reversed, seed));
}

/// Second dimension of Sobol's sequence, bits reversed. Its direction numbers are the rows of Pascal's triangle modulo
/// 2, and a binomial C(k, j) is odd where the bits of j are among those of k (Lucas): a sum over supersets, bit by bit.
std::uint32_t reversed_sobol_second(std::uint32_t index) {
  index ^= (index & 0xaaaaaaaau) >> 1;
  index ^= (index & 0xccccccccu) >> 2;
  index ^= (index & 0xf0f0f0f0u) >> 4;
  index ^= (index & 0xff00ff00u) >> 8;
  return index ^ (index >> 16);
}

float unit_interval(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

glm::vec3 about_z(float azimuth, float height, float radius) {
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), height};
}

}  // namespace

glm::vec2 scrambled_sobol(std::uint32_t index, std::uint32_t seed) {
  const std::uint32_t shuffled = scramble_reversed(reverse_bits(index), hash(seed));
  return {unit_interval(scramble_reversed(shuffled, hash(seed ^ 0x9e3779b9u))),
          unit_interval(scramble_reversed(reversed_sobol_second(shuffled), hash(seed ^ 0x7f4a7c15u)))};
}

glm::vec3 uniform_sphere(glm::vec2 u) {
  const float height = 1 - 2 * u.y;
  return about_z(glm::two_pi<float>() * u.x, height, std::sqrt(std::max(1 - height * height, 0.0f)));
}

glm::vec3 cosine_hemisphere(glm::vec2 u) {
  return about_z(glm::two_pi<float>() * u.x, std::sqrt(std::max(1 - u.y, 0.0f)), std::sqrt(u.y));
}

glm::vec3 uniform_hemisphere(glm::vec2 u) {
  const float height = 1 - u.y;
  return about_z(glm::two_pi<float>() * u.x, height, std::sqrt(std::max(1 - height * height, 0.0f)));
}

glm::mat3 frame_about(glm::vec3 normal) {
  const float sign = std::copysign(1.0f, normal.z);
  const float a = -1 / (sign + normal.z), b = normal.x * normal.y * a;
  return {glm::vec3(1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
          glm::vec3(b, sign + normal.y * normal.y * a, -normal.y), normal};
}

}  // namespace understory
