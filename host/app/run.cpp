// `understory run`: frames of a scene into a folder, resumable after a kill at any moment.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "host/app/commands.hpp"
#include "host/app/device_json.hpp"
#include "host/app/frame_files.hpp"
#include "host/app/frame_loop.hpp"
#include "host/app/frame_range.hpp"
#include "host/app/interrupt.hpp"
#include "host/app/options.hpp"
#include "host/app/pace.hpp"
#include "host/app/progress.hpp"
#include "host/app/run_budget.hpp"
#include "host/app/run_folder.hpp"
#include "host/app/run_identity.hpp"
#include "host/app/run_summary.hpp"
#include "host/app/scene_world.hpp"
#include "host/frame/runner.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

struct RunOptions {
  SceneOptions scene;
  DeviceOptions device;
  BudgetOptions budget;
  std::string output, frames = ":", dump = "exr,png";
  int supersample = 1;
  bool resume = false, force = false, json = false, quiet = false;
};

double peak_memory_mib() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

/// Throws Error(usage) when the folder holds frames of a run that differs from `record`.
void require_same_run(const RunFolder& folder, const RunRecord& record) {
  if (!folder.earlier()) return;
  const auto reasons = differences(*folder.earlier(), record);
  if (!reasons.empty())
    throw Error(ErrorKind::usage, fmt::format("{}: --resume needs the same run: {} (--force starts it anew)",
                                              folder.path().string(), fmt::join(reasons, "; ")));
}

/// Takes over what the interrupted run has done.
void take_over(const RunFolder& folder, RunRecord& record) {
  require_same_run(folder, record);
  if (!folder.earlier()) return;
  record.device = folder.earlier()->device;
  record.plan = folder.earlier()->plan;
  record.programs = folder.earlier()->programs;
  record.peak_rss_mib = folder.earlier()->peak_rss_mib;
  record.frames = folder.earlier()->frames;
}

void add_programs(const Device& device, RunRecord& record) {
  std::set<std::string> programs(record.programs.begin(), record.programs.end());
  for (const std::string& program : device.programs_built()) programs.insert(program);
  record.programs.assign(programs.begin(), programs.end());
}

/// Shades each frame of an adaptive run with the methods that its time so far leaves room for.
class AdaptiveChoice {
 public:
  AdaptiveChoice(std::vector<PaceStep> steps, double max_ms)
      : steps_(std::move(steps)), pace_(times_of(steps_), max_ms) {}

  /// Before a frame.
  void choose(FrameRunner& runner, FrameOutput& output) {
    const PaceStep& step = steps_[pace_.level()];
    if (chosen_ != pace_.level()) runner.choose(step.methods);
    chosen_ = pace_.level();
    output.chosen = step.name;
    output.methods = step.methods;
  }
  /// After it.
  void add(const Frame& frame) {
    double sum = 0;
    for (const auto& [pass, ms] : frame.pass_ms) sum += ms;
    pace_.add(sum);
  }

 private:
  static std::vector<double> times_of(const std::vector<PaceStep>& steps) {
    std::vector<double> times;
    for (const PaceStep& step : steps) times.push_back(step.ms);
    return times;
  }
  std::vector<PaceStep> steps_;
  Pace pace_;
  std::optional<std::size_t> chosen_;
};

/// Computes and writes the frames of `indices`; returns the signal that ended it early, or 0.
int compute_frames(const RunOptions& options, const Scene& scene, const std::vector<PaceStep>& steps,
                   const std::vector<int>& indices, int wanted, RunFolder& folder, RunRecord& record) {
  Device device(options.device.device);
  record.device = device_json(device.info()).dump();
  require_same_run(folder, record);
  const World world = read_world(scene, !steps.empty());
  FrameRunner runner(device, world);
  record.plan.clear();
  for (const PlannedPass& pass : runner.plan().passes) record.plan.push_back(pass.name);
  add_programs(device, record);
  folder.write(record);

  const FrameFiles files(folder.path(), record, scene.methods);
  Progress progress(wanted, wanted - static_cast<int>(indices.size()), options.quiet);
  std::optional<AdaptiveChoice> adaptive;
  if (!steps.empty()) adaptive.emplace(steps, options.budget.max_ms);
  const auto compute = [&](int index) -> FrameWriter {
    const auto output = std::make_shared<FrameOutput>();
    if (adaptive) adaptive->choose(runner, *output);
    const auto started = std::chrono::steady_clock::now();
    files.compute(runner, index, scene.time.at(index), *output);
    if (adaptive) adaptive->add(output->frame);
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - started;
    return [&, output, ms = elapsed.count()] {
      FrameRecord frame = files.write(*output);
      frame.ms = ms;
      folder.add(frame);
      record.frames[frame.index] = std::move(frame);
      progress.advance("frames");
    };
  };
  const FrameLoopResult result = run_frame_loop(indices, compute, interrupt_received);
  progress.clear();
  record.failed = result.failed;
  for (const FailedFrame& frame : result.failed) spdlog::error("frame {}: {}", frame.index, frame.message);
  record.peak_rss_mib = std::max(record.peak_rss_mib, peak_memory_mib());
  add_programs(device, record);
  return result.signal;
}

