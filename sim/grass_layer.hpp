// The light among grass: how much sky is seen at each height above each place, whatever way one faces there.
// The mean visibility of a plane-parallel layer (FORMULAS.md, "grass-transmittance") with what real grass has besides:
// leaf angles, a profile, tufts, rows and edges. Blades in a voxel are taken as scattered at random (Beer-Lambert).
// A place on a blade is not random: its own blade is there for certain, and being flat hides nothing from it.
#pragma once
#include <cstdint>
#include <vector>

#include "sim/grass_area.hpp"

namespace understory {

/// V_c(n) = (1 + n_z) (above + zenith n_z) + x n_x + y n_y + below (1 - n_z) for a unit normal n.
struct LayerLight {
  float above = 0.5f, zenith = 0, x = 0, y = 0;
  float below = 0;  // 0 where directions below the horizon are dark
};

/// Nodes stand at the middle of every column and at heights level * level_height above its ground, the highest where
/// the grass ends. The lowest hold the light on the ground, the others that on blades; taken for what else stands in
/// the grass, they are brighter by about 0.005, the part of a blade itself. No columns: no grass.
struct GrassLayer {
  Region extent;
  std::uint32_t columns = 0, rows = 0, levels = 0;
  double level_height = 0;        // m
  double datum = 0;               // m above the origin: zero of `ground`
  std::vector<float> ground;      // per column, row-major from the low corner, m above `datum`
  std::vector<LayerLight> light;  // [row][column][level]
};

/// Whether directions below the horizon see sky: under `sky: sphere` without terrain.
bool open_below_grass(const World& world);

/// The layer of a scene's grass in the mean wind.
GrassLayer light_grass(const World& world);

/// The same for a given distribution of blades.
GrassLayer light_grass(const GrassArea& area, bool open_below);

}  // namespace understory
