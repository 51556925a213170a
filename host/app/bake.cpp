// `understory bake`: the occlusion grid of a mesh, as VTK image data.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/commands.hpp"
#include "host/app/options.hpp"
#include "host/trace/grid_cache.hpp"
#include "sim/error.hpp"
#include "sim/files/mesh.hpp"
#include "sim/mesh_shape.hpp"
#include "viz/vtk/grid_file.hpp"

namespace understory {
namespace {

struct BakeOptions {
  std::string mesh, output, size = "32", border = "fade", up, object;
  double epsilon = 0.1;
  std::uint32_t rays = 256;
  std::uint64_t seed = 1;
  bool cone = false, floats = false, json = false;
  DeviceOptions device;
};

GridSize size_of(const std::string& text) {
  std::vector<std::uint32_t> sizes;
  std::size_t from = 0;
  while (from <= text.size()) {
    const std::size_t end = std::min(text.find('x', from), text.size());
    const std::string number = text.substr(from, end - from);
    if (number.empty() || number.size() > 7 || number.find_first_not_of("0123456789") != std::string::npos) break;
    sizes.push_back(static_cast<std::uint32_t>(std::stoul(number)));
    from = end + 1;
  }
  if (from <= text.size() || (sizes.size() != 1 && sizes.size() != 3))
    throw Error(ErrorKind::usage, fmt::format("--size {}: not N or NxNxN, e.g. 32 or 32x32x48", text));
  return sizes.size() == 1 ? GridSize{sizes[0], sizes[0], sizes[0]} : GridSize{sizes[0], sizes[1], sizes[2]};
}

struct Body {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> triangles;
};

Body read_body(const BakeOptions& options) {
  const std::filesystem::path file = options.mesh;
  const UpAxis up = options.up == "z" || (options.up.empty() && file.extension() == ".ply") ? UpAxis::z : UpAxis::y;
  Body body;
  std::string names;
  for (const RawMesh::Part& part : read_mesh(file, up).parts) {
    names += (names.empty() ? "" : ", ") + part.name;
    if (!options.object.empty() && part.name != options.object) continue;
    const auto first = static_cast<std::uint32_t>(body.vertices.size());
    body.vertices.insert(body.vertices.end(), part.positions.begin(), part.positions.end());
    for (const std::uint32_t index : part.triangles) body.triangles.push_back(first + index);
  }
  if (body.triangles.empty())
    throw Error(ErrorKind::invalid_input,
                fmt::format("--object {}: not in {} (allowed: {})", options.object, options.mesh, names));
  return body;
}

/// What 8 bits change: of the share, and of the V_c of a receiver that sees all of a sample's directions.
struct ByteError {
  double share_rms = 0, share_max = 0, visibility_max = 0;
};

ByteError byte_error(const OcclusionGrid& grid) {
  const OcclusionGrid stored = unpacked(grid, grid.has_direction() ? packed_cone(grid) : packed_share(grid));
  ByteError error;
  for (std::size_t i = 0; i < grid.samples(); ++i) {
    const double off = std::abs(double(stored.share[i]) - double(grid.share[i]));
    error.share_rms += off * off;
    error.share_max = std::max(error.share_max, off);
    const double change =
        grid.has_direction() ? 4 * double(glm::length(stored.direction[i] - grid.direction[i])) : 2 * off;
    error.visibility_max = std::max(error.visibility_max, change);
  }
  error.share_rms = std::sqrt(error.share_rms / static_cast<double>(grid.samples()));
  return error;
}

std::vector<std::string> notes_on(const Body& body) {
  const MeshShape shape = mesh_shape(body.vertices, body.triangles);
  std::vector<std::string> notes;
  if (shape.open_edges > 0)
    notes.push_back(fmt::format("the mesh is open at {} edges: it has no inside to fill", shape.open_edges));
  else if (std::abs(shape.volume) < 1e-9 * std::pow(shape.area, 1.5))
    notes.push_back("the mesh has no volume: it has no inside to fill");
  else if (shape.volume < 0)
    notes.push_back("the mesh is inside out; both sides of a triangle block, so the grid is the same");
  return notes;
}

int bake(const BakeOptions& options) {
  use_threads(options.device);
  GridSettings settings;
  settings.size = size_of(options.size);
  settings.epsilon = options.epsilon;
  settings.rays = options.rays;
  settings.seed = options.seed;
  settings.cone = options.cone;
  settings.border = options.border == "rescale" ? GridBorder::rescale : GridBorder::fade;
  check_settings(settings);
  const Body body = read_body(options);
  const std::vector<std::string> notes = notes_on(body);
  for (const std::string& note : notes) spdlog::warn("{}: {}", options.mesh, note);
  const auto start = std::chrono::steady_clock::now();
  const OcclusionGrid grid = cached_grid(body.vertices, body.triangles, settings);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_grid(options.output, grid, options.floats ? GridEncoding::floats : GridEncoding::bytes);

  const ByteError error = byte_error(grid);
  const std::size_t per_sample = (options.cone ? 4 : 1) * (options.floats ? 4 : 1);
  if (options.json) {
    const nlohmann::ordered_json object = {
        {"output", options.output},
        {"triangles", body.triangles.size() / 3},
        {"size", grid.size},
        {"low", {grid.low.x, grid.low.y, grid.low.z}},
        {"high", {grid.high.x, grid.high.y, grid.high.z}},
        {"bytes", per_sample * grid.samples()},
        {"seconds", seconds},
        {"border", grid.border},
        {"bits8_error",
         {{"share_rms", error.share_rms}, {"share_max", error.share_max}, {"visibility_max", error.visibility_max}}},
        {"notes", notes}};
    fmt::print("{}\n", object.dump(2));
    return 0;
  }
  fmt::print("{}: {} triangles, {}x{}x{} samples, {} bytes, {:.2f} s\n", options.output, body.triangles.size() / 3,
             grid.size[0], grid.size[1], grid.size[2], per_sample * grid.samples(), seconds);
  fmt::print("8 bits change the share by {:.2g} (rms {:.2g}) and a receiver's V by {:.2g} at most\n", error.share_max,
             error.share_rms, error.visibility_max);
  return 0;
}

}  // namespace

void add_bake(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("bake", "Trace the occlusion grid of a mesh");
  const auto options = std::make_shared<BakeOptions>();
  command->add_option("MESH", options->mesh, "OBJ, PLY, glTF or GLB")->required();
  command->add_option("-o,--output", options->output, "VTK image data (.vti) to write")->required();
  command->add_option("--size", options->size, "Samples per axis, 2 to 512")
      ->type_name("N|NxNxN")
      ->capture_default_str();
  command->add_option("--epsilon", options->epsilon, "Share of the sphere that may be neglected at the border")
      ->capture_default_str();
  command->add_option("--rays", options->rays, "Rays per sample")->capture_default_str();
  command->add_option("--seed", options->seed, "Of the rays' directions")->capture_default_str();
  command->add_option("--border", options->border, "How occlusion ends there: fade, or the paper's rescale")
      ->check(CLI::IsMember({"fade", "rescale"}))
      ->capture_default_str();
  command->add_flag("--cone", options->cone, "With the mean occluded direction, for grid-cone");
  command->add_flag("--float", options->floats, "Floats instead of 8 bits");
  command->add_option("--up", options->up, "The mesh's upward axis (default: z for PLY, else y)")
      ->check(CLI::IsMember({"y", "z"}));
  command->add_option("--object", options->object, "Only this object of the mesh");
  command->add_flag("--json", options->json, "Print a JSON object");
  command->add_option("--threads", options->device.threads, "Processor threads; the grid does not depend on it")
      ->check(CLI::Range(1, 4096));
  command->footer(
      "Malmer et al. 2005: at each sample the share of all directions that the mesh blocks. Scenes bake their "
      "occluders'\n"
      "grids themselves when methods.occluders is grid or grid-cone. Grids are kept by the content of mesh\n"
      "and settings; `understory cache info` says where.");
  command->callback([options, &chosen] { chosen = [options] { return bake(*options); }; });
}

}  // namespace understory
