// `understory explain`: the plan of a scene in words, and what each term of it is worth.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/explain.hpp"
#include "bench/spread_json.hpp"
#include "host/app/commands.hpp"
#include "host/app/device_json.hpp"
#include "host/app/options.hpp"
#include "host/app/scene_world.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

struct ExplainCommand {
  SceneOptions scene;
  DeviceOptions device;
  ExplainOptions explain;
  bool json = false, quiet = false;
};

/// "0.3 %", and "0 %" only for none at all.
std::string percent_text(double share) {
  if (share > 0 && share < 0.0005) return "< 0.1 %";
  return fmt::format("{:.{}f} %", 100 * share, share < 0.0995 ? 1 : 0);
}

std::string worth_text(const TermWorth& worth, const ExplainOptions& options) {
  std::string text = fmt::format("changes {} of pixels by more than {:g} (rms {:.4f}, most {:.3f})",
                                 percent_text(worth.changed), options.visible, worth.rms, worth.most);
  const Spread95& cost = worth.cost_ms;
  if (cost.low <= 0 && cost.high >= 0)
    text += fmt::format(", costs nothing measurable ({:+.3f} to {:+.3f} ms)", cost.low, cost.high);
  else if (cost.median > 0)
    text += fmt::format(", costs {:.3f} ms ({:.3f} to {:.3f}), {} of shading", cost.median, cost.low, cost.high,
                        percent_text(worth.cost_share));
  else
    text += fmt::format(", saves {:.3f} ms ({:.3f} to {:.3f})", -cost.median, -cost.high, -cost.low);
  return text + (worth.could_go ? ": could go" : "");
}

void print_plan(const Plan& plan) {
  fmt::print("\nWhat runs, in order\n");
  for (const PlannedPass& pass : plan.passes)
    fmt::print("  {:<22} {}{}\n", pass.name, pass.because, pass.key.empty() ? "" : "  [" + pass.key + "]");
  fmt::print("\nWhat is left out\n");
  for (const LeftOut& left : plan.left_out)
    fmt::print("  {:<38} {}{}\n", left.what, left.because,
               left.because.starts_with(left.key) ? "" : "  [" + left.key + "]");
}

void print_footprint(const std::string& name, const Footprint& footprint) {
  fmt::print("  {:<46}{:>9.3f}{:>10.2f}{:>11.3f}{:>9.1f}{:>9.1f}{:>10}{:>9}\n", name, footprint.start_s,
             footprint.frame_ms.median, footprint.shading_ms.median, footprint.buffers_mib, footprint.peak_mib,
             footprint.programs.size(), footprint.kernels);
}

void print_explanation(const Explanation& explanation, const Scene& scene, double world_s,
                       const ExplainOptions& options) {
  fmt::print("{}: {}x{}, frames {}, by both cameras ({} covered pixels), on {}\n", scene.name, scene.image.width,
             scene.image.height, fmt::join(explanation.frames, ", "), explanation.covered, explanation.device.name);
  print_plan(explanation.plan);
  fmt::print("\nWhat each term is worth, found by leaving it out\n");
  if (explanation.terms.empty()) fmt::print("  no term can be left out\n");
  for (const TermWorth& worth : explanation.terms)
    fmt::print("  {} ({}: {}): {}\n", worth.term, worth.key, worth.method, worth_text(worth, options));
  fmt::print("\n  {:<46}{:>9}{:>10}{:>11}{:>9}{:>9}{:>10}{:>9}\n", "", "start s", "frame ms", "shading ms", "MiB",
             "peak MiB", "programs", "kernels");
  print_footprint("as planned", explanation.whole);
  for (const TermWorth& worth : explanation.terms) print_footprint("without " + worth.term, worth.without);
  fmt::print(
      "  start: uploading, building programs, drawing the first frame; before it {:.2f} s to build the scene and\n"
      "  {:.2f} s to open the device.\n"
      "  frame, shading: median device time of all passes, and of those after the resolve.\n"
      "  programs: {}\n",
      world_s, explanation.device_s, fmt::join(explanation.whole.programs, ", "));
}

