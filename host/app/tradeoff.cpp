// `understory tradeoff`: what each method and setting of a scene costs and errs, and which of them nobody beats.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/tradeoff.hpp"
#include "host/app/checksum.hpp"
#include "host/app/commands.hpp"
#include "host/app/device_json.hpp"
#include "host/app/interrupt.hpp"
#include "host/app/options.hpp"
#include "host/app/progress.hpp"
#include "host/app/run_identity.hpp"
#include "host/app/scene_world.hpp"
#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "viz/vtk/png.hpp"
#include "viz/vtk/scatter_chart.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct TradeoffCommand {
  SceneOptions scene;
  DeviceOptions device;
  TradeoffOptions tradeoff;
  std::string output;
  bool resume = false, force = false, no_bakes = false, json = false, quiet = false;
};

/// Everything that the numbers depend on; a tradeoff is resumed only when it is unchanged.
std::string identity_of(const TradeoffCommand& command, const Scene& scene, const DeviceInfo& device) {
  const RunRecord run = describe_run(scene, {}, 1);
  const TradeoffOptions& options = command.tradeoff;
  std::string text =
      fmt::format("{} {} {} frames {} pixels {} rays {} rounds {} sweeps {} combinations {} bakes {}",
                  run.program_sha256, run.scene_sha256, device_json(device).dump(), options.frames, options.pixels,
                  options.rays, options.rounds, options.sweeps, options.combinations, options.bakes);
  for (const auto& [key, sha256] : run.inputs) text += " " + key + " " + sha256;
  return sha256_of_text(text);
}

/// Makes the folder ready, or throws Error(usage) when it holds something else.
void prepare_folder(const TradeoffCommand& command, const std::string& identity) {
  const fs::path folder = command.output, note = folder / "variants" / "identity";
  std::error_code error;
  const bool in_use = fs::exists(folder) && !fs::is_empty(folder, error);
  if (in_use && !command.resume && !command.force)
    throw Error(ErrorKind::usage, fmt::format("{}: the folder is not empty; --resume goes on with the tradeoff in it, "
                                              "--force replaces it",
                                              folder.string()));
  if (in_use && !fs::exists(note) && !fs::exists(folder / "tradeoff.json"))
    throw Error(ErrorKind::usage,
                fmt::format("{}: not the folder of a tradeoff: it would be overwritten", folder.string()));
  std::ifstream file(note);
  const std::string earlier{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (command.resume && !earlier.empty() && earlier != identity)
    throw Error(ErrorKind::usage, fmt::format("{}: --resume needs the same scene, build, device and options (--force "
                                              "starts anew)",
                                              folder.string()));
  if (command.force) {
    fs::remove_all(folder / "variants", error);
    fs::remove_all(folder / "errors", error);
  }
  fs::create_directories(folder / "variants", error);
  if (error)
    throw Error(ErrorKind::input_output,
                fmt::format("{}: cannot make this folder: {}", folder.string(), error.message()));
  write_file_atomically(note, identity);
}

ScatterChart chart_of(const TradeoffTable& table) {
  ScatterChart chart;
  chart.title = "Time and error: " + table.scene;
  chart.x_title = "ms a frame for the resolve and all visibility passes";
  chart.y_title = "RMSE of V against traced truth";
  for (const TradeoffRow& row : table.rows)
    if (row.verified && row.ms.low > 0)
      chart.points.push_back({row.ms.median, row.ms.low, row.ms.high, row.error.rmse, row.error.low, row.error.high,
                              row.pareto, row.name});
  return chart;
}

void write_table(const fs::path& folder, const TradeoffTable& table) {
  write_file_atomically(folder / "tradeoff.csv", tradeoff_csv(table));
  const ScatterChart chart = chart_of(table);
  write_png(folder / "tradeoff.png", draw_chart(chart));
  write_file_atomically(folder / "tradeoff.svg", chart_svg(chart));
  write_file_atomically(folder / "tradeoff.md", tradeoff_markdown(table));
  write_file_atomically(folder / "tradeoff.json", tradeoff_json(table));
}

void print_front(const TradeoffTable& table) {
  fmt::print("{:>9} {:>9} {:>9} {:>9}  {}\n", "ms", "frame ms", "RMSE", "MiB", "variant");
  for (const TradeoffRow& row : table.rows)
    if (row.pareto)
      fmt::print("{:>9.2f} {:>9.1f} {:>9.4f} {:>9.0f}  {}\n", row.ms.median, row.frame_ms, row.error.rmse, row.mib,
                 row.name);
}

int tradeoff(const TradeoffCommand& command) {
  use_threads(command.device);
  catch_interrupts();
  const Scene scene = load_scene(command.scene);
  Device device(command.device.device);
  TradeoffOptions options = command.tradeoff;
  options.bakes = !command.no_bakes;
  options.identity = identity_of(command, scene, device.info());
  options.folder = command.output;
  prepare_folder(command, options.identity);
  World world = read_world(scene, true);
  Progress progress(1, 0, command.quiet);
  options.progress = [&](int total, const std::string& done) { progress.advance(total, done); };
  options.stopped = [] { return interrupt_received() != 0; };
  if (!command.quiet) spdlog::info("tracing the truth of the judged pixels");
  const TradeoffTable table = measure_tradeoff(device, world, options);
  progress.clear();
  if (const int signal = interrupt_received()) {
    spdlog::warn("stopped by a signal; the same command with --resume goes on");
    return exit_code_of_signal(signal);
  }
  write_table(command.output, table);
  if (command.json)
    fmt::print("{}", tradeoff_json(table));
  else
    print_front(table);
  for (const TradeoffRow& row : table.rows)
    if (!row.verified) spdlog::error("{}: {}", row.name, row.failure);
  return 0;
}

}  // namespace

