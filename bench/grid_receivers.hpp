// Which fragments of a frame a body's occlusion grid answers for, and how near the body they are.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sim/frame.hpp"

namespace understory {

/// Pixels of one frame that lie within a grid, by kind of receiver.
struct GridReceivers {
  std::vector<std::size_t> ground;   // terrain, at least one cell of the body's grid from every body
  std::vector<std::size_t> near;     // of these, where a grid of epsilon 0.02 would reach, however far this one does
  std::vector<std::size_t> contact;  // terrain within one cell
  std::vector<std::size_t> bodies;   // the occluders themselves
};

/// At most `most` of each kind, evenly spread over the frame. `geometry`: the same frame's triangles.
GridReceivers grid_receivers(const World& world, const Frame& frame, const PosedGeometry& geometry, std::size_t most);

/// Corners of the triangles of owners of class occluder, three a triangle; `owner` gets the owner of each triangle.
std::vector<glm::vec3> occluder_corners(const Frame& frame, const PosedGeometry& geometry,
                                        std::vector<std::uint32_t>* owner = nullptr);

}  // namespace understory
