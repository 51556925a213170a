// `understory stability`: what kernels make of the extremes, beside double precision.
#include "bench/stability.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "host/app/commands.hpp"
#include "host/app/options.hpp"
#include "host/app/progress.hpp"
#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"

namespace understory {
namespace {

struct StabilityCommand {
  DeviceOptions device;
  StabilityOptions options;
  std::string output;
  bool strict_only = false, json = false, quiet = false;
};

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    throw Error(ErrorKind::input_output, fmt::format("{}: cannot make this folder: {}", folder.string(),
                                                     error ? error.message() : "a file has this name"));
}

int stability(const StabilityCommand& command) {
  use_threads(command.device);
  const std::filesystem::path folder = command.output;
  make_folder(folder);
  StabilityOptions options = command.options;
  options.relaxed = !command.strict_only;
  std::optional<Progress> progress;
  options.progress = [&](std::size_t cases, const std::string& kernel) {
    if (!progress) progress.emplace(static_cast<int>(cases), 0, command.quiet);
    progress->advance(kernel);
  };
  const StabilityReport report = run_stability(command.device.device, options);
  progress.reset();
  if (report.rows.empty())
    throw Error(ErrorKind::usage, fmt::format("--filter {}: no kernel has this in its name", options.filter));
  const std::string json = stability_json(report);
  write_file_atomically(folder / "stability.json", json);
  write_file_atomically(folder / "stability.md", stability_markdown(report));
  if (command.json) {
    fmt::print("{}", json);
  } else {
    for (const StabilityRow& row : report.rows)
      if (!row.passed) fmt::print("failed: {}: {}\n", row.kernel, row.name);
    fmt::print("{} cases, {} failures\n{}\n", report.rows.size(), report.failures(),
               (folder / "stability.md").string());
  }
  return report.failures() == 0 ? 0 : comparison_over_threshold;
}

}  // namespace

void add_stability(CLI::App& program, Command& chosen) {
  CLI::App* app = program.add_subcommand("stability", "Try every kernel at the extremes, beside double precision");
  const auto command = std::make_shared<StabilityCommand>();
  app->add_option("-o,--output", command->output, "Folder for stability.md and stability.json")->required();
  app->add_option("--samples", command->options.samples, "Fragments of a case that is made by chance")
      ->check(CLI::Range(100, 1 << 20))
      ->capture_default_str();
  app->add_option("--filter", command->options.filter, "Only kernels whose name contains this");
  app->add_flag("--strict-only", command->strict_only, "Do not measure -cl-fast-relaxed-math beside it");
  add_device_options(*app, command->device);
  app->add_flag("--json", command->json, "Print stability.json");
  app->add_flag("--quiet", command->quiet, "No progress");
  app->footer(
      "Finite and within [0, 1] always; |error| of V at most 2e-6 in the normal domain and 1e-4 at the extremes, "
      "beside\n"
      "what tables and fits state; exit code 7 when a case fails.\n"
      "  understory stability -o stability");
  app->callback([command, &chosen] { chosen = [command] { return stability(*command); }; });
}

}  // namespace understory
