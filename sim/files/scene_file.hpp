// Scene files: YAML for people, JSON for programs, through one strict decoder (scene_keys.hpp is its table of keys).
// Angles are degrees in files and radians in `Scene`; everything else is SI in both.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "sim/scene.hpp"

namespace understory {

/// Reads a scene. `overrides` are `wind.speed=4.2`, with list positions counted from 0 (`occluders.0.name=ball`) and
/// any YAML flow value on the right; `null` takes the key out. Relative paths start at the file's folder and may begin
/// with an environment variable, `${UNDERSTORY_DATA}/plants/birch.glb`. A scene in large coordinates gets a zero near
/// its camera, and its origin says where that is (local_origin.hpp). Throws Error(invalid_input): `file:line:column:
/// key: value: what is allowed`, the first of what validate_scene lists.
Scene load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The methods of a scene that consists of `methods.KEY=VALUE` overrides alone: for images without a scene.
/// Throws Error(invalid_input).
Methods load_methods(const std::vector<std::string>& overrides);

/// Everything that is wrong with a scene, in the order of the file, one line each; empty: load_scene accepts it.
/// Includes files that are missing; what is inside meshes and rasters is checked by their readers.
std::vector<std::string> validate_scene(const std::filesystem::path& file,
                                        const std::vector<std::string>& overrides = {});

/// How resolved_scene writes the paths of meshes, rasters and records.
enum class PathStyle {
  absolute,   // can be read back from any folder
  file_name,  // the same text wherever the scene lies: for hashes
};

/// The scene with every default filled in, as JSON text that load_scene reads back to the same Scene.
std::string resolved_scene(const Scene& scene, PathStyle paths = PathStyle::absolute);

/// JSON Schema (draft 7) of scene files, made from the decoder's table: sim/scenes/scene.schema.json.
std::string scene_json_schema();

/// All keys with type, range, default and meaning, one a line, for `--help`.
std::string scene_help();

}  // namespace understory
