// From device planes to a Frame, and back for planes that were rendered elsewhere.
#pragma once
#include "host/frame/geometry.hpp"
#include "host/frame/visibility.hpp"
#include "host/passes/planes.hpp"
#include "sim/frame.hpp"

namespace understory {

/// Positions (camera-relative + `eye`), normals, depth, owner, validity, heights. frame.width and height are set;
/// planes with longer rows have as many pixels more on every side, which are left out.
void read_planes(const FragmentPlanes& planes, glm::dvec3 eye, Frame& frame);

/// V_c, the terms, and the environment's light where there is one.
void read_visibility(const VisibilityPasses& passes, std::size_t row_length, Frame& frame);

/// The frame's planes on the device, camera-relative to `eye`.
FragmentPlanes upload_planes(Device& device, const Frame& frame, glm::dvec3 eye);

/// The posed triangles of the last frame; `eye` is the camera's position relative to the origin.
PosedGeometry read_geometry(const Geometry& geometry, glm::dvec3 eye);

}  // namespace understory
