#include "bench/accuracy_scenes.hpp"

#include <fmt/format.h>

#include "bench/random_crown.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

constexpr double gust_speed = 8;  // m/s
constexpr const char* tree_methods[] = {"reeves-blau",       "sphere-cap",          "ellipsoid-cap", "shells-cap",
                                        "shells-cap-levels", "crown-transmittance", "crown-field",   "crown-baked"};
constexpr const char* grass_methods[] = {"grass-height", "grass-transmittance"};
constexpr const char* crowns_methods[] = {"none", "solid-angle-cosine", "crown-shells"};

struct MeshSubject {
  const char *name, *file;
  std::vector<std::string> leaf_materials, blade_materials;
  bool is_grass() const { return !blade_materials.empty(); }
};

const std::vector<MeshSubject>& mesh_subjects() {
  static const std::vector<std::string> usual = SpeciesSource{}.leaf_materials;
  static const std::vector<std::string> grass = {"leaf*", "blade*"};  // stems and ears are wood: closed surfaces
  static const std::vector<MeshSubject> subjects = {
      {"black oak", "plants/tree_broadleaf_black_oak.glb", usual, {}},
      {"poplar", "plants/tree_poplar_lombardy.glb", usual, {}},
      {"bougainvillea", "plants/shrub_bougainvillea.glb", usual, {}},
      {"walnut", "plants/tree_walnut_digitized.glb", usual, {}},
      {"coffeetree", "plants/tree_scanned_qsm_coffeetree.glb", usual, {}},
      {"eucalyptus", "plants/sapling_eucalyptus_pilularis.glb", usual, {}},
      {"birch", "plants/birch.glb", usual, {}},
      {"wheat", "plants/grass_wheat_6x6.glb", {}, grass},
      {"lawn", "plants/grass_lawn_2m.glb", {}, grass},
  };
  return subjects;
}

/// Still air, no ground, every direction sees sky.
Scene empty_scene() {
  Scene scene;
  scene.sky = Sky::sphere;
  scene.has_terrain = false;
  scene.wind.speed = 0;
  return scene;
}

void put_on_ground(Scene& scene, double half_extent) {
  scene.sky = Sky::dome;
  scene.has_terrain = true;
  scene.terrain.extent = {{-half_extent, -half_extent}, {half_extent, half_extent}};
}

SpeciesSource species_of(const std::string& name, const std::filesystem::path& file,
                         const std::vector<std::string>& leaf_materials,
                         const std::vector<std::string>& blade_materials = {}) {
  if (!std::filesystem::exists(file))
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("{}: not there; the accuracy table needs the data folder, see UNDERSTORY_DATA", file.string()));
  SpeciesSource species;
  species.name = name;
  species.mesh = file;
  species.leaf_materials = leaf_materials;
  species.blade_materials = blade_materials;
  return species;
}

void plant(Scene& scene, const std::string& species, glm::dvec2 at, double yaw) {
  PlantPlacement placement;
  placement.species = species;
  placement.spots.push_back({at, yaw, 1});
  scene.plants.push_back(placement);
}

std::vector<AccuracyMethod> each_tree_method(const std::string& crowns) {
  std::vector<AccuracyMethod> methods;
  for (const char* tree : tree_methods) {
    Methods choice;
    choice.tree = tree;
    choice.crowns = crowns;
    methods.push_back({tree, choice});
  }
  return methods;
}

std::vector<AccuracyMethod> each_grass_method() {
  std::vector<AccuracyMethod> methods;
  for (const char* grass : grass_methods) {
    Methods choice;
    choice.grass = grass;
    methods.push_back({grass, choice});
  }
  return methods;
}

