#include "host/frame/plan.hpp"

#include <algorithm>
#include <initializer_list>

#include "host/frame/near_field.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

/// What the scene holds, as far as passes care.
struct Contents {
  bool meshes = false, grass = false, blades = false, crowns = false, bodies_beside_crowns = false, occluders = false;
  bool ground_cover = false, dome = true, environment = false;
};

Contents contents_of(const World& world) {
  Contents contents;
  contents.meshes = !world.instances.empty();
  contents.grass =
      std::any_of(world.grass.begin(), world.grass.end(), [](const auto& field) { return field.size() > 0; });
  contents.blades = std::any_of(world.owners.begin(), world.owners.end(),
                                [](const Owner& owner) { return owner.surface == SurfaceClass::blade; });
  contents.crowns =
      std::any_of(world.owners.begin(), world.owners.end(), [](const Owner& owner) { return owner.crown >= 0; });
  contents.bodies_beside_crowns = world.instances.size() > 1 || contents.grass;
  contents.occluders = !world.occluder_spheres.empty();
  contents.ground_cover = world.ground_cover.columns > 0 && world.terrain != nullptr;
  contents.dome = world.scene.sky == Sky::dome;
  contents.environment = world.environment != nullptr;
  return contents;
}

void require_known(const char* key, const std::string& name, std::initializer_list<const char*> allowed) {
  if (std::find(allowed.begin(), allowed.end(), name) != allowed.end()) return;
  std::string message = std::string("methods.") + key + ": there is no method '" + name + "'; allowed:";
  for (const char* method : allowed) message += std::string(" ") + method;
  throw Error(ErrorKind::invalid_input, message);
}

void check_names(const Methods& methods) {
  require_known("tree", methods.tree,
                {"sphere-cap", "ellipsoid-cap", "shells-cap", "shells-cap-levels", "reeves-blau", "crown-transmittance",
                 "crown-field", "crown-baked", "ambient", "none"});
  require_known("grass", methods.grass, {"grass-transmittance", "grass-height", "ambient", "none"});
  require_known("crowns", methods.crowns,
                {"solid-angle", "solid-angle-exact", "solid-angle-cosine", "crown-shells", "none"});
  require_known("occluders", methods.occluders,
                {"solid-angle", "solid-angle-exact", "solid-angle-cosine", "grid", "grid-self-paper", "grid-cone",
                 "grid-cone-paper", "none"});
  require_known("combine", methods.combine, {"multiply", "simple", "merge"});
  require_known("near", methods.near, {"obscurance-line", "obscurance-point", "obscurance-area", "none"});
}

void plan_geometry(const Contents& contents, Plan& plan) {
  if (contents.meshes) plan.passes.push_back({"pose_mesh", "pose_mesh", "plants, occluders or terrain"});
  if (contents.grass) plan.passes.push_back({"pose_grass", "pose_grass", "grass"});
  plan.passes.push_back({"clear_visible", "rasterise", "every frame"});
  if (contents.meshes) plan.passes.push_back({"rasterise_mesh", "rasterise", "plants, occluders or terrain"});
  if (contents.grass) plan.passes.push_back({"rasterise_grass", "rasterise", "grass"});
  plan.passes.push_back({"resolve", "resolve", "every frame"});
}

void plan_visibility(const Contents& contents, const Methods& methods, Plan& plan) {
  const bool tree = contents.crowns && methods.tree != "none";
  const bool grass = contents.blades && methods.grass != "none";
  const bool layer = grass && methods.grass == "grass-transmittance";  // it lights the ground as well
  const bool cover = contents.ground_cover && !layer;
  if ((tree && methods.tree == "ambient") || (grass && methods.grass == "ambient") || cover)
    plan.passes.push_back({"ambient", "ambient", cover ? "ground under grass" : "asked for"});
  if (tree && methods.tree != "ambient") {
    std::string program = methods.tree;
    std::replace(program.begin(), program.end(), '-', '_');
    if (program == "shells_cap_levels") program = "shells_cap";
    plan.passes.push_back({methods.tree, program, "plants with a crown"});
  }
  if (grass && methods.grass == "grass-height") plan.passes.push_back({"grass-height", "grass_height", "grass"});
  if (layer) plan.passes.push_back({"grass-transmittance", "grass_transmittance", "grass and what stands in it"});
  if (contents.dome) plan.passes.push_back({"open-dome", "open_dome", "sky: dome"});
  const std::string crowns = contents.crowns && contents.bodies_beside_crowns ? methods.crowns : "none";
  const std::string occluders = contents.occluders ? methods.occluders : "none";
  if (crowns != "none")
    plan.passes.push_back({crowns, "solid_angle", crowns == occluders ? "crowns and moving occluders" : "crowns"});
  if (occluders != "none" && occluders != crowns) {
    const bool cone = occluders.starts_with("grid-cone"), grid = occluders.starts_with("grid");
    plan.passes.push_back({occluders, cone ? "grid_cone" : grid ? "grid" : "solid_angle", "moving occluders"});
  }
  plan_near_field(methods, plan);
  plan.passes.push_back({"combine", "combine", "every frame"});
  if (contents.environment) plan.passes.push_back({"environment", "environment", "environment: map"});
}

}  // namespace

bool Plan::has(const std::string& pass_name) const {
  return std::any_of(passes.begin(), passes.end(), [&](const PlannedPass& pass) { return pass.name == pass_name; });
}

Plan make_plan(const World& world, const Methods& methods) {
  check_names(methods);
  Plan plan;
  plan_geometry(contents_of(world), plan);
  plan_visibility(contents_of(world), methods, plan);
  return plan;
}

Plan make_visibility_plan(const World* world, const Methods& methods) {
  check_names(methods);
  if (methods.tree == "crown-baked")
    throw Error(
        ErrorKind::invalid_input,
        "methods.tree: crown-baked looks values up by triangle, and planes that another program rendered do not "
        "tell theirs; allowed for them: every other method, crown-field for one");
  Plan plan;
  Contents contents = world ? contents_of(*world) : Contents{};
  contents.bodies_beside_crowns = true;  // in the planes, which somebody else rendered
  plan_visibility(contents, methods, plan);
  return plan;
}

}  // namespace understory
