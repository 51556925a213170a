#include "host/frame/visibility.hpp"

#include <optional>
#include <vector>

#include "host/frame/crown_bakes.hpp"
#include "host/frame/crown_records.hpp"
#include "host/frame/occluder_grids.hpp"
#include "host/frame/tree_model.hpp"
#include "host/passes/ambient.hpp"
#include "host/passes/combine.hpp"
#include "host/passes/grass_height.hpp"
#include "host/passes/grass_transmittance.hpp"
#include "host/passes/open_dome.hpp"
#include "host/passes/solid_angle.hpp"

namespace understory {
namespace {

/// One solid-angle pass, and whose spheres it takes.
struct SphereShading {
  SolidAnglePass pass;
  std::string method;
  bool crowns = false, occluders = false;
  Table<ShadingSphere> spheres;
};

/// `crown-field`: its pass and the fields of this world.
struct FieldShading {
  CrownFieldPass pass;
  CrownFieldTables fields;
};

/// `crown-baked`: its pass and the faces of this world.
struct BakedShading {
  CrownBakedPass pass;
  CrownBakedTables tables;
};

}  // namespace

struct VisibilityPasses::Impl {
  Impl(Device& the_device, const World* the_world, const Methods& the_methods, const Plan& plan, std::size_t width,
       std::size_t height);
  Buffer<float>& add_term(const std::string& name) {
    return terms.emplace(name, Buffer<float>(device, padded_fragments, name.c_str())).first->second;
  }
  const Buffer<float>* term(const std::string& name) const {
    const auto found = terms.find(name);
    return found == terms.end() ? nullptr : &found->second;
  }
  void run_own_models(const Pose* pose, const OwnerTables& owners, FragmentPlanes& planes);
  void run_spheres(const Pose& pose, const OwnerTables& owners, FragmentPlanes& planes);
  VisibilityTerms combined_terms() const;