void add_plants(const std::filesystem::path& data, std::vector<AccuracySubject>& subjects) {
  for (const char* setting : {"sphere", "dome", "gust"})
    for (const MeshSubject& mesh : mesh_subjects()) {
      AccuracySubject subject;
      subject.name = mesh.name;
      subject.setting = setting;
      subject.scene = empty_scene();
      subject.scene.species.push_back(
          species_of(mesh.name, data / mesh.file, mesh.leaf_materials, mesh.blade_materials));
      plant(subject.scene, mesh.name, {0, 0}, 0);
      subject.methods = mesh.is_grass() ? each_grass_method() : each_tree_method("solid-angle-cosine");
      subject.ground = subject.setting != "sphere";
      subject.truth_itself = subject.name == "black oak" && subject.setting != "gust";
      if (subject.ground) put_on_ground(subject.scene, 60);
      if (subject.setting == "gust") {
        subject.scene.wind.speed = gust_speed;
        subject.first_time = 3;
        subject.time_step = 1.3;
      }
      subjects.push_back(subject);
    }
}

/// 200,000 leaves in a ball.
void add_random_crowns(const std::filesystem::path& scratch, std::vector<AccuracySubject>& subjects) {
  constexpr double radius = 5;  // m
  for (const double optical_radius : {0.25, 1.0, 4.0, 16.0}) {
    AccuracySubject subject;
    subject.name = fmt::format("random crown, kR = {}", optical_radius);
    subject.setting = "random";
    subject.ball = {0, 0, radius, radius};
    const std::filesystem::path file = scratch / fmt::format("random_crown_{}.gltf", optical_radius);
    if (!std::filesystem::exists(file)) write_random_crown(file, 200'000, radius, optical_radius);
    subject.scene = empty_scene();
    subject.scene.species.push_back(species_of("ball", file, SpeciesSource{}.leaf_materials));
    plant(subject.scene, "ball", {0, 0}, 0);
    subject.methods = each_tree_method("none");
    // What is traced on each plant holds for any of them; the laws are what a random crown judges.
    std::erase_if(subject.methods,
                  [](const AccuracyMethod& m) { return m.name == "crown-field" || m.name == "crown-baked"; });
    subjects.push_back(subject);
  }
}

void add_grass(std::vector<AccuracySubject>& subjects) {
  struct Sward {
    const char* name;
    double density, height;
  };
  for (const Sward& sward : {Sward{"short grass", 3000, 0.12}, Sward{"meadow grass", 900, 0.4}}) {
    AccuracySubject subject;
    subject.name = sward.name;
    subject.setting = "grass";
    subject.scene = empty_scene();
    put_on_ground(subject.scene, 20);
    GrassField field;
    field.region = {{-1.5, -1.5}, {1.5, 1.5}};
    field.density = sward.density;
    field.height = {sward.height, 0.25 * sward.height};
    subject.scene.grass.push_back(field);
    subject.methods = each_grass_method();
    subject.ground = true;
    subject.elevation = 0.6;
    subjects.push_back(subject);
  }
}

/// Five trees that stand in each other's shade.
void add_stand(const std::filesystem::path& data, std::vector<AccuracySubject>& subjects) {
  AccuracySubject subject;
  subject.name = "five trees";
  subject.setting = "stand";
  subject.scene = empty_scene();
  put_on_ground(subject.scene, 60);
  for (std::size_t tree : {0u, 1u, 6u}) {
    const MeshSubject& mesh = mesh_subjects()[tree];
    subject.scene.species.push_back(species_of(mesh.name, data / mesh.file, mesh.leaf_materials));
  }
  plant(subject.scene, "black oak", {-6, -2}, 0.3);
  plant(subject.scene, "black oak", {7, 3}, 2.1);
  plant(subject.scene, "birch", {-1, 7}, 1.2);
  plant(subject.scene, "birch", {2, -6}, 4.0);
  plant(subject.scene, "poplar", {-9, 8}, 0.7);
  for (const char* crowns : crowns_methods)
    for (AccuracyMethod method : each_tree_method(crowns)) {
      method.name += std::string(" + ") + crowns;
      subject.methods.push_back(method);
    }
  subject.ground = true;
  subjects.push_back(subject);
}

}  // namespace

std::vector<AccuracySubject> accuracy_subjects(const std::filesystem::path& data,
                                               const std::filesystem::path& scratch) {
  std::vector<AccuracySubject> subjects;
  add_plants(data, subjects);
  add_random_crowns(scratch, subjects);
  add_grass(subjects);
  add_stand(data, subjects);
  return subjects;
}

}  // namespace understory
