// What the accuracy table is measured on, and with which methods.
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "sim/scene.hpp"

namespace understory {

/// A choice of methods, and what the table calls it.
struct AccuracyMethod {
  std::string name;
  Methods methods;
};

struct AccuracySubject {
  std::string name, setting;  // as in AccuracyRow
  Scene scene;                // camera and image size are set by the judge
  std::vector<AccuracyMethod> methods;
  bool ground = false;        // judge the ground too
  bool truth_itself = false;  // judge the truth's speed and intervals
  double first_time = 0;      // s, of the first of the four sides
  double time_step = 0;       // s, between the sides: in the wind each is seen at another moment
  glm::dvec4 ball{0};         // centre and radius, m, of a crown that is the same all round; radius 0: none
  double elevation = 0.2;     // radians above the horizon from which the sides are seen
};

/// All subjects in the order of the table. Meshes are looked for in `data`; the random crowns are written to `scratch`.
std::vector<AccuracySubject> accuracy_subjects(const std::filesystem::path& data, const std::filesystem::path& scratch);

}  // namespace understory
