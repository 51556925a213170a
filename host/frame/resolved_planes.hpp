// What the resolve writes for a plan, beside the planes of every frame.
#pragma once
#include "host/frame/plan.hpp"
#include "host/passes/resolve.hpp"

namespace understory {

inline ResolvedPlanes resolved_planes(const Plan& plan) {
  ResolvedPlanes resolved;
  resolved.grass_height = plan.has("grass-height") || plan.has("grass-transmittance");  // frames keep the heights
  resolved.rest_point = plan.has("crown-field");
  resolved.texel = plan.has("crown-baked");
  return resolved;
}

/// Pixels drawn around the image on every side, for what reads neighbours.
inline int guard_band(const Methods& methods) { return methods.near == "none" ? 0 : methods.near_field.guard; }

}  // namespace understory
