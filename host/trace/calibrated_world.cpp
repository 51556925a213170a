#include "host/trace/calibrated_world.hpp"

#include <cstring>
#include <optional>

#include "host/trace/bake_cache.hpp"
#include "host/trace/calibrate.hpp"

namespace understory {
namespace {

/// The prototype of a species that stands somewhere with a crown; null without.
const Prototype* prototype_of(const World& world, std::size_t species) {
  for (const Instance& instance : world.instances)
    if (instance.species == static_cast<std::int32_t>(species) && instance.crown >= 0)
      return &world.prototypes[instance.prototype];
  return nullptr;
}

/// Takes what the scene file gives instead.
void keep_given(const SpeciesSource& source, CrownModel& model) {
  if (source.alpha_rho >= 0)
    model.alpha_rho = model.alpha_rho_ellipsoid = model.alpha_rho_shells = model.alpha_rho_levels =
        static_cast<float>(source.alpha_rho);
  if (source.reeves_blau_extinction >= 0) {
    model.reeves_blau_ambient = static_cast<float>(source.reeves_blau_ambient);
    model.reeves_blau_extinction = static_cast<float>(source.reeves_blau_extinction);
  }
}

/// Raised whenever the same plant would get other constants.
constexpr int method_version = 3;

ContentHash hash_of(const Prototype& prototype, double ambient) {
  ContentHash hash;
  hash.add(method_version);
  hash.add(ambient);
  hash.add(prototype.crown.shells.size());
  hash.add(prototype.vertices.x);
  hash.add(prototype.vertices.y);
  hash.add(prototype.vertices.z);
  hash.add(prototype.triangles);
  for (const TriangleRun& run : prototype.runs) {
    hash.add(static_cast<int>(run.surface));
    hash.add(run.first);
    hash.add(run.count);
  }
  return hash;
}

constexpr std::size_t constants_of_crown = 11;  // before those of the clustered spheres

std::string bytes_of(const CrownModel& m) {
  std::vector<float> numbers{m.alpha_rho,
                             m.alpha_rho_ellipsoid,
                             m.alpha_rho_shells,
                             m.alpha_rho_levels,
                             m.extinction,
                             m.shell_scale,
                             m.near_share,
                             static_cast<float>(m.shape),
                             m.reeves_blau_ambient,
                             m.reeves_blau_extinction,
                             m.opacity};
  numbers.insert(numbers.end(), m.shell_opacity.begin(), m.shell_opacity.end());
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

std::optional<CrownModel> model_of(const std::string& bytes, std::size_t shells) {
  if (bytes.size() != (constants_of_crown + shells) * sizeof(float)) return std::nullopt;
  std::vector<float> n(bytes.size() / sizeof(float));
  std::memcpy(n.data(), bytes.data(), bytes.size());
  CrownModel m;
  m.alpha_rho = n[0], m.alpha_rho_ellipsoid = n[1], m.alpha_rho_shells = n[2], m.alpha_rho_levels = n[3];
  m.extinction = n[4], m.shell_scale = n[5], m.near_share = n[6], m.shape = static_cast<CrownShape>(n[7]);
  m.reeves_blau_ambient = n[8], m.reeves_blau_extinction = n[9], m.opacity = n[10];
  m.shell_opacity.assign(n.begin() + constants_of_crown, n.end());
  return m;
}

}  // namespace

bool reads_calibration(const Methods& methods) {
  return (methods.tree != "none" && methods.tree != "ambient") || methods.crowns != "none";
}

std::vector<std::string> calibrate_world(World& world) {
  std::vector<std::string> calibrated;
  for (std::size_t i = 0; i < world.crown_models.size(); ++i) {
    const Prototype* prototype = prototype_of(world, i);
    if (!prototype) continue;
    const SpeciesSource& species = world.scene.species[i];
    // A of 1 is what a scene without one has: then both constants of Reeves and Blau are fitted.
    const double ambient = species.reeves_blau_ambient < 1 ? species.reeves_blau_ambient : 0;
    const ContentHash hash = hash_of(*prototype, ambient);
    const std::optional<std::string> kept = load_bake("calibration", hash);
    std::optional<CrownModel> model;
    if (kept) model = model_of(*kept, prototype->crown.shells.size());
    if (!model) {
      model = calibrate(*prototype, ambient).model;
      store_bake("calibration", hash, bytes_of(*model));
      calibrated.push_back(species.name);
    }
    world.crown_models[i] = *model;
    keep_given(species, world.crown_models[i]);
  }
  return calibrated;
}

}  // namespace understory
