// What `crown-field` and `crown-baked` need of a scene: every plant prototype baked once, or read from the cache.
#pragma once
#include "host/passes/crown_baked.hpp"
#include "host/passes/crown_field.hpp"
#include "sim/frame.hpp"
#include "sim/world.hpp"

namespace understory {

/// Fields of the prototypes that plants of this world stand on, for its sky.
CrownFieldTables upload_crown_fields(Device& device, const World& world);

/// Texels of the faces of the prototypes that plants of this world stand on, for its sky; other faces have none.
CrownBakedTables upload_crown_baked(Device& device, const World& world);

/// Rest points of fragments that another program rendered, whose triangles are unknown: each plant's fragments are
/// moved back with its root, as if the plant stood still and stiff. `planes` get rest_position and rest_normal.
void map_back_rigidly(Device& device, const World& world, const Frame& frame, FragmentPlanes& planes);

}  // namespace understory