int run(const RunOptions& options) {
  use_threads(options.device);
  catch_interrupts();
  const std::vector<std::string> dumps = parse_dumps(options.dump);
  Scene scene = load_scene(options.scene);
  const FrameRange range = parse_frame_range(options.frames, scene.time.frames);
  RunFolder folder(options.output, options.resume  ? ExistingRun::resume
                                   : options.force ? ExistingRun::replace
                                                   : ExistingRun::refuse);
  RunBudget budget;
  if (options.budget.given()) {
    budget = choose_for_run(options.budget, options.device, scene, options.quiet);
    if (budget.signal != 0) return exit_code_of_signal(budget.signal);
    if (!budget.kept) {
      spdlog::error("{}", budget.refusal);
      return comparison_over_threshold;
    }
    scene.methods = budget.methods;
  }
  RunRecord record = describe_run(scene, dumps, options.supersample);
  if (budget.kept) record.budget = budget.record;
  take_over(folder, record);

  std::vector<int> indices;
  for (int i = 0; i < range.count(); ++i)
    if (!record.frames.contains(range.at(i))) indices.push_back(range.at(i));
  if (options.resume && !options.quiet)
    spdlog::info("{} of {} frames are there and whole", range.count() - static_cast<int>(indices.size()),
                 range.count());
  const int signal =
      indices.empty() ? 0 : compute_frames(options, scene, budget.steps, indices, range.count(), folder, record);

  record.complete = signal == 0 && record.failed.empty();
  if (record.complete) write_products(folder.path(), record, scene);
  folder.finish(record);
  fmt::print("{}", options.json ? to_json_text(record) : run_summary(folder.path(), record));
  if (signal != 0) {
    spdlog::warn("stopped by a signal; the same command with --resume goes on");
    return exit_code_of_signal(signal);
  }
  return record.failed.empty() ? 0 : some_frames_failed;
}

}  // namespace

void add_run(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("run", "Animate a scene, shade its frames, write them into a folder");
  const auto options = std::make_shared<RunOptions>();
  add_scene_options(*command, options->scene);
  command->add_option("-o,--output", options->output, "Folder to write; made if need be, else it must be empty")
      ->required();
  command
      ->add_option("--frames", options->frames,
                   "Half-open range as in Python, e.g. 0:48 or 0:48:4; N alone is one frame")
      ->type_name("A:B[:S]")
      ->capture_default_str();
  command->add_option("--size", options->scene.size, "Image size in pixels, e.g. 800x500")->type_name("WxH");
  command->add_option("--dump", options->dump, "Files of each frame, from exr, png, vtk, ply")->capture_default_str();
  command->add_option("--supersample", options->supersample, "N x N samples per pixel, for pictures and movie only")
      ->check(CLI::Range(1, 4))
      ->capture_default_str();
  CLI::Option* resume = command->add_flag("--resume", options->resume, "Go on with the run in the folder");
  command->add_flag("--force", options->force, "Replace the files of another run")->excludes(resume);
  add_budget_options(*command, options->budget);
  add_device_options(*command, options->device);
  command->add_flag("--json", options->json, "Print run.json instead of the summary");
  command->add_flag("--quiet", options->quiet, "No progress");
  command->footer(
      "Every frame is a function of (scene, seed, time): the same frame comes out alone, in any order, on any number "
      "of\n"
      "threads. After an interruption, even SIGKILL or a power cut, the same command with --resume computes what is\n"
      "missing and ends with the same bytes. Ctrl-C finishes the frame at hand first.\n"
      "--max-error and --max-ms choose the methods by what they cost and err in this scene on this device, measured\n"
      "once and kept; exit code 7 when none keeps the budget. Only with --max-ms do methods change during a run.\n"
      "  understory run sim/scenes/meadow.yaml -o out\n"
      "  understory run sim/scenes/meadow.yaml -o still --frames 12 --size 1600x1000 --supersample 3 --dump png\n"
      "  understory run sim/scenes/meadow.yaml -o right --max-error 0.15\n"
      "  understory run sim/scenes/meadow.yaml -o gale --set wind.speed=18 --set seed=7 --tree ellipsoid-cap");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace understory