  Device& device;
  const World* world;
  Methods methods;
  std::size_t padded_fragments;
  std::map<std::string, Buffer<float>> terms;
  Buffer<float> visibility;
  std::optional<GroundCoverTable> cover;
  std::optional<AmbientPass> ambient;
  std::optional<TreeModel> tree;
  std::optional<FieldShading> field;
  std::optional<BakedShading> baked;
  std::optional<GrassHeightPass> grass;
  std::optional<GrassLayerTable> layer;
  std::optional<GrassTransmittancePass> among_grass;
  std::optional<OpenDomePass> dome;
  std::vector<SphereShading> shadings;  // crowns and occluders, together when they share a method
  std::optional<NearFieldPasses> near;
  ObscuranceView view;
  std::optional<OccluderGrids> grids;  // of occluders, with a grid method
  CombinePass combine;
  std::optional<EnvironmentLight> environment;
};

VisibilityPasses::Impl::Impl(Device& the_device, const World* the_world, const Methods& the_methods, const Plan& plan,
                             std::size_t width, std::size_t height)
    : device(the_device),
      world(the_world),
      methods(the_methods),
      padded_fragments(padded_fragment_count(width * height)),
      visibility(device, padded_fragments, "visibility"),
      combine(device) {
  if (plan.has("ambient")) {
    cover.emplace(device, plan.has("grass-transmittance") ? GroundCover() : world->ground_cover);
    ambient.emplace(device);
    add_term("ambient");
  }
  if (TreeModel::knows(methods.tree) && plan.has(methods.tree)) tree.emplace(device, *world, methods.tree);
  if (plan.has("crown-field")) field = {CrownFieldPass(device), upload_crown_fields(device, *world)};
  if (plan.has("crown-baked")) baked = {CrownBakedPass(device), upload_crown_baked(device, *world)};
  if (tree || field || baked) add_term(methods.tree);
  if (plan.has("grass-height")) {
    grass.emplace(device);
    add_term("grass-height");
  }
  if (plan.has("grass-transmittance")) {
    const bool open_below = open_below_grass(*world);
    layer.emplace(device, light_grass(*world), open_below);
    among_grass.emplace(device, open_below);
    add_term("grass-transmittance");
  }
  if (plan.has("open-dome")) {
    dome.emplace(device);
    add_term("open-dome");
  }
  if (plan.has("environment")) environment.emplace(device, *world, padded_fragments);
  if (is_grid_method(methods.occluders) && plan.has(methods.occluders)) {
    grids.emplace(device, *world, methods, plan.has("environment") ? padded_fragments : 0);
    add_term(methods.occluders);
  }
  for (const PlannedPass& pass : plan.passes) {
    if (pass.program != "solid_angle") continue;
    shadings.push_back({SolidAnglePass(device, pass.name),
                        pass.name,
                        pass.name == methods.crowns,
                        pass.name == methods.occluders,
                        {}});
    add_term(pass.name);
  }
  if (methods.near != "none") {
    near.emplace(device, methods, width, height);
    add_term(methods.near);
  }
}

void VisibilityPasses::Impl::run_own_models(const Pose* pose, const OwnerTables& owners, FragmentPlanes& planes) {
  if (ambient) {
    std::uint32_t constant_classes = 0;
    if (methods.tree == "ambient") constant_classes |= class_bit(SurfaceClass::leaf) | class_bit(SurfaceClass::wood);
    if (methods.grass == "ambient") constant_classes |= class_bit(SurfaceClass::blade);
    ambient->run(planes, owners, methods.ambient, constant_classes, *cover, pose->eye, terms.at("ambient"));
  }
  if (tree) tree->run(*pose, planes, owners, terms.at(methods.tree));
  if (field) field->pass.run(planes, field->fields, terms.at(methods.tree));
  if (baked) baked->pass.run(planes, baked->tables.texels, terms.at(methods.tree));
  if (grass) grass->run(planes, owners, terms.at("grass-height"));
  if (among_grass) among_grass->run(planes, *layer, pose->eye, terms.at("grass-transmittance"));
  if (dome) dome->run(planes, terms.at("open-dome"));
}

void VisibilityPasses::Impl::run_spheres(const Pose& pose, const OwnerTables& owners, FragmentPlanes& planes) {
  for (SphereShading& shading : shadings) {
    const std::vector<ShadingSphere> spheres =
        shading_spheres(pose, shading.crowns, shading.occluders, shading.method == "crown-shells");
    shading.spheres.write(device, spheres, "shading spheres");
    shading.pass.run(planes, owners, shading.spheres.buffer(), spheres.size(), terms.at(shading.method));
  }
}

VisibilityTerms VisibilityPasses::Impl::combined_terms() const {
  VisibilityTerms all;
  all.ambient = term("ambient");
  all.tree = tree || field || baked ? term(methods.tree) : nullptr;
  all.grass = term(among_grass ? "grass-transmittance" : "grass-height");
  all.dome = term("open-dome");
  for (const SphereShading& shading : shadings) (shading.crowns ? all.crowns : all.occluders) = term(shading.method);
  all.near = term(methods.near);
  all.near_is_limit = methods.near_field.combine == "minimum";
  if (grids) all.occluders = term(methods.occluders);
  // Bakes are traced under the scene's sky, and so is what crown-transmittance stands for.
  if (field || baked || (tree && tree->has_horizon()))
    all.horizon_classes |= class_bit(SurfaceClass::leaf) | class_bit(SurfaceClass::wood);
  return all;
}

VisibilityPasses::VisibilityPasses(Device& device, const World* world, const Methods& methods, const Plan& plan,
                                   std::size_t width, std::size_t height)
    : impl_(std::make_unique<Impl>(device, world, methods, plan, width, height)) {}
VisibilityPasses::~VisibilityPasses() = default;
VisibilityPasses::VisibilityPasses(VisibilityPasses&&) noexcept = default;
VisibilityPasses& VisibilityPasses::operator=(VisibilityPasses&&) noexcept = default;

void VisibilityPasses::see(const ObscuranceView& view) { impl_->view = view; }

void VisibilityPasses::run(const Pose* pose, const OwnerTables& owners, FragmentPlanes& planes, glm::vec3 eye) {
  impl_->run_own_models(pose, owners, planes);
  if (pose) impl_->run_spheres(*pose, owners, planes);
  if (impl_->near) impl_->near->run(planes, impl_->view, impl_->terms.at(impl_->methods.near));
  if (pose && impl_->grids) impl_->grids->run(*pose, planes, owners, impl_->terms.at(impl_->methods.occluders));
  impl_->combine.run(planes, owners, impl_->combined_terms(), impl_->visibility);
  const ConePlanes* cones = impl_->grids ? impl_->grids->cones() : nullptr;
  if (impl_->environment) impl_->environment->run(planes, owners, impl_->visibility, cones, eye);
}

const Buffer<std::array<std::uint32_t, 2>>* VisibilityPasses::baked_faces() const {
  return impl_->baked ? &impl_->baked->tables.faces : nullptr;
}
const Buffer<float>& VisibilityPasses::visibility() const { return impl_->visibility; }
const std::map<std::string, Buffer<float>>& VisibilityPasses::terms() const { return impl_->terms; }
const EnvironmentLight* VisibilityPasses::environment() const {
  return impl_->environment ? &*impl_->environment : nullptr;
}

}  // namespace understory
