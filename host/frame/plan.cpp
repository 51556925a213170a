#include "host/frame/plan.hpp"

#include <algorithm>
#include <initializer_list>

#include "host/frame/draw_list.hpp"
#include "host/frame/near_field.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

/// What the scene holds, as far as passes care.
struct Contents {
  bool meshes = false, grass = false, blades = false, crowns = false, bodies_beside_crowns = false, occluders = false;
  bool ground_cover = false, dome = true, environment = false, hiders = false;
  bool brute = true, far_pieces = false;
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
  contents.brute = world.scene.detail == "brute";
  contents.hiders = !contents.brute && has_hiders(world);
  contents.far_pieces = world.scene.detail == "thinned" && has_far_pieces(world);
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
  require_known("combine", methods.combine, {"multiply", "simple", "merge", "union"});
  require_known("near", methods.near,
                {"obscurance-line", "obscurance-point", "obscurance-area", "screen-rays", "none"});
}

void plan_geometry(const Contents& contents, Plan& plan) {
  const char* bodies = "plants, occluders or terrain";
  if (contents.meshes) plan.passes.push_back({"pose_mesh", "pose_mesh", bodies, "plants, occluders, terrain"});
  if (contents.grass && contents.brute) plan.passes.push_back({"pose_grass", "pose_grass", "grass", "grass"});
  plan.passes.push_back({"clear_visible", "rasterise", "every frame", ""});
  if (contents.meshes) plan.passes.push_back({"rasterise_mesh", "rasterise", bodies, "plants, occluders, terrain"});
  if (contents.far_pieces) plan.passes.push_back({"draw_far", "draw_far", "leaves and twigs, far away", "detail"});
  if (contents.grass && contents.brute) plan.passes.push_back({"rasterise_grass", "rasterise", "grass", "grass"});
  if (contents.grass && !contents.brute) plan.passes.push_back({"draw_blades", "draw_blades", "grass", "grass"});
  if (contents.hiders)
    plan.passes.push_back({"farthest_depth", "farthest_depth",
                           "solid bodies or relief may hide what is behind, where the device has 64-bit atomics",
                           "detail"});
  plan.passes.push_back({"resolve", "resolve", "every frame", ""});
  if (!contents.meshes)
    plan.left_out.push_back({"posing and drawing of bodies", "no plants, occluders or terrain", "plants"});
  if (!contents.grass) plan.left_out.push_back({"posing and drawing of grass", "no field of grass", "grass"});
}

/// The model of crowns on their own leaves and wood. `ambient` is planned with its other users.
void plan_tree(const Contents& contents, const Methods& methods, Plan& plan) {
  const char* what = "crowns on their own leaves and wood";
  if (!contents.crowns) return plan.left_out.push_back({what, "no plant has a crown", "plants"});
  if (methods.tree == "none") return plan.left_out.push_back({what, "methods.tree: none", "methods.tree"});
  if (methods.tree == "ambient") return;
  std::string program = methods.tree;
  std::replace(program.begin(), program.end(), '-', '_');
  if (program == "shells_cap_levels") program = "shells_cap";
  plan.passes.push_back({methods.tree, program, "plants with a crown", "methods.tree"});
}

/// The model of blades, but for `ambient`.
void plan_grass(const Contents& contents, const Methods& methods, Plan& plan) {
  const char* what = "grass on its own blades";
  if (!contents.blades) return plan.left_out.push_back({what, "nothing has blades", "grass"});
  if (methods.grass == "none") return plan.left_out.push_back({what, "methods.grass: none", "methods.grass"});
  if (methods.grass == "grass-height")
    plan.passes.push_back({"grass-height", "grass_height", "grass", "methods.grass"});
  if (methods.grass == "grass-transmittance")
    plan.passes.push_back(
        {"grass-transmittance", "grass_transmittance", "grass and what stands in it", "methods.grass"});
}

/// The constant of whoever asks for it, and the ground under grass unless grass-transmittance lights that as well.
void plan_ambient(const Contents& contents, const Methods& methods, Plan& plan) {
  const bool layer = contents.blades && methods.grass == "grass-transmittance";
  PlannedPass pass = {"ambient", "ambient", "", ""};
  const auto join = [&](bool wanted, const char* user, const char* key) {
    if (!wanted) return;
    pass.because += (pass.because.empty() ? "" : ", ") + std::string(user);
    pass.key += (pass.key.empty() ? "" : ", ") + std::string(key);
  };
  join(contents.ground_cover && !layer, "ground under grass", "grass");
  join(contents.crowns && methods.tree == "ambient", "plants with a crown", "methods.tree");
  join(contents.blades && methods.grass == "ambient", "grass", "methods.grass");
  if (!pass.key.empty()) return plan.passes.push_back(std::move(pass));
  if (layer)
    plan.left_out.push_back({"a constant", "grass-transmittance lights the ground under grass", "methods.grass"});
  else
    plan.left_out.push_back({"a constant", "no ground under grass, and no method asks for one", "methods.tree"});
}

/// Crowns on everything else, and moving occluders; one pass when both ask for the same.
void plan_spheres(const Contents& contents, const Methods& methods, Plan& plan) {
  const std::string crowns = contents.crowns && contents.bodies_beside_crowns ? methods.crowns : "none";
  const std::string occluders = contents.occluders ? methods.occluders : "none";
  if (crowns != "none") {
    const bool shared = crowns == occluders;
    plan.passes.push_back({crowns, "solid_angle", shared ? "crowns and moving occluders" : "crowns",
                           shared ? "methods.crowns, methods.occluders" : "methods.crowns"});
  } else {
    const char* what = "crowns on everything else";
    if (!contents.crowns)
      plan.left_out.push_back({what, "no plant has a crown", "plants"});
    else if (!contents.bodies_beside_crowns)
      plan.left_out.push_back({what, "nothing stands beside the crown", "plants"});
    else
      plan.left_out.push_back({what, "methods.crowns: none", "methods.crowns"});
  }
  if (!contents.occluders)
    plan.left_out.push_back({"moving occluders on everything else", "no occluders", "occluders"});
  else if (occluders == "none")
    plan.left_out.push_back({"moving occluders on everything else", "methods.occluders: none", "methods.occluders"});
  else if (occluders != crowns) {
    const bool cone = occluders.starts_with("grid-cone"), grid = occluders.starts_with("grid");
    plan.passes.push_back({occluders,
                           cone   ? "grid_cone"
                           : grid ? "grid"
                                  : "solid_angle",
                           "moving occluders", "methods.occluders"});
  }
}

void plan_visibility(const Contents& contents, const Methods& methods, Plan& plan) {
  plan_ambient(contents, methods, plan);
  plan_tree(contents, methods, plan);
  plan_grass(contents, methods, plan);
  if (contents.dome)
    plan.passes.push_back({"open-dome", "open_dome", "sky: dome", "sky"});
  else
    plan.left_out.push_back({"the horizon of open surfaces", "sky: sphere", "sky"});
  plan_spheres(contents, methods, plan);
  plan_near_field(methods, plan);
  plan.passes.push_back({"combine", "combine", "every frame", ""});
  if (contents.environment)
    plan.passes.push_back({"environment", "environment", "environment: map", "environment.map"});
  else
    plan.left_out.push_back({"coloured light of the sky", "no picture of the sky", "environment.map"});
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
