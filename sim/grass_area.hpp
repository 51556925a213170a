// Where the blades of a scene's grass are and how they lean: the area that they turn to the sky, voxel by voxel.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sim/world.hpp"

namespace understory {

/// Directions are told apart by their height only: ring r of `sky_rings` holds an equal share of the hemisphere, about
/// the cosine to the vertical (r + 1/2) / sky_rings. Blades face all azimuths alike.
inline constexpr int sky_rings = 6;
inline double ring_cosine(int ring) { return (ring + 0.5) / sky_rings; }

/// Mean over the azimuth of |n.w| for a unit normal and a direction with these cosines to the vertical: the area that a
/// leaf turns to a ring of the sky. Warren Wilson 1960, "Inclined point quadrats", New Phytologist 59.
double mean_projection(double normal_cosine, double direction_cosine);

/// Columns of square cells that stand on the ground, each cut into slabs of equal height above it.
/// Empty (0 columns) without grass.
struct GrassArea {
  Region extent;
  std::uint32_t columns = 0, rows = 0, slabs = 0;
  double cell = 0, slab = 0;      // m
  double datum = 0;               // m above the origin: zero of `ground`
  std::vector<float> ground;      // per column, at its middle, m above `datum`
  std::vector<float> projection;  // [slab][row][column][ring]: area turned to the ring per volume, 1/m
  // As `projection`: of it, what belongs to the very blade that a place on a blade is on; the mean over all such
  // places.
  std::vector<float> own;  // empty: nothing
  std::size_t column_count() const { return std::size_t{columns} * rows; }
};

/// Grass fields in the mean wind, and plants of a mesh with blades at rest, stems and ears (half their surface)
/// included. Cells are a thirty-second of the grass' height, but 1.5 cm or more, and as wide as it takes for 65,536 of
/// them, with a border of twice the height around the grass.
GrassArea measure_grass(const World& world);

}  // namespace understory
