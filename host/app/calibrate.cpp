// `understory calibrate`: the constants of the crown models of one plant, from its own triangles.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "host/app/calibration_json.hpp"
#include "host/app/commands.hpp"
#include "host/app/options.hpp"
#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "sim/files/mesh.hpp"
#include "sim/files/scene_file.hpp"
#include "sim/plants/species.hpp"

namespace understory {
namespace {

struct CalibrateOptions {
  std::string input, species, up, output;
  std::vector<std::string> leaf_materials = SpeciesSource{}.leaf_materials;
  DeviceOptions device;
  CalibrationOptions calibration;
  int shells = SpeciesSource{}.shells;
  bool json = false;
};

bool is_scene(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".yaml" || extension == ".yml" || extension == ".json";
}

/// The species that the command line names, and the seed of its generator.
std::pair<SpeciesSource, std::uint64_t> source_of(const CalibrateOptions& options) {
  if (is_scene(options.input)) {
    const Scene scene = load_scene(options.input, {});
    std::string names;
    for (const SpeciesSource& source : scene.species) {
      if (source.name == options.species) return {source, scene.seed};
      names += " " + source.name;
    }
    throw Error(ErrorKind::usage, fmt::format("{}: --species {}: there is no such species; allowed:{}", options.input,
                                              options.species, names));
  }
  SpeciesSource source;
  source.mesh = options.input;
  source.name = source.mesh.stem().string();
  source.shells = options.shells;
  source.leaf_materials = options.leaf_materials;
  const std::string extension = source.mesh.extension().string();
  const bool gltf = extension == ".glb" || extension == ".gltf";
  source.up = options.up == "z" || (options.up.empty() && !gltf) ? UpAxis::z : UpAxis::y;
  return {source, 1};
}

void print_table(const Prototype& prototype, const Calibration& c) {
  const CrownModel& m = c.model;
  fmt::print("{}: {} triangles, {} points, half of them held out\n", prototype.name, prototype.triangle_count(),
             c.points);
  fmt::print("leaf area {:.4g} m2, plant area {:.4g} m2; over the ellipsoid {:.4g} and {:.4g} 1/m\n", c.leaf_area,
             c.plant_area, c.lad_mean, c.pad_mean);
  fmt::print("k {:.4g} 1/m, clumping {:.3f}; open share off by {:+.4f} on held-out lines\n", c.k, c.clumping,
             c.open_error);
  fmt::print("alpha rho {:.4g} (sphere), {:.4g} (ellipsoid), {:.4g} (shells), {:.4g} (levels) 1/m3\n", m.alpha_rho,
             m.alpha_rho_ellipsoid, m.alpha_rho_shells, m.alpha_rho_levels);
  fmt::print("reeves-blau {:.3f} exp(-{:.4g} depth); best constant {:.3f}\n", m.reeves_blau_ambient,
             m.reeves_blau_extinction, c.ambient);
  fmt::print("opacity of the sphere's disc {:.3f}, {} clustered spheres\n\n{:<34}RMSE held out\n", m.opacity,
             m.shell_opacity.size(), "method");
  for (const auto& [method, rmse] : c.rmse_heldout) {
    std::string constants;
    const std::size_t slash = method.find('/');
    if (slash != std::string::npos) {
      const auto& fitted = c.transmittance.at(method.substr(slash + 1));
      constants = fmt::format("  k {:.4g} 1/m, near share {:.3f}, shell x {:.2f}", fitted[0], fitted[1], fitted[2]);
    }
    fmt::print("{:<34}{:.4f}{}\n", method, rmse, constants);
  }
}

int run_calibrate(const CalibrateOptions& options) {
  use_threads(options.device);
  const auto [source, seed] = source_of(options);
  RawMesh mesh;
  if (!source.mesh.empty()) mesh = read_mesh(source.mesh, source.up, source.leaf_materials);
  const Prototype prototype = build_species(source, seed, source.mesh.empty() ? nullptr : &mesh).prototype;
  const Calibration calibration = calibrate(prototype, 0, options.calibration);
  const std::string json = calibration_json(prototype, calibration).dump(2) + "\n";
  if (!options.output.empty()) write_file_atomically(options.output, json);
  if (options.json)
    fmt::print("{}", json);
  else
    print_table(prototype, calibration);
  return 0;
}

}  // namespace

void add_calibrate(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("calibrate", "Fit the constants of the crown models to one plant");
  const auto options = std::make_shared<CalibrateOptions>();
  command->add_option("MESH", options->input, "glTF, OBJ or PLY; or a scene file, with --species")->required();
  command->add_option("--species", options->species, "Of a scene: which species")->type_name("NAME");
  command->add_option("--up", options->up, "Axis that is up; left out: y for glTF, else z")
      ->check(CLI::IsMember({"y", "z"}));
  command->add_option("--leaf-materials", options->leaf_materials, "Patterns of the material names that are leaves")
      ->type_name("PATTERN");
  command->add_option("--shells", options->shells, "Most spheres around clusters of the foliage")
      ->check(CLI::Range(1, 64));
  command->add_option("--points", options->calibration.points, "Where the truth is traced")
      ->check(CLI::Range(16, 10'000'000));
  command->add_option("--rays", options->calibration.rays, "For each point")->check(CLI::Range(16, 1 << 20));
  command->add_option("--seed", options->calibration.seed, "Of points and rays");
  command->add_option("-o,--output", options->output, "Write the JSON object into this file")->type_name("FILE");
  command->add_flag("--json", options->json, "Print a JSON object");
  command->footer(
      "V_c under sky: sphere, traced where random lines from outside first meet the plant: what cameras see of it.\n"
      "`run` does the same once for each species and keeps the constants; see `understory cache info`.");
  command->add_option("--threads", options->device.threads, "Processor threads to use; results do not depend on it")
      ->check(CLI::Range(1, 4096));
  command->callback([options, &chosen] { chosen = [options] { return run_calibrate(*options); }; });
}

}  // namespace understory
