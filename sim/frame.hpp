// One shaded frame as planes of floats: what the host computes and viz writes. Row-major, top row first.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/world.hpp"

namespace understory {

/// Bit flags of channel `validity` (FORMULAS.md). 0: every assumption of the model held. Code 256, a cone beyond its
/// table, does not exist: cones have closed forms (kernels/shared/cone.h) for every aperture and tilt.
namespace validity {
inline constexpr std::uint32_t background = 1, not_finite = 2, not_unit = 4, outside_model = 8, occluder_too_close = 16,
                               radius_out_of_range = 32, left_image = 64, grid_border = 128;
}

using Plane = std::vector<float>;

struct Frame {
  int width = 0, height = 0;
  int index = 0;
  double time = 0;                        // s
  glm::dvec3 origin{0};                   // world coordinates of the positions' zero
  std::array<Plane, 3> position, normal;  // m relative to origin; unit, facing the viewer. Background: 0
  Plane depth;                            // camera z, m; background: infinity
  std::vector<std::uint32_t> owner;       // row of `owners`; 0: background
  std::vector<std::uint32_t> validity;    // bit flags
  Plane height_above_root;                // blades: m; empty when no planned pass reads it
  std::map<std::string, Plane> terms;     // one per visibility pass, by method name
  Plane visibility;                       // V_c, [0, 1]; background: 1
  Plane halfwidth;                        // of truth: of the 95 % interval about `visibility`; empty otherwise
  std::vector<std::uint32_t> rays;        // of truth: rays per pixel, 0 where there is no surface; empty otherwise
  std::array<Plane, 3> ambient_light;     // red, green, blue of the environment's light; empty under a uniform sky
  glm::vec3 sky_mean{1};                  // radiance of that sky, mean over what a level surface faces
  std::shared_ptr<const EnvironmentMap> environment;  // seen where nothing is drawn; null: a uniform sky
  double environment_turn = 0;                        // radians
  std::vector<Owner> owners;                          // the owner table
  glm::dmat4 world_to_camera{1};          // column vectors; camera looks along -z, y up (OpenGL and Blender)
  double vertical_fov = 0;                // radians; 0: orthographic or unknown
  double orthographic_height = 0;         // m that the image spans vertically; 0: perspective or unknown
  double near_plane = 0;                  // m
  std::map<std::string, double> pass_ms;  // device time of each pass, for run.json; not written to frame files
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// The posed triangles of a frame, for PLY and VTK dumps and for tracing. Positions in metres relative to the origin.
struct PosedGeometry {
  std::vector<float> positions;          // 3 per vertex
  std::vector<std::uint32_t> triangles;  // 3 per triangle
  std::vector<std::uint32_t> owner;      // per triangle
};

}  // namespace understory
