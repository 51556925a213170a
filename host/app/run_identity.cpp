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
  const auto add = [&](const std::filesystem::path& file) {
    if (!file.empty()) hashes[file.filename().string()] = sha256_of_file(file);
  };
  add(scene.terrain.file);
  add(scene.wind.record);
  for (const SpeciesSource& species : scene.species) add(species.mesh);
  for (const OccluderSource& occluder : scene.occluders) {
    add(occluder.motion_record);
    for (const OccluderPart& part : occluder.parts) add(part.mesh);
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
                    {"occluders", scene.methods.occluders}};
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
