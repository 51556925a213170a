// The one table of what a scene file may say. Three archives walk it: the reader decodes and checks, the writer puts a
// scene back into text, the schema builder describes it (JSON Schema, help). A key is added here and nowhere else.
//
// An archive offers: number, numbers, integer, flag, text, texts, word, choice, file, up_axis, reference, section,
// list, named, optional for keys; require, exactly_one, at_least_one, goes_with, excludes for which keys may meet;
// alternative for a key whose presence sets a kind; check for what only the reader can tell.
#pragma once
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "sim/scene.hpp"

namespace understory {

/// What a number may be, as files write it (degrees for angles).
struct Range {
  double low = 0, high = 0;  // inclusive
  const char* unit = "";
  bool above_low = false;            // `low` itself is not allowed
  bool is_angle = false;             // degrees in files, radians in memory
  std::optional<double> unset = {};  // the value in memory of a key that was left out and has no default to show
};

inline constexpr std::uint64_t largest_seed = std::numeric_limits<std::int64_t>::max();  // JSON readers are signed
inline constexpr double far = 1e8;  // m: no coordinate lies beyond; UTM northings are below 1e7

constexpr Range coordinate() { return {-far, far, "m"}; }
constexpr Range above_zero(double high, const char* unit) { return {0, high, unit, true}; }
constexpr Range zero_to(double high, const char* unit = "") { return {0, high, unit}; }
constexpr Range degrees(double low, double high) { return {low, high, "degrees", false, true}; }
constexpr Range optional_above_zero(double high, const char* unit, double unset) {
  return {0, high, unit, true, false, unset};
}

inline std::span<double> components(glm::dvec2& v) { return {&v.x, 2}; }
inline std::span<double> components(glm::dvec3& v) { return {&v.x, 3}; }
inline std::span<float> components(glm::vec3& v) { return {&v.x, 3}; }
inline std::span<double> components(std::array<double, 2>& v) { return v; }

template <class Enum>
using Choices = std::initializer_list<std::pair<Enum, const char*>>;
using Words = std::initializer_list<const char*>;

template <class Archive>
void colour(Archive& a, const char* key, glm::vec3& albedo, const char* help) {
  a.numbers(key, components(albedo), zero_to(1), help);
}

template <class Archive>
void keys(Archive& a, Timing& time) {
  a.number("start", time.start, {-1e9, 1e9, "s"}, "time of frame 0");
  a.number("fps", time.frames_per_second, above_zero(1e6, "1/s"), "frames per second");
  a.integer("frames", time.frames, 1, 1'000'000, "number of frames");
}

template <class Archive>
void keys(Archive& a, ImageSize& image) {
  a.integer("width", image.width, 1, 16384, "pixels across");
  a.integer("height", image.height, 1, 16384, "pixels down");
}

template <class Archive>
void keys(Archive& a, Camera& camera) {
  a.numbers("position", components(camera.position), coordinate(), "where the eye is, relative to the origin");
  a.numbers("target", components(camera.target), coordinate(), "the point in the middle of the picture");
  a.number("fov", camera.vertical_fov, degrees(0.1, 170), "vertical field of view");
  a.number("near", camera.near_plane, {1e-4, 1000, "m"}, "nothing closer than this is drawn");
  a.check(camera.position != camera.target, "target", "a point other than position");
}

template <class Archive>
void keys(Archive& a, Region& region) {
  a.require({"low", "high"});
  a.numbers("low", components(region.low), coordinate(), "corner of least x and y");
  a.numbers("high", components(region.high), coordinate(), "corner of greatest x and y");
  a.check(region.low.x < region.high.x && region.low.y < region.high.y, "high", "greater than low in x and y");
}

template <class Archive>
void keys(Archive& a, TerrainSource& terrain) {
  using Kind = TerrainSource::Kind;
  const Range height{-20000, 20000, "m"};
  const auto placed = [&](auto& section) {
    section.number("height", terrain.height, height, "added to every height");
    section.numbers("centre", components(terrain.centre), coordinate(), "where the middle of its bounding box goes");
  };
  a.exactly_one({"flat", "raster", "mesh"});
  if (a.alternative("flat", terrain.kind, Kind::flat)) {
    a.section("flat", "a plane", [&](auto& flat) {
      flat.record("extent", terrain.extent, "its rectangle");
      flat.number("height", terrain.height, height, "height of the plane");
    });
  }
  if (a.alternative("raster", terrain.kind, Kind::raster)) {
    a.section("raster", "a height raster that GDAL reads: GeoTIFF, ESRI ASCII grid, ...", [&](auto& raster) {
      raster.require({"file"});
      raster.file("file", terrain.file, "the raster");
      placed(raster);
    });
  }
  if (a.alternative("mesh", terrain.kind, Kind::mesh)) {
    a.section("mesh", "a surface from a mesh: OBJ, PLY, glTF, GLB", [&](auto& mesh) {
      mesh.require({"file"});
      mesh.file("file", terrain.file, "the mesh");
      mesh.up_axis("up", terrain.up, terrain.file);
      placed(mesh);
    });
  }
}

template <class Archive>
void keys(Archive& a, WindSource& wind) {
  a.number("speed", wind.speed, zero_to(100, "m/s"), "mean speed at `height`");
  a.number("height", wind.reference_height, above_zero(1000, "m"), "height above ground of `speed`");
  a.number("direction", wind.direction, degrees(-360, 360), "where it blows to, counter-clockwise from +x (east)");
  a.number("roughness", wind.roughness_length, above_zero(10, "m"), "roughness length z0 of the log profile");
  a.number("displacement", wind.displacement_height, zero_to(100, "m"), "displacement height d of the log profile");
  a.number("turbulence", wind.turbulence_intensity, zero_to(2), "sigma_u / speed of the gusts");
  a.number("length_scale", wind.length_scale, {0.1, 10000, "m"}, "integral length of the gusts along the wind");
  a.file("record", wind.record, "measured series instead: CSV with columns u_ms and v_ms in m/s");
  a.number("record_height", wind.record_height, above_zero(1000, "m"), "height above ground of `record`");
  a.goes_with("record", {"record_height"});
  a.excludes("record", {"speed", "height", "turbulence"});
  const double top = wind.displacement_height + wind.roughness_length;
  a.check(!wind.record.empty() || wind.reference_height > top, "height", "above displacement + roughness");
  a.check(wind.record.empty() || wind.record_height > top, "record_height", "above displacement + roughness");
}

template <class Archive>
void keys(Archive& a, SwayMode& mode) {
  a.number("frequency", mode.frequency, above_zero(100, "Hz"), "natural frequency");
  a.number("damping", mode.damping, {0.001, 10, ""}, "damping ratio, 1 is critical");
  a.number("deflection", mode.deflection, degrees(0, 170), "tip angle in a steady wind of 10 m/s");
}

template <class Archive>
void keys(Archive& a, SpeciesSource& species) {
  a.exactly_one({"generator", "mesh"});
  a.word("generator", species.generator, {"broadleaf", "conifer", "column", "shrub", "birch"}, "procedural preset");
  a.integer("leaves", species.leaves, 1, 2'000'000, "leaves of a generated plant; left out: the preset's", 0);
  a.integer("variant", species.variant, std::uint64_t{0}, largest_seed, "another individual of the same preset");
  a.file("mesh", species.mesh, "a plant from a mesh: OBJ, PLY, glTF, GLB");
  a.up_axis("up", species.up, species.mesh);
  a.texts("leaf_materials", species.leaf_materials, "patterns of the material names that are leaves");
  a.texts("blade_materials", species.blade_materials, "patterns of the material names that are blades of grass");
  a.number("height", species.height, optional_above_zero(200, "m", 0), "scaled to this; left out: as it comes");
  a.section("sway", "how it answers the wind; what is left out is the preset's", [&](auto& sway) {
    sway.optional("trunk", species.trunk, "sway of the whole plant");
    sway.optional("branch", species.branch, "sway of the branches");
    sway.optional("leaf", species.leaf, "flutter of the leaves");
  });
  a.section("albedo", "share of light that is reflected, linear red, green, blue", [&](auto& albedo) {
    colour(albedo, "leaf", species.leaf_albedo, "of leaves");
    colour(albedo, "wood", species.wood_albedo, "of wood");
  });
  a.integer("shells", species.shells, 1, 64, "most spheres around clusters of the foliage, for methods with shells");
  a.number("alpha_rho", species.alpha_rho, {0, 1e6, "1/m^3", false, false, -1},
           "eq. 6 of Hegeman et al. 2006; left out: from the foliage");
  a.section("reeves_blau", "constants of method reeves-blau", [&](auto& model) {
    model.number("ambient", species.reeves_blau_ambient, zero_to(1), "at the crown's border");
    model.number("extinction", species.reeves_blau_extinction, {0, 1e6, "1/m", false, false, -1},
                 "decay inwards; left out: from the foliage");
  });
  a.goes_with("generator", {"leaves", "variant"});
  a.goes_with("mesh", {"up", "leaf_materials", "blade_materials"});
}

template <class Archive>
void keys(Archive& a, PlantPlacement::Spot& spot) {
  a.require({"at"});
  a.numbers("at", components(spot.at), coordinate(), "x and y of the root");
  a.number("yaw", spot.yaw, degrees(-360, 360), "turned about the vertical");
  a.number("scale", spot.scale, {0.001, 1000, ""}, "times the species' size");
}

template <class Archive>
void keys(Archive& a, PlantPlacement& plants) {
  a.require({"species"});
  a.reference("species", plants.species, "species", "a name from `species`");
  a.exactly_one({"spots", "scatter"});
  if (a.alternative("spots", plants.scatter, false)) {
    a.list("spots", plants.spots, "placed by hand", 1);
  }
  if (a.alternative("scatter", plants.scatter, true)) {
    a.section("scatter", "seeded Poisson-disk scatter", [&](auto& scatter) {
      scatter.require({"region"});
      scatter.record("region", plants.region, "rectangle that is planted");
      scatter.number("spacing", plants.spacing, {0.01, 1e6, "m"}, "no two of them are closer");
      scatter.integer("count", plants.count, 1, 10'000'000, "how many; left out: as many as fit", 0);
      scatter.numbers("scale", components(plants.scale), {0.001, 1000, ""}, "least and greatest size");
      scatter.check(plants.scale[0] <= plants.scale[1], "scale", "the least first, then the greatest");
    });
  }
}

/// Mean and deviation of one property of the blades.
template <class Archive>
void spread(Archive& a, const char* key, Spread& value, Range mean, const char* help) {
  Range deviation = mean;
  deviation.low = 0;
  deviation.above_low = false;
  a.section(key, help, [&](auto& section) {
    section.number("mean", value.mean, mean, "mean over the blades");
    section.number("deviation", value.deviation, deviation, "standard deviation over the blades");
  });
}

template <class Archive>
void keys(Archive& a, GrassField& grass) {
  a.require({"region"});
  a.record("region", grass.region, "rectangle that is covered");
  a.number("density", grass.density, zero_to(100'000, "1/m^2"), "blades per square metre of ground");
  spread(a, "height", grass.height, above_zero(10, "m"), "length of a blade");
  spread(a, "width", grass.width, above_zero(1, "m"), "width at the base");
  spread(a, "bend", grass.bend, degrees(0, 170), "angle of the tip at rest, from the vertical");
  spread(a, "stiffness", grass.stiffness, above_zero(1000, ""), "divides the deflection of `sway`");
  a.record("sway", grass.sway, "how blades answer the wind");
  a.number("clumping", grass.clumping, zero_to(1), "0: roots anywhere; towards 1: all in tufts");
  colour(a, "albedo", grass.albedo, "share of light that is reflected, linear red, green, blue");
}

template <class Archive>
void keys(Archive& a, Keyframe& frame) {
  a.require({"time"});
  a.number("time", frame.time, {-1e9, 1e9, "s"}, "when it is there");
  a.numbers("position", components(frame.position), coordinate(), "where it is");
  a.numbers("rotation", components(frame.rotation), degrees(-1e6, 1e6), "about the fixed x, then y, then z axis");
}

template <class Archive>
void keyframes(Archive& a, std::vector<Keyframe>& frames, const char* help) {
  a.list("keyframes", frames, help);
  bool ordered = true;
  for (std::size_t i = 1; i < frames.size(); ++i) ordered = ordered && frames[i - 1].time < frames[i].time;
  a.check(ordered, "keyframes", "times that increase from each keyframe to the next");
}

template <class Archive>
void keys(Archive& a, OccluderPart& part) {
  using Shape = OccluderPart::Shape;
  const Range size = above_zero(10'000, "m");
  a.text("name", part.name, "names the part in `motion`; unique within the occluder");
  a.exactly_one({"box", "ellipsoid", "capsule", "mesh"});
  if (a.alternative("box", part.shape, Shape::box)) {
    a.numbers("box", components(part.size), size, "its edges along x, y, z");
  }
  if (a.alternative("ellipsoid", part.shape, Shape::ellipsoid)) {
    a.numbers("ellipsoid", components(part.size), size, "its diameters along x, y, z");
  }
  if (a.alternative("capsule", part.shape, Shape::capsule)) {
    a.numbers("capsule", components(part.size), size, "diameter in x, in y, whole length along z");
  }
  if (a.alternative("mesh", part.shape, Shape::mesh)) {
    a.file("mesh", part.mesh, "OBJ, PLY, glTF, GLB");
    a.numbers("stretch", components(part.size), {0.001, 1000, ""}, "factors along x, y, z beside `scale`");
  }
  a.text("object", part.mesh_object, "the object inside the mesh; left out: all of them");
  a.up_axis("up", part.up, part.mesh);
  a.number("scale", part.scale, {1e-6, 1e6, ""}, "times the mesh's size");
  keyframes(a, part.keyframes, "movement within the occluder, smooth through all; none or one: fixed");
  a.goes_with("mesh", {"object", "up", "scale", "stretch"});
}

template <class Archive>
void keys(Archive& a, OccluderSource& occluder) {
  a.require({"name"});
  a.text("name", occluder.name, "unique among the occluders");
  a.exactly_one({"parts", "generator"});
  a.word("generator", occluder.generator, {"walker"}, "a person of eleven parts, whose steps follow `keyframes`");
  a.number("height", occluder.height, above_zero(1000, "m"), "of the generated body");
  a.list("parts", occluder.parts, "its rigid pieces", 1);
  keyframes(a, occluder.keyframes, "path of the whole, smooth through all; none or one: stays");
  a.flag("on_terrain", occluder.on_terrain, "z of the path is above the ground below it");
  a.flag("loop", occluder.loop, "starts again after the last keyframe");
  const auto motion = [&](auto& section) {
    section.require({"record"});
    section.file("record", occluder.motion_record, "CSV with columns time_s,part,m00..m23: part-to-body matrices");
    section.choice("up", occluder.motion_up, {{UpAxis::y, "y"}, {UpAxis::z, "z"}}, "the axis that is up in it");
  };
  a.section("motion", "recorded movement of the parts instead of their keyframes", motion,
            !occluder.motion_record.empty());
  a.goes_with("generator", {"height"});
  a.excludes("generator", {"motion"});
  colour(a, "albedo", occluder.albedo, "share of light that is reflected, linear red, green, blue");
}

template <class Archive>
void keys(Archive& a, EnvironmentSource& environment) {
  a.file("map", environment.map, "latitude-longitude picture of the sky: EXR, twice as wide as high, zenith on top");
  a.number("turn", environment.turn, degrees(-360, 360), "turns the map counter-clockwise; its middle looks to +x");
  a.number("gloss", environment.gloss, degrees(0, 90), "half-angle of the sky that occluders mirror; 0: matt");
  a.goes_with("map", {"turn", "gloss"});
}

template <class Archive>
void keys(Archive& a, NearField& near_field) {
  a.integer("samples", near_field.samples, 1, 64,
            "lines: 5, 7, 9, 12, 13, 15, 16; points: 6, 12, 33; areas: 1, or as lines; rays: 1 to 64; left out: 5, 12, "
            "1, 16",
            0);
  a.number("radius", near_field.radius, above_zero(1000, "m"),
           "of the ball around each fragment; rays: how long they are");
  a.number("second_radius", near_field.second_radius, optional_above_zero(1000, "m", 0),
           "of a second ball; left out: none");
  a.word("radii", near_field.radii, {"product", "minimum"}, "of the two radii");
  a.word("falloff", near_field.falloff, {"constant", "quadratic", "cosine"},
         "weight over the ball: 1, or 1 - (r/radius)^2; cosine: 1 over the largest ball in front of the tangent plane");
  a.word("normals", near_field.normals, {"buffer", "depth", "none"}, "clamp to the tangent plane; from where");
  a.number("thickness", near_field.thickness, optional_above_zero(1000, "m", 0),
           "of what is seen, on the mean (areas: exactly; rays: at least); open behind it; left out: 5 times `radius`, "
           "rays: a tenth of it, 0.05 m at most");
  a.integer("blur", near_field.blur, 0, 16, "radius of the edge-aware blur, pixels");
  a.flag("half_resolution", near_field.half_resolution, "every second pixel, then depth-aware upsampling");
  a.integer("guard", near_field.guard, 0, 1024, "pixels drawn around the image for samples that leave it");
  a.word("combine", near_field.combine, {"product", "minimum"}, "with the other terms");
  a.goes_with("second_radius", {"radii"});
}

template <class Archive>
void keys(Archive& a, Methods& methods) {
  a.word("tree", methods.tree,
         {"sphere-cap", "ellipsoid-cap", "shells-cap", "shells-cap-levels", "reeves-blau", "crown-transmittance",
          "crown-field", "crown-baked", "ambient", "none"},
         "within a crown");
  a.word("grass", methods.grass, {"grass-transmittance", "grass-height", "ambient", "none"}, "among blades");
  a.word("crowns", methods.crowns, {"solid-angle", "solid-angle-exact", "solid-angle-cosine", "crown-shells", "none"},
         "how crowns shade others");
  a.word("occluders", methods.occluders,
         {"solid-angle", "solid-angle-exact", "solid-angle-cosine", "grid", "grid-self-paper", "grid-cone",
          "grid-cone-paper", "none"},
         "how moving occluders shade others");
  a.word("near", methods.near, {"obscurance-line", "obscurance-point", "obscurance-area", "screen-rays", "none"},
         "near field, from depth and normals");
  a.record("near_field", methods.near_field, "how `near` samples");
  const bool rays = methods.near == "screen-rays";
  const NearField& near_field = methods.near_field;
  a.check(!rays || near_field.normals != "none", "near", "screen-rays with near_field.normals buffer or depth");
  a.check(!rays || near_field.falloff == "constant", "near", "screen-rays with near_field.falloff constant");
  a.check(!rays || near_field.second_radius == 0, "near", "screen-rays without near_field.second_radius");
  a.word("combine", methods.combine, {"multiply", "simple", "merge", "union"}, "how grid-cone puts occluders together");
  a.section("grid", "how the grids of moving occluders are baked", [&](auto& grid) {
    grid.integer("size", methods.grid.size, 2, 512, "samples per axis");
    grid.number("epsilon", methods.grid.epsilon, {0.001, 1, ""}, "share of the sphere that its border may neglect");
    grid.number("stretch", methods.grid.stretch, {0, 8, ""}, "how samples crowd about the body; 0: evenly spread");
    grid.integer("rays", methods.grid.rays, 16, 65536, "rays per sample");
  });
  a.number("ambient", methods.ambient, zero_to(1), "the constant of method `ambient`");
}

template <class Named>
bool names_differ(const std::vector<Named>& all) {
  std::set<std::string> names;
  return std::all_of(all.begin(), all.end(),
                     [&](const Named& one) { return one.name.empty() || names.insert(one.name).second; });
}

template <class Archive>
void keys(Archive& a, Scene& scene) {
  a.text("name", scene.name, "title of the scene");
  a.integer("seed", scene.seed, std::uint64_t{0}, largest_seed, "of everything random");
  a.numbers("origin", components(scene.origin), {-1e9, 1e9, "m"}, "world coordinates of the scene's zero, e.g. UTM");
  a.choice("sky", scene.sky, {{Sky::dome, "dome"}, {Sky::sphere, "sphere"}},
           "where light comes from: above the horizon, or all around");
  a.record("time", scene.time, "when the frames are");
  a.record("image", scene.image, "size of the pictures");
  a.record("camera", scene.camera, "a perspective camera, upright");
  a.section_unless("terrain", "none", scene.has_terrain, "the ground; left out: flat", [&](auto& terrain) {
    keys(terrain, scene.terrain);
    colour(terrain, "albedo", scene.terrain_albedo, "share of light that is reflected, linear red, green, blue");
  });
  a.record("wind", scene.wind, "mean wind over height, and gusts");
  a.named("species", scene.species, "what grows here, by name");
  a.list("plants", scene.plants, "where it grows");
  a.list("grass", scene.grass, "fields of grass");
  a.list("occluders", scene.occluders, "bodies that move through the scene");
  for (const OccluderSource& occluder : scene.occluders) {
    a.check(names_differ(occluder.parts), "occluders", "a name of its own for each part of " + occluder.name);
  }
  a.check(names_differ(scene.occluders), "occluders", "a name of its own for each occluder");
  a.record("environment", scene.environment, "coloured light of a picture of the sky; left out: a uniform sky");
  a.record("methods", scene.methods, "which model of visibility shades what");
  a.word(
      "detail", scene.detail, {"brute", "culled", "thinned"},
      "what is drawn: everything; what is in view and not behind solid bodies; and fewer, larger leaves and blades far "
      "away");
  a.at_least_one({"terrain", "plants", "grass", "occluders"});
}

}  // namespace understory
