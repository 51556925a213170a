// `understory truth`: the traced reference of a scene's frame, or of another renderer's G-buffer and a mesh.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "host/app/checksum.hpp"
#include "host/app/commands.hpp"
#include "host/app/gbuffer_flags.hpp"
#include "host/app/options.hpp"
#include "host/app/progress.hpp"
#include "host/frame/runner.hpp"
#include "host/trace/frame_truth.hpp"
#include "sim/error.hpp"
#include "sim/files/mesh.hpp"
#include "sim/files/scene_file.hpp"
#include "viz/exr/frame_exr.hpp"

namespace understory {
namespace {

struct TruthCommand {
  SceneOptions scene;
  DeviceOptions device;
  GbufferFlags gbuffer;
  TruthOptions truth;
  std::string output, weighting = "cosine", sky = "dome", up;
  std::vector<std::string> meshes;
  double max_distance = 0;  // 0: endless
  int frame = 0;
  bool json = false, quiet = false;
};

/// What is traced, and what the file tells about it.
struct TruthJob {
  Frame frame;
  PosedGeometry geometry;
  ExrAttributes attributes;
  std::vector<std::string> notes;
};

TruthJob job_of_scene(const TruthCommand& command) {
  Scene scene = load_scene(command.scene);
  TruthJob job;
  job.attributes.scene_sha256 = sha256_of_text(resolved_scene(scene, PathStyle::file_name));
  job.attributes.seed = scene.seed;
  // Nothing but the fragments is needed of the passes; eq. 9 has the grass's height resolved as `run` does.
  scene.methods = {.tree = "none", .grass = "grass-height", .crowns = "none", .occluders = "none"};
  job.attributes.methods = scene.methods;
  Device device(command.device.device);
  const World world = build_world(scene);
  FrameRunner runner(device, world);
  job.frame = runner.render(command.frame, scene.time.at(command.frame));
  job.geometry = runner.posed_geometry();
  return job;
}

/// Positions as they stand in the file, turned to z up.
PosedGeometry read_meshes(const TruthCommand& command) {
  PosedGeometry geometry;
  for (const std::string& file : command.meshes) {
    const bool z_up = command.up.empty() ? file.ends_with(".ply") || file.ends_with(".PLY") : command.up == "z";
    for (const RawMesh::Part& part : read_mesh(file, z_up ? UpAxis::z : UpAxis::y).parts) {
      const auto first = static_cast<std::uint32_t>(geometry.positions.size() / 3);
      for (const glm::vec3 p : part.positions) geometry.positions.insert(geometry.positions.end(), {p.x, p.y, p.z});
      for (const std::uint32_t index : part.triangles) geometry.triangles.push_back(first + index);
    }
  }
  return geometry;
}

TruthJob job_of_gbuffer(const TruthCommand& command) {
  if (command.meshes.empty())
    throw Error(ErrorKind::usage,
                fmt::format("{}: --mesh is needed: a G-buffer does not hold what blocks the sky", command.scene.file));
  Gbuffer gbuffer = read_gbuffer(command.scene.file, gbuffer_options(command.gbuffer));
  TruthJob job;
  job.geometry = read_meshes(command);
  job.frame = std::move(gbuffer.frame);
  job.attributes.channels_in = fmt::format("{}", fmt::join(gbuffer.notes, "\n"));
  job.attributes.methods = {.tree = "none", .grass = "none", .crowns = "none", .occluders = "none"};
  job.notes = std::move(gbuffer.notes);
  return job;
}

nlohmann::ordered_json describe(const TruthCommand& command, const TruthOptions& truth) {
  nlohmann::ordered_json text = {{"rays", truth.rays},
                                 {"seed", truth.seed},
                                 {"weighting", command.weighting},
                                 {"sky", truth.sky == Sky::dome ? "dome" : "sphere"}};
  if (command.max_distance > 0) text["max_distance_m"] = command.max_distance;
  return text;
}

struct Means {
  double visibility = 0, halfwidth = 0, rays = 0;
};

Means means_of(const Frame& frame) {
  Means means;
  std::size_t covered = 0;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.rays[i] == 0) continue;
    ++covered;
    means.visibility += frame.visibility[i];
    means.halfwidth += frame.halfwidth[i];
    means.rays += frame.rays[i];
  }
  if (covered == 0) return means;
  means.visibility /= static_cast<double>(covered);
  means.halfwidth /= static_cast<double>(covered);
  return means;
}

