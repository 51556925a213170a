// Meshes from other tools: OBJ, PLY, glTF and GLB, geometry and names only, read by assimp.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "sim/prototype.hpp"
#include "sim/scene.hpp"

namespace understory {

/// Largest mesh that is read: a broken or hostile file must not take the machine's memory.
inline constexpr std::uint64_t largest_mesh_bytes = std::uint64_t{1} << 30;
inline constexpr std::uint64_t largest_mesh_vertices = 64'000'000, largest_mesh_triangles = 64'000'000;

/// The triangles of a file, one part per node and material, positions in the file's unit, turned to z up.
/// A part is `blade` if its material's name matches one of `blade_patterns` (`*` and `?`, any case), `leaf` if it
/// matches one of `leaf_patterns`, else `wood`. Equal positions within a part are one vertex. Throws
/// Error(invalid_input) naming the file and what is wrong: missing, of another kind, broken, too large, without faces,
/// or with a vertex that is not finite.
RawMesh read_mesh(const std::filesystem::path& file, UpAxis up, const std::vector<std::string>& leaf_patterns = {},
                  const std::vector<std::string>& blade_patterns = {});

}  // namespace understory
