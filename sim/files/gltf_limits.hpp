// What assimp 5.2.5 does not check in glTF before it allocates, copies or recurses.
#pragma once
#include <filesystem>

namespace understory {

/// Reads only the JSON of a .gltf or .glb. Throws Error(invalid_input) naming the file if it is broken, if data lie
/// outside their buffers, if nodes form no tree, or if the mesh would exceed the caps of mesh.hpp once every primitive
/// holds its own copy of the vertices it shares (assimp#4998: 20,000 primitives of one accessor took all memory).
void check_gltf(const std::filesystem::path& file);

}  // namespace understory
