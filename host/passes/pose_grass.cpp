#include "host/passes/pose_grass.hpp"

#include "sim/error.hpp"

namespace understory {

PoseGrassPass::PoseGrassPass(Device& device)
    : lanes_(static_cast<std::size_t>(device.info().vector_width)),
      kernel_(device, "pose_grass", "pose_grass", "pose_grass") {}

void PoseGrassPass::run(const RestBlades& rest, const GrassWind& wind, const SwaySeries& series,
                        std::uint32_t first_blade, std::uint32_t blades, std::uint32_t first_vertex,
                        PosedVertices& posed) {
  if (wind.series_count != series.size() || blades % blades_per_group != 0 ||
      first_vertex + std::size_t{blades} * vertices_per_blade > posed.points.size())
    throw Error(ErrorKind::unexpected, "pose_grass: " + std::to_string(blades) + " blades at vertex " +
                                           std::to_string(first_vertex) + " with a series of " +
                                           std::to_string(series.size()) + " samples do not fit " +
                                           std::to_string(posed.points.size()) + " vertices and a wind of " +
                                           std::to_string(wind.series_count) + " samples");
  kernel_.launch(blades / lanes_, blades_per_group / lanes_, rest.root_x, rest.root_y, rest.root_z, rest.length,
                 rest.half_width, rest.bend_x, rest.bend_y, rest.facing_x, rest.facing_y, rest.flexibility, rest.phase,
                 wind, series, first_blade, first_vertex, posed.points);
}

}  // namespace understory
