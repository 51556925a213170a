// Tiles of an image of whose pixels farthest_depth.cl keeps the farthest, row by row, for device and host.
#ifndef UNDERSTORY_FARTHEST_DEPTH_H
#define UNDERSTORY_FARTHEST_DEPTH_H

#define FARTHEST_TILE 8u  // pixels, each way

#ifdef __OPENCL_C_VERSION__
static inline uint farthest_tiles(uint pixels) { return (pixels + FARTHEST_TILE - 1u) / FARTHEST_TILE; }
#else
#include <cstdint>
namespace understory {
inline std::uint32_t farthest_tiles(std::uint32_t pixels) { return (pixels + FARTHEST_TILE - 1u) / FARTHEST_TILE; }
}  // namespace understory
#endif
#endif
