#include "bench/tradeoff_variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "host/frame/near_field.hpp"
#include "host/frame/occluder_grids.hpp"
#include "host/frame/plan.hpp"
#include "sim/files/scene_file.hpp"

namespace understory {
namespace {

constexpr const char* tree_methods[] = {"ambient",    "reeves-blau",       "sphere-cap",          "ellipsoid-cap",
                                        "shells-cap", "shells-cap-levels", "crown-transmittance", "crown-field",
                                        "crown-baked"};
constexpr const char* grass_methods[] = {"ambient", "grass-height", "grass-transmittance"};
constexpr const char* sphere_methods[] = {"solid-angle", "solid-angle-exact", "solid-angle-cosine"};
constexpr const char* cone_rules[] = {"multiply", "simple", "merge", "union"};
constexpr int grid_sizes[] = {16, 32};
constexpr int coarse_blur = 2;  // pixels

struct NearSamples {
  const char* method;
  std::vector<int> samples;
};
const std::vector<NearSamples>& near_samples_tried() {
  static const std::vector<NearSamples> all = {{"obscurance-line", {5, 9, 16}},
                                               {"obscurance-point", {6, 12, 33}},
                                               {"obscurance-area", {1, 5}},
                                               {"screen-rays", {4, 16}}};
  return all;
}

std::vector<std::string> pass_names(const World& world, const Methods& methods) {
  std::vector<std::string> names;
  for (const PlannedPass& pass : make_plan(world, methods).passes) names.push_back(pass.name);
  return names;
}

/// Whether the scene has anything that a method of this term would shade: then the plan has a pass more.
bool applies(const World& world, Axis axis) {
  const Methods bare = bare_variant(world.scene).methods;
  Methods probe = bare;
  probe.tree = "sphere-cap";
  probe.grass = "grass-height";
  probe.crowns = probe.occluders = sphere_methods[0];
  probe.near = "obscurance-line";
  return pass_names(world, with_term(bare, axis, probe)) != pass_names(world, bare);
}

/// Collects terms, those without an effect left out.
class TermList {
 public:
  explicit TermList(const World& world) : bare_(bare_variant(world.scene).methods) {
    for (const Axis axis : {Axis::tree, Axis::grass, Axis::crowns, Axis::occluders, Axis::near})
      if (applies(world, axis)) axes_.insert(axis);
    if (axes_.contains(Axis::crowns) && axes_.contains(Axis::occluders)) axes_.insert(Axis::crowns_occluders);
  }
  void add(Axis axis, const Methods& methods) {
    if (axes_.contains(axis)) terms.push_back({axis, {methods}});
  }
  const Methods& bare() const { return bare_; }

  std::vector<Term> terms;

