#include "host/passes/draw_blades.hpp"

#include "sim/error.hpp"

namespace understory {

DrawBladesPass::DrawBladesPass(Device& device, bool wide_atomics)
    : lanes_(static_cast<std::size_t>(device.info().vector_width)),
      kernels_(raster_kernels(device, "draw_blades", "draw_blades", wide_atomics)) {}

void DrawBladesPass::run(std::size_t raster_pass, const RestBlades& rest, const GrassWind& wind,
                         const SwaySeries& series, const Buffer<BladeUnit>& units, std::uint32_t first,
                         std::uint32_t count, const TriangleTables& triangles, const CameraView& camera,
                         PosedVertices& posed, VisibilityBuffer& visible) {
  if (wind.series_count != series.size() || std::size_t{first} + count > units.size())
    throw Error(ErrorKind::unexpected, "draw_blades: " + std::to_string(count) + " units from " +
                                           std::to_string(first) + " on of " + std::to_string(units.size()) +
                                           ", a series of " + std::to_string(series.size()) + " samples");
  const auto items = static_cast<std::uint32_t>(count * blades_per_unit / lanes_);
  kernels_[raster_pass].launch(items, 64, rest.root_x, rest.root_y, rest.root_z, rest.length, rest.half_width,
                               rest.bend_x, rest.bend_y, rest.facing_x, rest.facing_y, rest.flexibility, rest.phase,
                               wind, series, units, first, items, triangles.chunks, camera, posed.points,
                               visible.words);
}

}  // namespace understory
