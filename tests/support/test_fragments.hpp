// Fragments made by hand or by chance, and their planes on a device. No test framework: the program's own checks
// (bench/stability.hpp) make theirs from these too.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "host/passes/planes.hpp"
#include "sim/frame.hpp"
#include "sim/random.hpp"

namespace understory {

struct TestFragment {
  glm::vec3 position{0}, normal{0, 0, 1};
  std::uint32_t owner = 0;
  float height = 0, blade_length = 0;
  std::uint32_t validity = 0;
};

/// `row_length` 0: one row. What pads the planes is as wild as can be.
inline FragmentPlanes upload_fragments(Device& device, const std::vector<TestFragment>& all,
                                       std::size_t row_length = 0) {
  FragmentPlanes planes = allocate_planes(device, all.size(), 1, true);
  if (row_length != 0) planes.row_length = row_length;
  const auto write = [&](auto& buffer, auto wild, auto member) {
    std::vector<decltype(wild)> values(planes.padded_fragments, wild);
    for (std::size_t i = 0; i < all.size(); ++i) values[i] = member(all[i]);
    buffer.write(values);
  };
  write(planes.position_x, NAN, [](const TestFragment& f) { return f.position.x; });
  write(planes.position_y, INFINITY, [](const TestFragment& f) { return f.position.y; });
  write(planes.position_z, -1e30f, [](const TestFragment& f) { return f.position.z; });
  write(planes.normal_x, NAN, [](const TestFragment& f) { return f.normal.x; });
  write(planes.normal_y, 1e30f, [](const TestFragment& f) { return f.normal.y; });
  write(planes.normal_z, 0.0f, [](const TestFragment& f) { return f.normal.z; });
  write(planes.owner, 0xdeadbeefu, [](const TestFragment& f) { return f.owner; });
  write(planes.validity, 0u, [](const TestFragment& f) { return f.validity; });
  write(planes.height_above_root, NAN, [](const TestFragment& f) { return f.height; });
  write(planes.blade_length, NAN, [](const TestFragment& f) { return f.blade_length; });
  return planes;
}

template <typename T>
std::vector<T> first_of(const Buffer<T>& buffer, std::size_t count) {
  std::vector<T> values = buffer.read();
  values.resize(count);
  return values;
}

inline glm::vec3 random_direction(Random& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * std::numbers::pi), flat = std::sqrt(1 - z * z);
  return glm::vec3(glm::dvec3(flat * std::cos(turn), flat * std::sin(turn), z));
}

/// What a pass made of some fragments.
struct Shaded {
  std::vector<float> visibility;
  std::vector<std::uint32_t> validity;
};

/// Fragments of all kinds of bad numbers, with these owners in turn.
inline std::vector<TestFragment> garbage(std::uint32_t owners) {
  const float bad[] = {NAN, INFINITY, -INFINITY, 0.0f, 1e-44f, 1e6f, -3e38f, 1e30f, 1e-30f};
  std::vector<TestFragment> all;
  for (const float p : bad)
    for (const float n : bad)
      all.push_back(
          {glm::vec3(p, n, p), glm::vec3(n, p, n), static_cast<std::uint32_t>(all.size()) % (owners + 2), p, n});
  for (const float p : bad) all.push_back({glm::vec3(p, 0, 0), glm::vec3(0, 0, 1), 1, p, 1});
  for (const float n : bad) all.push_back({glm::vec3(0), glm::vec3(0, n, 0), 1, 1, n});
  return all;
}

}  // namespace understory
