#include "host/passes/ambient.hpp"

#include "sim/error.hpp"

namespace understory {
namespace {

// A buffer cannot be empty: without grass it holds one cell that nobody reads.
std::vector<float> cells_of(const GroundCover& cover) {
  const std::size_t cells = static_cast<std::size_t>(cover.columns) * cover.rows;
  require_size("ambient", "ground cover", cover.visibility.size(), cells);
  return cells == 0 ? std::vector<float>{1.0f} : cover.visibility;
}

}  // namespace

GroundCoverTable::GroundCoverTable(Device& device, const GroundCover& cover)
    : extent_(cover.extent),
      columns_(cover.columns),
      rows_(cover.rows),
      visibility_(device, std::span<const float>(cells_of(cover)), "ground cover") {}

GroundCoverGrid GroundCoverTable::grid(glm::dvec3 eye) const {
  GroundCoverGrid grid{};
  if (columns_ == 0 || rows_ == 0) {
    grid.low_x = INFINITY;  // no point lies right of it
    return grid;
  }
  const glm::dvec2 size = extent_.high - extent_.low;
  grid.low_x = static_cast<float>(extent_.low.x - eye.x);
  grid.low_y = static_cast<float>(extent_.low.y - eye.y);
  grid.cells_per_metre_x = static_cast<float>(columns_ / size.x);
  grid.cells_per_metre_y = static_cast<float>(rows_ / size.y);
  grid.columns = columns_;
  grid.rows = rows_;
  return grid;
}

AmbientPass::AmbientPass(Device& device, int lanes)
    : lanes_(device, lanes, "ambient"), kernel_(device, "ambient", "shade_ambient", "ambient", lanes_.option()) {}

void AmbientPass::run(const FragmentPlanes& planes, const OwnerTables& owners, double constant,
                      std::uint32_t constant_classes, const GroundCoverTable& cover, glm::dvec3 eye,
                      Buffer<float>& visibility) {
  require_planes("ambient", planes, visibility);
  const std::uint32_t items = lanes_.items(planes);
  const auto terrain = static_cast<std::uint32_t>(SurfaceClass::terrain);
  kernel_.launch(items, lanes_.local_size(), planes.position_x, planes.position_y, planes.owner, owners.surface_class,
                 owners.rows(), static_cast<float>(constant), constant_classes, terrain, cover.grid(eye),
                 cover.visibility(), items, visibility);
}

}  // namespace understory
