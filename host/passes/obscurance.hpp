// What the obscurance passes share: how they sample, and the camera that saw the depth plane.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "host/passes/obscurance_samples.hpp"
#include "host/passes/planes.hpp"
#include "kernels/shared/obscurance_setting.h"
#include "sim/scene.hpp"

namespace understory {

/// The camera of a depth plane. Axes are unit, world directions; pixel centres at +0.5, y down.
struct ObscuranceView {
  glm::vec3 right{1, 0, 0}, down{0, -1, 0}, forward{0, 0, -1};
  double focal = 1;                   // pixels per unit of x/z; orthographic: pixels per metre
  double centre_x = 0, centre_y = 0;  // principal point, pixels
  bool perspective = true;
  int width = 0, height = 0;  // pixels
};

/// Throws Error(invalid_input) naming what is wrong with a radius, thickness or camera.
ObscuranceSetting obscurance_setting(const ObscuranceView& view, const NearField& near_field);

/// -D options of the kernels.
std::string obscurance_options(const NearField& near_field);

/// Samples fill the ball on top of the tangent plane; without normals it is always the one around the fragment.
bool is_cosine(const NearField& near_field);

/// Lines with their half lengths.
std::vector<ObscuranceRow> line_rows(const ObscuranceSampleSet& set, const NearField& near_field);
std::vector<ObscuranceRow> point_rows(const ObscuranceSampleSet& set, const NearField& near_field);

/// Requires width x height fragments, and planes of their padded size.
void require_view(const char* pass, const FragmentPlanes& planes, const ObscuranceView& view,
                  const Buffer<float>& visibility);

}  // namespace understory
