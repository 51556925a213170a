// `understory occlude`: the visibility passes on a G-buffer that another renderer wrote.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/app/checksum.hpp"
#include "host/app/commands.hpp"
#include "host/app/gbuffer_flags.hpp"
#include "host/app/options.hpp"
#include "host/app/scene_world.hpp"
#include "host/frame/runner.hpp"
#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"
#include "viz/exr/frame_exr.hpp"
#include "viz/exr/gbuffer.hpp"

namespace understory {
namespace {

struct OccludeOptions {
  SceneOptions scene;
  DeviceOptions device;
  GbufferFlags gbuffer;
  std::string input, output, owner_channel;
  std::optional<double> time;
  bool json = false;
};

bool same_owners(const std::vector<Owner>& file, const std::vector<Owner>& world) {
  return std::equal(file.begin(), file.end(), world.begin(), world.end(), [](const Owner& a, const Owner& b) {
    return a.surface == b.surface && a.species == b.species && a.instance == b.instance;
  });
}

/// Makes the frame's owners rows of the world's table: the file's own if it came from this scene, the chosen channel's,
/// or none, and then the nearest crown counts.
void settle_owners(const OccludeOptions& options, const World& world, Gbuffer& gbuffer) {
  Frame& frame = gbuffer.frame;
  const std::uint32_t highest = frame.owner.empty() ? 0 : *std::max_element(frame.owner.begin(), frame.owner.end());
  if (!options.owner_channel.empty()) {
    if (highest >= world.owners.size())
      throw Error(ErrorKind::invalid_input,
                  fmt::format("{}: owner {} in channel {} (allowed: 0 to {}, rows of the scene's "
                              "owner table)",
                              options.input, highest, options.owner_channel, world.owners.size() - 1));
    gbuffer.notes.push_back("owner: rows of the scene's owner table");
  } else if (!same_owners(frame.owners, world.owners)) {
    std::fill(frame.owner.begin(), frame.owner.end(), 0u);
    gbuffer.notes.push_back("owner: none of this scene; each fragment inside a crown belongs to the nearest crown");
  }
  frame.owners = world.owners;
}

double mean_visibility(const Frame& frame) {
  double sum = 0;
  std::size_t covered = 0;
  for (std::size_t i = 0; i < frame.pixels(); ++i)
    if (!(frame.validity[i] & validity::background)) sum += frame.visibility[i], ++covered;
  return covered ? sum / static_cast<double>(covered) : 1;
}

void print_result(const OccludeOptions& options, const Gbuffer& gbuffer) {
  const Frame& frame = gbuffer.frame;
  std::vector<std::string> terms;
  for (const auto& [name, plane] : frame.terms) terms.push_back(name);
  if (options.json) {
    const nlohmann::ordered_json object = {{"output", options.output}, {"size", {frame.width, frame.height}},
                                           {"notes", gbuffer.notes},   {"terms", terms},
                                           {"passes", frame.pass_ms},  {"mean_visibility", mean_visibility(frame)}};
    fmt::print("{}\n", object.dump(2));
    return;
  }
  for (const std::string& note : gbuffer.notes) fmt::print("{}\n", note);
  fmt::print("terms: {}\n", fmt::join(terms, ", "));
  for (const auto& [pass, ms] : frame.pass_ms) fmt::print("{:<24}{:9.2f} ms\n", pass, ms);
  fmt::print("mean visibility {:.4f}\n{}\n", mean_visibility(frame), options.output);
}

int occlude(const OccludeOptions& options) {
  use_threads(options.device);
  GbufferOptions reading = gbuffer_options(options.gbuffer);
  if (!options.owner_channel.empty()) reading.channels["owner"] = options.owner_channel;
  Gbuffer gbuffer = read_gbuffer(options.input, reading);
  Frame& frame = gbuffer.frame;
  const double time = options.time.value_or(frame.time);
  ExrAttributes attributes;
  std::optional<World> world;
  if (!options.scene.file.empty()) {
    const Scene scene = load_scene(options.scene);
    world = read_world(scene);
    settle_owners(options, *world, gbuffer);
    if (frame.origin != scene.origin && frame.origin != glm::dvec3(0))
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("{}: its origin is ({}, {}, {}), the scene's ({}, {}, {}); allowed: the same", options.input,
                      frame.origin.x, frame.origin.y, frame.origin.z, scene.origin.x, scene.origin.y, scene.origin.z));
    frame.origin = scene.origin;
    attributes.seed = scene.seed;
    attributes.methods = scene.methods;
    const bool grass = attributes.methods.grass == "grass-transmittance";  // the others need the blades' lengths
    if (!grass) attributes.methods.grass = "none";
    attributes.scene_sha256 = sha256_of_text(resolved_scene(scene, PathStyle::file_name));
    gbuffer.notes.push_back(
        fmt::format("scene: {} at {} s; crowns and occluders, {}", options.scene.file, time,
                    grass ? "and the light among its grass"
                          : "but no grass model: the file lacks the blades' lengths (--grass grass-transmittance)"));
  } else {
    attributes.methods = methods_without_scene(options.scene);
    gbuffer.notes.push_back(
        "scene: none; only the share of the dome above each surface and the near field are computed (--scene gives "
        "crowns and occluders)");
  }
  Device device(options.device.device);
  frame.time = time;
  shade_planes(device, world ? &*world : nullptr, attributes.methods, time, frame);
  attributes.channels_in = fmt::format("{}", fmt::join(gbuffer.notes, "\n"));
  write_frame_exr(options.output, frame, attributes);
  print_result(options, gbuffer);
  return 0;
}

}  // namespace

void add_occlude(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("occlude", "Ambient visibility for a G-buffer rendered elsewhere");
  const auto options = std::make_shared<OccludeOptions>();
  command->add_option("IN", options->input, "EXR with position and normal")->required();
  command->add_option("-o,--output", options->output, "EXR to write")->required();
  add_scene_options(*command, options->scene, true);
  command->add_option("--time", options->time, "Time of the scene, s (default: what the file says, else 0)");
  add_gbuffer_options(*command, options->gbuffer);
  command->add_option("--owner-channel", options->owner_channel, "Channel of row numbers in the scene's owner table");
  add_device_options(*command, options->device);
  command->add_flag("--json", options->json, "Print what was taken and assumed as a JSON object");
  command->footer(
      "Channels are found by the names that Blender, Arnold, pbrt, Mitsuba, OSPRay and others use; two that fit "
      "equally\n"
      "well are an error that lists them: --channels position=World,normal=Ns settles it. The camera comes from the\n"
      "header, else from --camera, else it is solved from the positions. What was taken and assumed is printed and "
      "stored\n"
      "in the header attribute understory:channels_in. Positions are metres relative to the scene's origin.");
  command->callback([options, &chosen] { chosen = [options] { return occlude(*options); }; });
}

}  // namespace understory
