// What a person wrote in a scene file, decoded and checked: plain data, nothing resolved or generated yet.
// Units: metres, seconds, radians (files say degrees where people write angles; the decoder converts).
// Right-handed, z up. Every position is relative to `Scene::origin`.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace understory {

/// Mean and standard deviation of a quantity that varies from plant to plant.
struct Spread {
  double mean = 0;
  double deviation = 0;
};

/// Axis-aligned rectangle on the ground, metres.
struct Region {
  glm::dvec2 low{0}, high{0};
  double area() const { return (high.x - low.x) * (high.y - low.y); }
  bool contains(glm::dvec2 p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
};

enum class Sky { dome, sphere };
enum class UpAxis { y, z };

struct Timing {
  double start = 0;
  double frames_per_second = 24;
  int frames = 48;
  double at(int frame) const { return start + frame / frames_per_second; }
};

struct ImageSize {
  int width = 800, height = 500;
};

struct Camera {
  glm::dvec3 position{0, -20, 3};
  glm::dvec3 target{0, 0, 2};
  double vertical_fov = 0.785;  // radians
  double near_plane = 0.05;
};

/// Ground. Exactly one of: flat (no file), raster (any GDAL height raster), mesh (OBJ, PLY, glTF).
struct TerrainSource {
  enum class Kind { flat, raster, mesh } kind = Kind::flat;
  std::filesystem::path file;
  Region extent{{-100, -100}, {100, 100}};  // flat only
  double height = 0;                        // flat: z of the plane; others: added to every z
  UpAxis up = UpAxis::z;                    // mesh only
  glm::dvec2 centre{0};                     // raster and mesh: where the middle of its bounding box goes
};

struct WindSource {
  double speed = 4;                    // mean at `reference_height`, m/s
  double reference_height = 10;        // m
  double direction = 0;                // radians, the horizontal direction it blows TOWARD, counter-clockwise from +x
  double roughness_length = 0.05;      // z0 of the log profile, m
  double displacement_height = 0;      // d of the log profile, m
  double turbulence_intensity = 0.25;  // sigma_u / U at the reference height
  double length_scale = 40;            // integral length of the along-wind gusts, m
  std::filesystem::path record;        // CSV with a header and columns u_ms, v_ms (20 Hz Davos, say); empty: synthetic
  double record_height = 10;           // m above ground where the record was taken
};

/// One way of moving: a damped oscillator driven by the wind (trunk, branch, or leaf).
struct SwayMode {
  double frequency = 0.5;   // natural frequency, Hz
  double damping = 0.1;     // ratio to critical
  double deflection = 0.1;  // static tip angle in a steady 10 m/s wind, radians: the inverse of stiffness
};

struct SpeciesSource {
  std::string name;
  /// Procedural preset: broadleaf, conifer, column, shrub, birch; empty when `mesh` is given.
  std::string generator;
  std::filesystem::path mesh;  // glTF, OBJ, PLY; empty when `generator` is given
  UpAxis up = UpAxis::y;       // mesh only (glTF is y up by definition; decoder default by extension)
  double height = 0;           // m; 0: preset's own height, or the mesh's own scale
  int leaves = 0;              // 0: preset's own count; generator only
  std::uint64_t variant = 0;   // generator only: another individual of the same species
  std::vector<std::string> leaf_materials{"leaf*", "needle*", "flower*"};  // glob patterns, mesh only
  std::vector<std::string> blade_materials{"blade*"};  // the same, looked at first: grass, not a crown
  std::optional<SwayMode> trunk, branch, leaf;         // unset: the preset's
  glm::vec3 leaf_albedo{0.10f, 0.17f, 0.05f}, wood_albedo{0.16f, 0.12f, 0.09f};  // linear RGB
  int shells = 6;  // most spheres of the clustered shell of its crown
  /// Constants of the models; negative: derived from the foliage (see sim/crown.hpp).
  double alpha_rho = -1;                                        // eq. 6 of Hegeman et al. 2006, 1/m^3
  double reeves_blau_ambient = 1, reeves_blau_extinction = -1;  // A, and a in 1/m
};

struct PlantPlacement {
  std::string species;
  // By hand:
  struct Spot {
    glm::dvec2 at{0};
    double yaw = 0;  // radians
    double scale = 1;
  };
  std::vector<Spot> spots;
  // Or a seeded Poisson-disk scatter (no two closer than `spacing`):
  bool scatter = false;
  Region region;
  double spacing = 5;  // m
  int count = 0;       // 0: as many as fit
  std::array<double, 2> scale{0.8, 1.2};
};

struct GrassField {
  Region region;
  double density = 300;        // blades per m^2
  Spread height{0.35, 0.08};   // blade length, m
  Spread width{0.006, 0.001};  // at the base, m
  Spread bend{0.5, 0.25};      // tip angle at rest, radians
  Spread stiffness{1.0, 0.2};  // relative to `sway.deflection`
  SwayMode sway{1.6, 0.2, 0.9};
  double clumping = 0;  // 0 uniform random roots, towards 1 all in tufts
  glm::vec3 albedo{0.12f, 0.20f, 0.05f};
};

struct Keyframe {
  double time = 0;
  glm::dvec3 position{0};
  glm::dvec3 rotation{0};  // radians about x, then y, then z (fixed axes)
};

/// A rigid piece of an occluder. Its motion is relative to the occluder's own path.
struct OccluderPart {
  std::string name;
  enum class Shape { box, ellipsoid, capsule, mesh, stacked } shape = Shape::box;
  glm::dvec3 size{1};          // box: edges; ellipsoid: diameters; capsule: (diameter, diameter, whole length along z);
                               // mesh: factors beside `scale`
  std::filesystem::path mesh;  // mesh only
  std::string mesh_object;     // mesh only: object inside the file; empty: all
  UpAxis up = UpAxis::y;       // mesh only
  double scale = 1;            // mesh only
  std::vector<Keyframe> keyframes;   // smooth through all; one or none: fixed
  std::vector<glm::dvec3> sections;  // stacked only, which generators make: (diameter in x, in y, z), from below
};

struct OccluderSource {
  std::string name;
  std::string generator;  // walker: makes the parts (sim/walker.hpp); empty when `parts` are given
  double height = 1.8;    // m; generator only
  std::vector<OccluderPart> parts;
  std::vector<Keyframe> keyframes;  // path of the whole; z is above the terrain when `on_terrain`
  bool on_terrain = true;
  bool loop = false;  // after the last keyframe start again
  /// CSV `time_s,part,m00..m23`: recorded part-to-body matrices, in the mesh's own axes; empty: keyframes of the parts.
  std::filesystem::path motion_record;
  UpAxis motion_up = UpAxis::y;
  glm::vec3 albedo{0.35f, 0.33f, 0.30f};
};

/// Light from a picture of the whole sky instead of a uniform one.
struct EnvironmentSource {
  std::filesystem::path map;  // latitude-longitude EXR (sim/environment.hpp); empty: the sky is uniform
  double turn = 0;            // radians, counter-clockwise seen from above
  double gloss = 0;           // half-angle of the cone of sky that occluders mirror, radians; 0: they are matt
};

/// How the near field samples the neighbourhood of a fragment (Loos & Sloan 2010; `screen-rays` is our own).
struct NearField {
  int samples = 0;                   // 0: the method's own: 5 lines, 12 points, 1 area, 16 rays
  double radius = 0.25;              // m, of the ball that is looked at; length of rays
  double second_radius = 0;          // m; 0: one radius only
  std::string radii = "product";     // of two radii: product, minimum
  std::string falloff = "constant";  // constant, quadratic, cosine
  std::string normals = "buffer";    // buffer, depth (made from it), none
  double thickness = 0;              // m behind what is seen, on the mean; 0: no end, in frames the method's own
  int blur = 0;                      // radius of the edge-aware blur, pixels; 0: none
  bool half_resolution = false;
  int guard = 0;                    // pixels drawn around the image for the samples that leave it
  std::string combine = "minimum";  // with the other terms: product, minimum
};

/// How the grids of moving occluders are baked (host/trace/grid_bake.hpp).
struct GridChoice {
  int size = 32;  // samples per axis
  double epsilon =
      0.003;           // eq. 4 of Malmer et al. 2005. They take 0.1; what bodies of many parts shade reaches further
  double stretch = 3;  // how samples crowd about the middle (sim/occlusion_grid.hpp)
  int rays = 256;      // per sample
};

/// Which model shades what; names as users type them (DESIGN.md, "Words").
struct Methods {
  /// sphere-cap, ellipsoid-cap, shells-cap, shells-cap-levels, reeves-blau, crown-transmittance, crown-field,
  /// crown-baked, ambient, none
  std::string tree = "sphere-cap";
  std::string grass = "grass-height";  // grass-transmittance, grass-height, ambient, none
  /// How crowns shade others: solid-angle, -exact, -cosine, crown-shells, none.
  std::string crowns = "solid-angle-cosine";
  std::string occluders = "solid-angle-cosine";  // solid-angle, -exact, -cosine, grid, grid-cone, none
  std::string combine = "union";  // how `grid-cone` puts occluders together: multiply, simple, merge, union
  GridChoice grid = {};
  std::string near = "none";  // obscurance-point, -line, -area, screen-rays, none
  NearField near_field = {};  // of `near`
  double ambient = 0.5;       // the constant of `ambient`
};

struct Scene {
  std::filesystem::path file;  // where it was read from; relative paths inside are resolved against its folder
  std::string name;
  std::uint64_t seed = 1;
  glm::dvec3 origin{0};  // world coordinates of the scene's zero, e.g. UTM
  Sky sky = Sky::dome;
  Timing time;
  ImageSize image;
  Camera camera;
  TerrainSource terrain;
  glm::vec3 terrain_albedo{0.20f, 0.16f, 0.11f};
  bool has_terrain = true;
  WindSource wind;
  std::vector<SpeciesSource> species;
  std::vector<PlantPlacement> plants;
  std::vector<GrassField> grass;
  std::vector<OccluderSource> occluders;
  EnvironmentSource environment;
  Methods methods;
  /// What of it is drawn: brute (everything, every frame), culled (what is in view: the same pictures), thinned (and
  /// fewer, larger leaves and blades where they are smaller than pixels).
  std::string detail = "brute";
};

}  // namespace understory
