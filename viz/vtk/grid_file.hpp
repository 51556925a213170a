// Occlusion grids as VTK image data, which ParaView opens; and read back.
#pragma once
#include <filesystem>

#include "sim/occlusion_grid.hpp"

namespace understory {

/// 8-bit as Malmer et al. 2005 store them, or as computed.
enum class GridEncoding { bytes, floats };

/// Image data (.vti) in the frame of the body: point data `occlusion`, the share of the sphere, and in a cone grid
/// `direction`, (1/4 pi) times the integral of the occluded directions. As bytes: unorm8, and snorm8 of 4 direction,
/// each sample one and three bytes. Field data `border`. Throws Error(input_output).
void write_grid(const std::filesystem::path& path, const OcclusionGrid& grid, GridEncoding encoding);

/// Either encoding. Throws Error(invalid_input) for a file that is none.
OcclusionGrid read_grid(const std::filesystem::path& path);

}  // namespace understory
