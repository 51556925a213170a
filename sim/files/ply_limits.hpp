// What assimp 5.2.5 does not check in PLY: a damaged header makes it crash or allocate without end.
#pragma once
#include <filesystem>

namespace understory {

/// Walks a .ply once. Throws Error(invalid_input) naming the file if its header is not well formed, if it announces
/// more than the file holds or the caps of mesh.hpp allow, or if a face names a vertex that does not exist.
void check_ply(const std::filesystem::path& file);

}  // namespace understory
