#include "host/passes/grid_cone.hpp"

#include <algorithm>

#include "kernels/shared/fragment_tiles.h"
#include "sim/error.hpp"

namespace understory {
namespace {

std::string cone_options(const std::string& method, const std::string& combine) {
  if (method != "grid-cone" && method != "grid-cone-paper")
    throw Error(ErrorKind::unexpected, "method '" + method + "' is not one of grid-cone, grid-cone-paper");
  if (combine != "multiply" && combine != "simple" && combine != "merge" && combine != "union")
    throw Error(ErrorKind::unexpected, "combining rule '" + combine + "' is not one of multiply, simple, merge, union");
  return " -DCOMBINE=" + (combine == "union" ? "merge -DUNION" : combine) +
         (method == "grid-cone-paper" ? " -DPAPER_CONE" : "");
}

}  // namespace

GridConePass::GridConePass(Device& device, const std::string& method, const std::string& combine, int lanes, bool cones)
    : method_(method),
      lanes_(device, lanes, method),
      cones_(cones),
      tiles_(device, method),
      kernel_(device, "grid_cone", "shade_grid_cone", method,
              lanes_.option() + cone_options(method, combine) + (cones ? " -DCONES" : "")) {}

void GridConePass::run(const FragmentPlanes& planes, const OwnerTables& owners, const GridTable& grids,
                       Buffer<float>& visibility, const ConePlanes* cones) {
  require_planes(method_.c_str(), planes, visibility);
  require_some(method_.c_str(), "grid samples", grids.samples().size());
  if (cones_ != (cones != nullptr)) throw Error(ErrorKind::unexpected, method_ + ": cone planes for a pass without");
  if (cones) require_size(method_.c_str(), "cone share", cones->share.size(), planes.padded_fragments);
  tiles_.run(planes, grids);
  const std::uint32_t items = lanes_.items(planes);
  const auto row_length = static_cast<std::uint32_t>(std::max<std::size_t>(planes.row_length, UNIT));
  const auto launch = [&](const auto&... more) {
    kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.normal_x,
                   planes.normal_y, planes.normal_z, planes.owner, owners.group, owners.rows(), grids.records(),
                   grids.count(), grids.samples(), tiles_.listed(), tiles_.lists(), tiles_.capacity(), row_length,
                   items, visibility, planes.validity, more...);
  };
  if (cones)
    launch(cones->axis_x, cones->axis_y, cones->axis_z, cones->aperture, cones->share);
  else
    launch();
}

}  // namespace understory
