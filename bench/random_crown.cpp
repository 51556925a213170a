#include "bench/random_crown.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/trace/directions.hpp"
#include "sim/files/atomic_file.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr int float_component = 5126, array_buffer = 34962;  // of the glTF 2.0 specification

std::vector<glm::vec3> leaf_corners(std::uint32_t leaves, double radius, double optical_radius) {
  // k R = (1/2) leaves area / (4/3 pi R^3) R
  const double area = 8 * glm::pi<double>() / 3 * optical_radius * radius * radius / leaves;
  const auto reach = static_cast<float>(std::sqrt(4 * area / (3 * std::sqrt(3.0))));  // centre to corner
  std::vector<glm::vec3> corners;
  for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
    Random random(1, stream_of("random crown"), leaf);
    const auto uniform = [&] { return static_cast<float>(random.uniform()); };
    const glm::vec3 direction = uniform_sphere({uniform(), uniform()});
    const glm::vec3 centre = static_cast<float>(radius * std::cbrt(random.uniform())) * direction;
    const glm::mat3 frame = frame_about(uniform_sphere({uniform(), uniform()}));
    const float turn = glm::two_pi<float>() * uniform();
    for (int corner = 0; corner < 3; ++corner) {
      const float angle = turn + static_cast<float>(corner) * glm::two_pi<float>() / 3;
      const glm::vec3 p = centre + reach * (std::cos(angle) * frame[0] + std::sin(angle) * frame[1]);
      corners.emplace_back(p.x, p.z + static_cast<float>(radius), -p.y);  // glTF is y up
    }
  }
  return corners;
}

}  // namespace

void write_random_crown(const std::filesystem::path& path, std::uint32_t leaves, double radius, double optical_radius) {
  const std::vector<glm::vec3> corners = leaf_corners(leaves, radius, optical_radius);
  glm::vec3 low = corners.front(), high = low;
  for (const glm::vec3 p : corners) low = glm::min(low, p), high = glm::max(high, p);
  const std::size_t bytes = corners.size() * sizeof(glm::vec3);
  std::filesystem::path binary = path;
  binary += ".bin";
  write_file_atomically(binary, {reinterpret_cast<const char*>(corners.data()), bytes});
  using Json = nlohmann::ordered_json;
  const Json primitive = {{"attributes", {{"POSITION", 0}}}, {"material", 0}};
  const Json positions = {{"bufferView", 0}, {"componentType", float_component}, {"count", corners.size()},
                          {"type", "VEC3"},  {"min", {low.x, low.y, low.z}},     {"max", {high.x, high.y, high.z}}};
  const Json gltf = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", Json::array({{{"nodes", {0}}}})},
      {"nodes", Json::array({{{"mesh", 0}, {"name", "crown"}}})},
      {"materials", Json::array({{{"name", "leaf"}}})},
      {"meshes", Json::array({{{"primitives", Json::array({primitive})}}})},
      {"accessors", Json::array({positions})},
      {"bufferViews",
       Json::array({{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", bytes}, {"target", array_buffer}}})},
      {"buffers", Json::array({{{"uri", binary.filename().string()}, {"byteLength", bytes}}})}};
  write_file_atomically(path, gltf.dump());
}

}  // namespace understory
