// A walking person as an occluder of eleven rigid parts, one occlusion grid each: Malmer et al. 2005, figures 9 and 13.
// Parts: torso with head; left and right upper arm, forearm, thigh, shank, foot. Steps follow the path that the scene
// gives, so that a foot on the ground stays where it is however the body speeds up, slows down, turns or climbs.
#pragma once
#include <functional>

#include "sim/scene.hpp"

namespace understory {

inline constexpr int walker_parts = 11;

/// The source with its parts made and posed. Parts stand in scene coordinates: the result has no path of its own and is
/// not `on_terrain`. `source.keyframes`: path of the point on the ground below the hips, facing along its x axis;
/// `source.height`: m, > 0. `ground_at`: height of the ground at a place, m; read when the source is `on_terrain`.
/// Throws Error(invalid_input) for a path of more than 10,000 strides.
OccluderSource make_walker(const OccluderSource& source, const std::function<double(glm::dvec2)>& ground_at);

}  // namespace understory
