#include "bench/kernel_costs.hpp"

#include <algorithm>
#include <string>

#include "sim/error.hpp"

namespace understory {
namespace {

// kernel, item, bytes read, written, operations, exponentials, gathers, atomics, streams, what keeps it from its roof
constexpr KernelCost costs[] = {
    {"ambient", "fragment", 12, 4, 23, 0, 4, 0, false, "four gathers a fragment from the ground's grid"},
    {"open-dome", "fragment", 4, 4, 2, 0, 0, 0, true, ""},
    {"grass-height", "fragment", 12, 4, 1, 0, 0, 0, true, ""},
    {"grass-transmittance", "fragment", 24, 4, 56, 0, 5, 0, false,
     "each fragment gathers four heights of the ground and eight numbers at each of four nodes"},
    {"reeves-blau", "fragment", 16, 4, 33, 1, 0, 0, true, ""},
    {"sphere-cap", "fragment", 28, 4, 51, 1, 0, 0, true, ""},
    {"ellipsoid-cap", "fragment", 28, 4, 96, 1, 0, 0, true, ""},
    {"shells-cap", "fragment", 28, 4.4, 84, 1, 0, 0, false,
     "five shells are tried one after another; each waits for the comparison before it"},
    {"crown-transmittance", "fragment", 28, 4, 91, 1, 0, 0, false,
     "two roots and a quartic one after another: latency of the chain, not throughput"},
    {"crown-transmittance/dome", "fragment", 28, 4, 106.5, 1, 0, 0, false,
     "three roots and two quartics one after another: latency of the chain, not throughput"},
    {"crown-field", "fragment", 28, 4, 52, 0, 3, 0, false,
     "three words a fragment from a table larger than the second-level cache, and the unpacking of their bytes"},
    {"crown-baked", "fragment", 8, 4, 15, 0, 1, 0, false, "one word a fragment from a table of 12.8 MB: cache misses"},
    {"solid-angle", "fragment", 48, 7, 1316, 1, 0, 0, false,
     "short loops over lists whose length differs from tile to tile, a division and a root for each sphere"},
    {"solid-angle-exact", "fragment", 48, 7, 1940, 1, 0, 0, false,
     "short loops over lists whose length differs from tile to tile; divisions, roots and arc tangents for each "
     "sphere"},
    {"solid-angle-cosine", "fragment", 48, 7, 1808, 1, 0, 0, false,
     "short loops over lists whose length differs from tile to tile; divisions and roots for each sphere"},
    {"solid-angle-cosine/each", "fragment", 48, 7, 1808, 1, 0, 0, false,
     "all 64 spheres for every fragment; divisions and roots, which take longer than multiplications"},
    {"grid", "fragment", 40, 7.6, 1669, 0, 0, 0, false,
     "as many grids as a tile lies in, one after another, with eight corners gathered from each that holds a fragment"},
    {"grid-cone", "fragment", 52, 7.6, 2375, 0, 0, 0, false,
     "as `grid`, then clipping of the cones, whose branches the tile takes together"},
    {"combine", "fragment", 16, 4, 6, 0, 0, 0, true, ""},
    {"environment", "fragment", 40, 12, 158, 0, 36, 0, false, "36 gathers a fragment from two tables"},
    {"pose-mesh", "vertex", 16.5, 16, 89, 0, 0, 0, true, ""},
    {"pose-grass", "blade", 44, 112, 333, 0, 8, 0, true, ""},
    {"rasterise-mesh", "triangle", 44, 16, 170, 0, 0, 3.5, false,
     "edges in whole numbers, whose operations are not counted"},
    {"rasterise-grass", "triangle", 36, 25.6, 129, 0, 0, 4.27, false,
     "edges in whole numbers, whose operations are not counted"},
    {"draw-blades", "blade", 44, 112, 572, 0, 8, 0, false,
     "edges in whole numbers and pixels, neither of which is counted"},
    {"draw-far", "piece", 48, 48, 392, 0, 0, 1, false,
     "edges in whole numbers, whose operations are not counted, and branches at every pixel"},
    {"resolve", "pixel", 13.5, 36, 77, 0, 9, 0, false, "corners are gathered through two indirections: cache misses"},
    {"farthest-depth", "pixel", 8, 0.0625, 0, 0, 0, 0, false,
     "a work-item looks at the 64 words of a tile one by one, of eight rows far from each other"},
    {"check-fragments", "fragment", 28, 16, 17, 0, 0, 0, true, ""},
    {"normals-from-depth", "pixel", 8, 12, 92.4, 0, 7, 0, false,
     "one pixel per work-item with branches at its neighbours"},
    {"obscurance-line", "pixel", 20, 4, 443, 0, 5, 0, false,
     "each of five lines gathers a row of seven pixels, which shuffles sort by pixel; clamps are not counted"},
    {"obscurance-point", "pixel", 20, 4, 1064, 0, 12, 0, false,
     "a division for each of twelve points, then a gather; clamps are not counted"},
    {"screen-rays", "pixel", 20, 4, 7079, 1, 111, 0, false,
     "a gather and three divisions a step; half of its instructions are clamps, comparisons and conversions, which are "
     "not counted; steps until the longest ray of 16 lanes ends"},
    {"depth-moments", "pixel", 24, 16.5, 71, 0, 0, 0, false,
     "32 taps for each texel of a coarser level, one texel per work-item"},
    {"obscurance-area", "pixel", 20, 4, 876, 0, 96, 0, false,
     "96 gathers a pixel: eight texels of three planes for each of four areas"},
    {"obscurance-blur", "pixel", 48, 8, 464, 0, 0, 0, false,
     "eight neighbours of five planes each way, all from caches, a root for each"},
    {"obscurance-half", "pixel", 20, 20, 0, 0, 0, 0, false,
     "reads every other element of every other row: half of each line is fetched in vain"},
    {"obscurance-upsample", "pixel", 21, 4, 143, 0, 20, 0, false, "four neighbours of five planes are gathered"},
};

}  // namespace

std::span<const KernelCost> kernel_costs() { return costs; }

const KernelCost& cost_of(std::string_view kernel) {
  const auto found =
      std::find_if(std::begin(costs), std::end(costs), [&](const auto& c) { return c.kernel == kernel; });
  if (found == std::end(costs))
    throw Error(ErrorKind::unexpected, "bench/kernel_costs.cpp has no row for '" + std::string(kernel) + "'");
  return *found;
}

}  // namespace understory