 private:
  Methods bare_;
  std::set<Axis> axes_;
};

void add_occluders(TermList& list, const Scene& scene) {
  std::vector<int> sizes(std::begin(grid_sizes), std::end(grid_sizes));
  if (std::find(sizes.begin(), sizes.end(), scene.methods.grid.size) == sizes.end())
    sizes.push_back(scene.methods.grid.size);
  Methods methods = list.bare();
  for (const char* method : sphere_methods) {
    methods.occluders = method;
    list.add(Axis::occluders, methods);
  }
  for (const int size : sizes) {
    methods.grid.size = size;
    methods.occluders = "grid";
    list.add(Axis::occluders, methods);
    methods.occluders = "grid-cone";
    for (const char* rule : cone_rules) {
      methods.combine = rule;
      list.add(Axis::occluders, methods);
    }
  }
  methods.grid.size = scene.methods.grid.size;
  methods.combine = scene.methods.combine;
  for (const char* method : {"grid-self-paper", "grid-cone-paper"}) {
    methods.occluders = method;
    list.add(Axis::occluders, methods);
  }
}

void add_near(TermList& list) {
  Methods methods = list.bare();
  NearField& field = methods.near_field;
  field.half_resolution = false;
  field.blur = 0;
  for (const NearSamples& tried : near_samples_tried()) {
    methods.near = tried.method;
    for (const int samples : tried.samples) {
      field.samples = samples;
      list.add(Axis::near, methods);
    }
  }
  methods.near = "obscurance-line";
  field.samples = 5;
  field.half_resolution = true;
  list.add(Axis::near, methods);
  field.half_resolution = false;
  field.blur = coarse_blur;
  list.add(Axis::near, methods);
}

std::string near_name(const Methods& methods) {
  const NearField& field = methods.near_field;
  std::string name = fmt::format("{} {}", methods.near, near_samples(methods));
  if (field.half_resolution) name += " half";
  if (field.blur > 0) name += fmt::format(" blur {}", field.blur);
  return name + " " + field.combine;
}

std::string occluders_name(const Methods& methods) {
  std::string name = methods.occluders;
  if (is_grid_method(name)) name += fmt::format(" {}", methods.grid.size);
  if (methods.occluders.starts_with("grid-cone")) name += " " + methods.combine;
  return name;
}

}  // namespace

std::string Variant::name() const {
  std::string name;
  const auto add = [&](const std::string& part) { name += (name.empty() ? "" : ", ") + part; };
  if (methods.tree != "none") add("tree " + methods.tree);
  if (methods.grass != "none") add(methods.grass == "ambient" ? "grass ambient" : methods.grass);
  if (methods.crowns != "none" && methods.crowns == methods.occluders) {
    add("crowns and occluders " + methods.crowns);
  } else {
    if (methods.crowns != "none") add("crowns " + methods.crowns);
    if (methods.occluders != "none") add("occluders " + occluders_name(methods));
  }
  if (methods.near != "none") add(near_name(methods));
  if (name.empty()) name = "open sky only";
  if (shrink > 1) name += fmt::format(", size 1/{}", shrink);
  if (relaxed_maths) name += ", relaxed maths";
  return name;
}

std::vector<std::string> Variant::settings(const ImageSize& image) const {
  std::vector<std::string> all = {"methods.tree=" + methods.tree, "methods.grass=" + methods.grass,
                                  "methods.crowns=" + methods.crowns, "methods.occluders=" + methods.occluders,
                                  "methods.near=" + methods.near};
  if (is_grid_method(methods.occluders)) all.push_back(fmt::format("methods.grid.size={}", methods.grid.size));
  if (methods.occluders.starts_with("grid-cone")) all.push_back("methods.combine=" + methods.combine);
  if (methods.near != "none") {
    const NearField& field = methods.near_field;
    all.push_back(fmt::format("methods.near_field.samples={}", near_samples(methods)));
    all.push_back("methods.near_field.combine=" + field.combine);
    all.push_back(fmt::format("methods.near_field.half_resolution={}", field.half_resolution));
    all.push_back(fmt::format("methods.near_field.blur={}", field.blur));
  }
  if (shrink > 1) {
    const ImageSize size = shrunk(image, shrink);
    all.push_back(fmt::format("image.width={}", size.width));
    all.push_back(fmt::format("image.height={}", size.height));
  }
  return all;
}

ImageSize shrunk(const ImageSize& image, int shrink) {
  return {std::max(1, image.width / shrink), std::max(1, image.height / shrink)};
}

Variant bare_variant(const Scene& scene) {
  Variant variant{scene.methods};
  variant.methods.tree = variant.methods.grass = variant.methods.crowns = variant.methods.occluders =
      variant.methods.near = "none";
  return variant;
}

Methods with_term(Methods into, Axis axis, const Methods& term) {
  if (axis == Axis::tree) into.tree = term.tree;
  if (axis == Axis::grass) into.grass = term.grass;
  if (axis == Axis::crowns || axis == Axis::crowns_occluders) into.crowns = term.crowns;
  if (axis == Axis::occluders || axis == Axis::crowns_occluders) {
    into.occluders = term.occluders;
    into.grid = term.grid;
    into.combine = term.combine;
  }
  if (axis == Axis::near) {
    into.near = term.near;
    into.near_field = term.near_field;
  }
  return into;
}

std::vector<Term> terms_of(const World& world) {
  TermList list(world);
  for (const char* method : tree_methods) {
    Methods methods = list.bare();
    methods.tree = method;
    list.add(Axis::tree, methods);
  }
  for (const char* method : grass_methods) {
    Methods methods = list.bare();
    methods.grass = method;
    list.add(Axis::grass, methods);
  }
  for (const char* method : {"solid-angle", "solid-angle-exact", "solid-angle-cosine", "crown-shells"}) {
    Methods methods = list.bare();
    methods.crowns = method;
    list.add(Axis::crowns, methods);
  }
  add_occluders(list, world.scene);
  for (const char* method : sphere_methods) {
    Methods methods = list.bare();
    methods.crowns = methods.occluders = method;
    list.add(Axis::crowns_occluders, methods);
  }
  add_near(list);
  return list.terms;
}

Variant own_variant(const World& world) {
  Variant variant = bare_variant(world.scene);
  for (const Axis axis : {Axis::tree, Axis::grass, Axis::crowns, Axis::occluders, Axis::near})
    if (applies(world, axis)) variant.methods = with_term(variant.methods, axis, world.scene.methods);
  return variant;
}

}  // namespace understory
