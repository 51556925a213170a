// Hashes the program itself, the scene with every default filled in, and the files it names.
#include "host/app/run_identity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "host/app/checksum.hpp"
#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"

namespace understory {
namespace {

std::map<std::string, std::string> hash_inputs(const Scene& scene) {
  std::map<std::string, std::string> hashes;
  // By the scene's key: two folders may hold files of one name.
  const auto add = [&](const std::string& key, const std::filesystem::path& file) {
    if (!file.empty()) hashes[key] = sha256_of_file(file);
  };
  add("terrain", scene.terrain.file);
  add("wind.record", scene.wind.record);
  add("environment.map", scene.environment.map);
  for (const SpeciesSource& species : scene.species) add("species." + species.name + ".mesh", species.mesh);
  for (std::size_t i = 0; i < scene.occluders.size(); ++i) {
    const OccluderSource& occluder = scene.occluders[i];
    const std::string key = "occluders." + std::to_string(i);
    add(key + ".motion.record", occluder.motion_record);
    for (std::size_t part = 0; part < occluder.parts.size(); ++part)
      add(key + ".parts." + std::to_string(part) + ".mesh", occluder.parts[part].mesh);
  }
  return hashes;
}

}  // namespace

RunRecord describe_run(const Scene& scene, const std::vector<std::string>& dumps, int supersample) {
  RunRecord record;
  record.version = UNDERSTORY_VERSION;
  record.program_sha256 = sha256_of_file("/proc/self/exe");
  record.scene = scene.file.string();
  record.scene_sha256 = sha256_of_text(resolved_scene(scene, PathStyle::file_name));
  record.inputs = hash_inputs(scene);
  record.seed = scene.seed;
  record.width = scene.image.width;
  record.height = scene.image.height;
  record.supersample = supersample;
  record.dumps = dumps;
  record.methods = {{"tree", scene.methods.tree},
                    {"grass", scene.methods.grass},
                    {"crowns", scene.methods.crowns},
                    {"occluders", scene.methods.occluders},
                    {"near", scene.methods.near}};
  return record;
}

std::vector<std::string> parse_dumps(const std::string& text) {
  static constexpr std::array known = {"exr", "png", "vtk", "ply"};
  std::vector<std::string> asked, dumps;
  std::istringstream names(text);
  for (std::string name; std::getline(names, name, ',');) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ErrorKind::usage, fmt::format("--dump {}: unknown format '{}' (allowed: {}, separated by commas)",
                                                text, name, fmt::join(known, ", ")));
    asked.push_back(name);
  }
  for (const char* name : known)
    if (std::find(asked.begin(), asked.end(), name) != asked.end()) dumps.push_back(name);
  if (dumps.empty())
    throw Error(ErrorKind::usage, fmt::format("--dump: nothing to write (allowed: {})", fmt::join(known, ", ")));
  return dumps;
}

}  // namespace understory