Json footprint_json(const Footprint& footprint) {
  return {{"start_s", footprint.start_s},
          {"frame_ms", spread_fields.write(footprint.frame_ms)},
          {"shading_ms", spread_fields.write(footprint.shading_ms)},
          {"buffers_mib", footprint.buffers_mib},
          {"peak_buffers_mib", footprint.peak_mib},
          {"programs", footprint.programs},
          {"kernels", footprint.kernels}};
}

Json explanation_json(const Explanation& explanation, const Scene& scene, double world_s) {
  Json passes = Json::array(), left_out = Json::array(), terms = Json::array();
  for (const PlannedPass& pass : explanation.plan.passes)
    passes.push_back({{"name", pass.name}, {"program", pass.program}, {"because", pass.because}, {"key", pass.key}});
  for (const LeftOut& left : explanation.plan.left_out)
    left_out.push_back({{"what", left.what}, {"because", left.because}, {"key", left.key}});
  for (const TermWorth& worth : explanation.terms)
    terms.push_back({{"term", worth.term},
                     {"key", worth.key},
                     {"method", worth.method},
                     {"changed", worth.changed},
                     {"rms", worth.rms},
                     {"max", worth.most},
                     {"cost_ms", spread_fields.write(worth.cost_ms)},
                     {"cost_share", worth.cost_share},
                     {"could_go", worth.could_go},
                     {"without", footprint_json(worth.without)}});
  return {{"scene", scene.file.string()},
          {"device", device_json(explanation.device)},
          {"world_s", world_s},
          {"device_s", explanation.device_s},
          {"frames", explanation.frames},
          {"covered", explanation.covered},
          {"plan", passes},
          {"left_out", left_out},
          {"planned", footprint_json(explanation.whole)},
          {"terms", terms}};
}

int explain(ExplainCommand command) {
  use_threads(command.device);
  const Scene scene = load_scene(command.scene);
  const auto started = std::chrono::steady_clock::now();
  World world = read_world(scene);
  const std::chrono::duration<double> world_s = std::chrono::steady_clock::now() - started;
  command.explain.device = command.device.device;
  if (!command.quiet) command.explain.progress = [](const std::string& what) { spdlog::info("{}", what); };
  const Explanation explanation = explain_scene(std::move(world), command.explain);
  if (command.json)
    fmt::print(
        "{}\n",
        explanation_json(explanation, scene, world_s.count()).dump(2, ' ', false, Json::error_handler_t::replace));
  else
    print_explanation(explanation, scene, world_s.count(), command.explain);
  return 0;
}

}  // namespace

void add_explain(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("explain", "Say which passes a scene runs, why, and what each is worth");
  const auto options = std::make_shared<ExplainCommand>();
  add_scene_options(*command, options->scene);
  command->add_option("--size", options->scene.size, "Image size in pixels, e.g. 800x500")->type_name("WxH");
  command
      ->add_option("--frames", options->explain.frames,
                   "Frames to judge by, spread over the scene's, each seen by both cameras")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--rounds", options->explain.rounds, "Rounds of timing, every choice in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--visible", options->explain.visible, "A pixel that changes by more counts as changed")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--negligible", options->explain.negligible,
                   "A term that changes a smaller share of pixels could go")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  add_device_options(*command, options->device);
  command->add_flag("--json", options->json, "Print the same for machines");
  command->add_flag("--quiet", options->quiet, "No progress");
  command->footer(
      "Renders a few frames as planned and once without each term, and compares pictures, device time, start-up,\n"
      "memory and programs. It tells how much a term changes, not whether it makes the picture more right: for that,\n"
      "`understory tradeoff` measures every method against traced truth.\n"
      "  understory explain sim/scenes/meadow.yaml\n"
      "  understory explain sim/scenes/walker.yaml --near obscurance-line --json");
  command->callback([options, &chosen] { chosen = [options] { return explain(*options); }; });
}

}  // namespace understory
