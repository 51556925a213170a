// `grid` and `grid-cone` on balls in the places of the crowns, whose grids are known in closed form.
#include <cmath>
#include <memory>

#include "bench/kernel_cases.hpp"
#include "host/passes/grid.hpp"
#include "host/passes/grid_cone.hpp"
#include "kernels/shared/cone.h"
#include "sim/occlusion_grid.hpp"

namespace understory {
namespace {

/// Of a ball of radius 1: the cone that it fills; inside, half of the sphere.
const OcclusionGrid& ball_grid() {
  static const OcclusionGrid grid = [] {
    OcclusionGrid g;
    g.size = {32, 32, 32};
    g.low = glm::vec3(-2.8f);
    g.high = glm::vec3(2.8f);
    for (std::uint32_t z = 0; z < 32; ++z)
      for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 32; ++x) {
          const glm::vec3 p = g.position(x, y, z);
          const float d = glm::length(p), ratio = 1 / std::max(d, 1.0f);
          const float share = 0.5f * (1 - std::sqrt(1 - ratio * ratio));
          g.share.push_back(share);
          g.direction.push_back(-p / d * share * (1 - share));
        }
    open_border(g, GridBorder::fade);
    return unpacked(g, packed_cone(g));
  }();
  return grid;
}

std::vector<GridRecord> records_of(const BenchFragments& all) {
  std::vector<GridRecord> records;
  for (const ShadingSphere& ball : all.sphere_rows()) {
    GridRecord record{};
    const glm::vec3 centre(ball.x, ball.y, ball.z);
    for (int axis = 0; axis < 3; ++axis) {
      const float scale = 2 / (5.6f * ball.radius);
      record.to_box[5 * axis] = scale;
      record.to_box[4 * axis + 3] = -scale * centre[axis];
      record.axes[5 * axis] = 1;
    }
    record.faded_from = faded_from(ball_grid());
    record.width = record.height = record.depth = 32;
    record.group = ball.group;
    records.push_back(record);
  }
  return records;
}

double reference(const BenchFragments& all, const BenchFragment& f, bool cone) {
  double v = 1;
  for (const ShadingSphere& ball : all.sphere_rows()) {
    const glm::dvec3 p = (glm::dvec3(f.position) - glm::dvec3(ball.x, ball.y, ball.z)) / double(ball.radius);
    const OccludedDirections o = occluded_at(ball_grid(), p);
    const bool own = ball.group == all.owner_rows()[f.owner].group;
    double blocked = own ? std::max(2 * double(o.share) - 1, 0.0) : std::min(2 * double(o.share), 1.0);
    if (cone && own) continue;  // balls have no shadow of their own
    if (cone) {
      const Occluded here = {double(o.share), double(o.direction.x), double(o.direction.y), double(o.direction.z)};
      const Cone c = spread_cone(here);
      const double cosine = glm::dot(glm::dvec3(c.x, c.y, c.z), glm::dvec3(f.normal));
      blocked = c.opacity * clip_cosine(c.aperture, cosine);
    }
    v *= 1 - blocked;
  }
  return v;
}

}  // namespace

KernelCase grid_case(const std::string& method) {
  const bool cone = method == "grid-cone";
  return visibility_case(
      method,
      1e-3,  // positions of 100 m in float, in samples of 0.6 m
      [=](Device& device, BenchFragments& all, Buffer<float>& visibility) -> std::function<void()> {
        const auto table =
            std::make_shared<GridTable>(device, cone ? packed_cone(ball_grid()) : packed_share(ball_grid()));
        table->place(records_of(all));
        if (cone)
          return [&, table, pass = std::make_shared<GridConePass>(device, method, "multiply")] {
            pass->run(all.planes, all.owners, *table, visibility);
          };
        return [&, table, pass = std::make_shared<GridPass>(device, method)] {
          pass->run(all.planes, all.owners, *table, visibility);
        };
      },
      [cone](const BenchFragments& all, const BenchFragment& f) { return reference(all, f, cone); });
}

}  // namespace understory