void add_tradeoff(CLI::App& program, Command& chosen) {
  CLI::App* app = program.add_subcommand("tradeoff", "Measure time and error of every method and setting of a scene");
  const auto command = std::make_shared<TradeoffCommand>();
  TradeoffOptions& options = command->tradeoff;
  app->add_option("SCENE", command->scene.file, "Scene file, YAML or JSON")->required();
  app->add_option("-o,--output", command->output, "Folder to write; made if need be, else it must be empty")
      ->required();
  app->add_option("--set", command->scene.overrides, "Override a scene key: --set wind.speed=8; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  app->add_option("--size", command->scene.size, "Image size in pixels, e.g. 800x500")->type_name("WxH");
  app->add_option("--frames", options.frames, "Frames judged, spread over the scene's; by both cameras")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app->add_option("--pixels", options.pixels, "Pixels judged in each of them")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 24))
      ->capture_default_str();
  app->add_option("--rays", options.rays, "Rays per judged pixel of the traced truth")
      ->check(CLI::Range(16, 1 << 24))
      ->capture_default_str();
  app->add_option("--rounds", options.rounds, "Times each is shaded to be timed, per sweep; fewer where it takes long")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app->add_option("--sweeps", options.sweeps, "Sweeps over the combinations that are measured whole")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app->add_option("--combinations", options.combinations, "Combinations of the predicted front that are measured whole")
      ->check(CLI::Range(2, 10000))
      ->capture_default_str();
  app->add_flag("--no-bakes", command->no_bakes, "Do not bake anew to find out how long that takes");
  CLI::Option* resume = app->add_flag("--resume", command->resume, "Go on with the tradeoff in the folder");
  app->add_flag("--force", command->force, "Replace the tradeoff in the folder")->excludes(resume);
  add_device_options(*app, command->device);
  app->add_flag("--json", command->json, "Print tradeoff.json instead of the front");
  app->add_flag("--quiet", command->quiet, "No progress");
  app->footer(
      "Writes tradeoff.md (read this first), .csv, .json, a chart as .png and .svg, and pictures of the errors. "
      "Methods "
      "are\nmeasured one by one, then the combinations that these predict to be best, whole. Every variant is kept as "
      "soon as it\nis measured: after an interruption the same command with --resume goes on. Minutes for a scene such "
      "as the meadow.\n"
      "  understory tradeoff sim/scenes/meadow.yaml -o trade\n"
      "  understory tradeoff sim/scenes/walker.yaml -o quick --frames 1 --pixels 500 --sweeps 1 --no-bakes");
  app->callback([command, &chosen] { chosen = [command] { return tradeoff(*command); }; });
}

}  // namespace understory
