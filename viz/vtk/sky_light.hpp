// The picture a camera would take of a frame under an overcast sky: albedo times visibility times sky light.
#pragma once
#include "sim/frame.hpp"
#include "viz/vtk/picture.hpp"

namespace understory {

/// What the sky adds to a frame. Radiances are relative to the mean over the dome.
struct SkyLight {
  glm::vec3 tint{0.95f, 0.98f, 1.0f};  // of the whole sky, linear RGB
  float ground_albedo = 0.12f;         // light from below, for surfaces that face down
  float meteorological_range = 20000;  // m: distance at which haze leaves 2 % of the contrast
  float exposure = 1.8f;
};

/// Radiance of every pixel. Background: the CIE overcast sky, L = L_zenith (1 + 2 sin elevation)/3; under an
/// environment map the map, whose ambient light the surfaces receive.
/// Foliage colour varies by owner and along blades, the ground's by place; leaves and blades let light through.
/// A function of the frame alone.
LightPicture sky_light_picture(const Frame& frame, const SkyLight& sky = {});

/// The same, developed.
Picture sky_lit_picture(const Frame& frame, const SkyLight& sky = {});

}  // namespace understory
