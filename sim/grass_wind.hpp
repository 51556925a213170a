// Wind over a field of grass: gusts travel over it as waves, every blade answers when they reach it.
// The record is what the kernel `pose_grass` reads; `grass_bend` is the same in double, written a second time.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/records.h"
#include "sim/scene.hpp"
#include "sim/wind.hpp"

namespace understory {

/// How blades of the field answer at flexibility 1. The log profile vanishes among the blades, so `sway.deflection` of
/// grass refers to the wind 10 m above ground, where weather stations measure it.
ModalSeries grass_response(const Wind& wind, const GrassField& field);

/// The field's wind at time t. `response` is what grass_response gave; `eye`: camera relative to the origin, m.
GrassWind grass_wind_at(const Wind& wind, const GrassField& field, const ModalSeries& response, double time,
                        glm::dvec3 eye);

/// The response's fluctuation as pairs (along, across), radians: what kernels read. One pair per sample.
std::vector<glm::vec2> interleaved(const ModalSeries& response);

/// One blade as the wind sees it.
struct BladeRoot {
  glm::dvec2 position{0};   // relative to the origin, m
  glm::dvec2 rest_bend{0};  // radians
  double flexibility = 1;
  double phase = 0;  // radians
};

/// Bend vector of a blade, radians: tip angle times its horizontal direction (formula: kernels/shared/grass_bend.h).
glm::dvec2 grass_bend(const GrassWind& wind, const ModalSeries& response, const BladeRoot& blade);

}  // namespace understory
