#include "host/passes/grid.hpp"

#include <algorithm>

#include "kernels/shared/fragment_tiles.h"
#include "sim/error.hpp"

namespace understory {
namespace {

std::string self_option(const std::string& method) {
  if (method == "grid") return "";
  if (method == "grid-self-paper") return " -DSELF_PAPER";
  throw Error(ErrorKind::unexpected, "method '" + method + "' is not one of grid, grid-self-paper");
}

}  // namespace

GridPass::GridPass(Device& device, const std::string& method, int lanes)
    : method_(method),
      lanes_(device, lanes, method),
      tiles_(device, method),
      kernel_(device, "grid", "shade_grid", method, lanes_.option() + self_option(method)) {}

void GridPass::run(const FragmentPlanes& planes, const OwnerTables& owners, const GridTable& grids,
                   Buffer<float>& visibility) {
  require_planes(method_.c_str(), planes, visibility);
  require_some(method_.c_str(), "grid samples", grids.samples().size());
  tiles_.run(planes, grids);
  const std::uint32_t items = lanes_.items(planes);
  const auto row_length = static_cast<std::uint32_t>(std::max<std::size_t>(planes.row_length, UNIT));
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.position_z, planes.owner,
                 owners.group, owners.rows(), grids.records(), grids.count(), grids.samples(), tiles_.listed(),
                 tiles_.lists(), tiles_.capacity(), row_length, items, visibility, planes.validity);
}

}  // namespace understory