int truth(const TruthCommand& command) {
  use_threads(command.device);
  const bool external = command.scene.file.ends_with(".exr");
  if (!external && !command.meshes.empty())
    throw Error(ErrorKind::usage, "--mesh goes with a G-buffer (IN.exr); a scene brings its own geometry");
  TruthJob job = external ? job_of_gbuffer(command) : job_of_scene(command);
  TruthOptions options = command.truth;
  options.weighting = command.weighting == "uniform" ? Weighting::uniform : Weighting::cosine;
  options.sky = external ? (command.sky == "sphere" ? Sky::sphere : Sky::dome) : load_scene(command.scene).sky;
  if (command.max_distance > 0) options.max_distance = static_cast<float>(command.max_distance);

  const Tracer tracer = tracer_of(job.geometry);
  Progress progress(100, 0, command.quiet);
  int told = 0;
  const auto started = std::chrono::steady_clock::now();
  trace_frame(tracer, options, job.frame, [&](double share) {
    for (; told < static_cast<int>(100 * share); ++told) progress.advance("%");
  });
  progress.clear();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  nlohmann::ordered_json result = describe(command, options);
  job.attributes.truth = result.dump();
  write_frame_exr(command.output, job.frame, job.attributes);

  const Means means = means_of(job.frame);
  const std::size_t triangles = job.geometry.triangles.size() / 3;
  if (command.json) {
    result["output"] = command.output;
    result["size"] = {job.frame.width, job.frame.height};
    result["triangles"] = triangles;
    result["mean_visibility"] = means.visibility;
    result["mean_halfwidth"] = means.halfwidth;
    result["seconds"] = seconds;
    result["rays_per_s"] = means.rays / seconds;
    result["notes"] = job.notes;
    fmt::print("{}\n", result.dump(2));
    return 0;
  }
  for (const std::string& note : job.notes) fmt::print("{}\n", note);
  fmt::print("{} triangles, {:.1f} million rays in {:.1f} s ({:.2f} million/s)\n", triangles, means.rays * 1e-6,
             seconds, means.rays / seconds * 1e-6);
  fmt::print("mean visibility {:.4f}, mean half-width of the 95 % interval {:.4f}\n{}\n", means.visibility,
             means.halfwidth, command.output);
  return 0;
}

}  // namespace

void add_truth(CLI::App& program, Command& chosen) {
  CLI::App* app =
      program.add_subcommand("truth", "Trace the visibility that methods approximate, with its uncertainty");
  const auto command = std::make_shared<TruthCommand>();
  app->add_option("SCENE", command->scene.file, "Scene file; or an EXR with position and normal, with --mesh")
      ->required();
  app->add_option("-o,--output", command->output, "EXR to write")->required();
  app->add_option("--set", command->scene.overrides, "Override a scene key: --set wind.speed=8; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  app->add_option("--frame", command->frame, "Frame of the scene")
      ->check(CLI::Range(0, 1 << 24))
      ->capture_default_str();
  app->add_option("--size", command->scene.size, "Image size in pixels, e.g. 800x500")->type_name("WxH");
  app->add_option("--rays", command->truth.rays, "Rays a pixel, rounded up to a multiple of 8")
      ->check(CLI::Range(16, 1 << 24))
      ->capture_default_str();
  app->add_option("--seed", command->truth.seed, "Seed of the rays")->capture_default_str();
  app->add_option("--weighting", command->weighting, "cosine: V_c, what methods compute; uniform: V_u")
      ->check(CLI::IsMember({"cosine", "uniform"}))
      ->capture_default_str();
  app->add_option("--max-distance", command->max_distance,
                  "Hits farther than this do not count, m; then there is no horizon either")
      ->check(CLI::Range(1e-6, 1e9));
  app->add_option("--mesh", command->meshes, "What blocks the sky of a G-buffer: OBJ, PLY, glTF; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--up", command->up, "The axis that is up in the meshes (default: z for PLY, else y)")
      ->check(CLI::IsMember({"y", "z"}));
  app->add_option("--sky", command->sky, "Sky of a G-buffer; a scene brings its own")
      ->check(CLI::IsMember({"dome", "sphere"}))
      ->capture_default_str();
  add_gbuffer_options(*app, command->gbuffer);
  add_device_options(*app, command->device);
  app->add_flag("--json", command->json, "Print a JSON object");
  app->add_flag("--quiet", command->quiet, "No progress");
  app->footer(
      "Rays against the posed triangles of that very frame, opaque and from both sides; the same seed gives the same\n"
      "bytes on any number of threads. Beside what `run` writes, the file holds `halfwidth`, of the 95 % interval "
      "about\n"
      "Y, and `rays`. Half-widths shrink nearly as 1/rays: 256 rays give about 0.04 inside a crown.\n"
      "  understory truth sim/scenes/meadow.yaml -o truth.exr --frame 12\n"
      "  understory truth blender.exr --mesh scene.glb --sky dome -o truth.exr");
  app->callback([command, &chosen] { chosen = [command] { return truth(*command); }; });
}

}  // namespace understory
