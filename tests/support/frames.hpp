// Whole frames of small scenes: which scene, at which size, and how two frames compare.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "host/frame/runner.hpp"
#include "tests/support/scenes.hpp"

namespace understory {

/// The small meadow seen from near: terrain, crowns, grass and occluders all cover pixels; 97 x 61 pixels.
inline Scene meadow_view() {
  Scene scene = small_meadow();
  scene.name = "meadow view";
  scene.image = {97, 61};
  scene.camera.position = {-4.5, -7.5, 1.6};
  scene.camera.target = {-7, 2, 1.5};
  scene.camera.vertical_fov = 1;
  return scene;
}

/// Level ground of 200 m a side and nothing else, seen from a man's height.
inline Scene open_ground() {
  Scene scene;
  scene.name = "open ground";
  scene.image = {83, 59};
  scene.camera.position = {1, -6, 1.7};
  scene.camera.target = {0, 0, 0.2};
  return scene;
}

inline bool is_background(const Frame& frame, std::size_t i) { return (frame.validity[i] & validity::background) != 0; }

inline glm::dvec3 position_at(const Frame& frame, std::size_t i) {
  return {frame.position[0][i], frame.position[1][i], frame.position[2][i]};
}

inline glm::dvec3 normal_at(const Frame& frame, std::size_t i) {
  return {frame.normal[0][i], frame.normal[1][i], frame.normal[2][i]};
}

/// Names of the planes of two frames that are not the same bytes; empty: the frames are equal.
inline std::vector<std::string> differing_planes(const Frame& a, const Frame& b) {
  std::vector<std::string> names;
  const auto compare = [&](const std::string& name, const auto& left, const auto& right) {
    if (left.size() != right.size() || std::memcmp(left.data(), right.data(), left.size() * sizeof(left[0])) != 0)
      names.push_back(name);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    compare("position " + std::to_string(axis), a.position[axis], b.position[axis]);
    compare("normal " + std::to_string(axis), a.normal[axis], b.normal[axis]);
  }
  compare("depth", a.depth, b.depth);
  compare("owner", a.owner, b.owner);
  compare("validity", a.validity, b.validity);
  compare("height_above_root", a.height_above_root, b.height_above_root);
  compare("visibility", a.visibility, b.visibility);
  for (const auto& [name, plane] : a.terms) compare(name, plane, b.terms.contains(name) ? b.terms.at(name) : Plane());
  if (a.terms.size() != b.terms.size()) names.push_back("number of terms");
  return names;
}

}  // namespace understory
