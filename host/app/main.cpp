// The program `understory`: parses the command line, runs one command, turns errors into one line and an exit code.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>
#include <system_error>

#include "host/app/commands.hpp"
#include "sim/error.hpp"

namespace {

using namespace understory;

constexpr const char* footer = R"(First steps:
  understory validate sim/scenes/meadow.yaml          is the scene right?
  understory run sim/scenes/meadow.yaml -o out        frames, contact sheet and movie into out/
  understory view sim/scenes/meadow.yaml              play it in a window

Standard output carries results, standard error the log and progress.
Exit codes: 0 done, 1 unexpected failure, 2 usage, 3 invalid input, 4 no usable device, 5 input/output,
6 some frames failed, 7 comparison over its threshold or a budget that no methods keep, 130 or 143 stopped by a signal
with the current frame finished.)";

/// Log and messages go to standard error; colours only on a terminal and without NO_COLOR (https://no-color.org).
void set_up_log() {
  const char* no_color = std::getenv("NO_COLOR");
  const auto mode = no_color && *no_color ? spdlog::color_mode::never : spdlog::color_mode::automatic;
  spdlog::set_default_logger(spdlog::stderr_color_mt("understory", mode));
  spdlog::set_pattern("%n: %^%l%$: %v");
}

/// Results that could not be written are a failure even when the command itself went well.
int flush_results(int exit_code) {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0) return exit_code;
  spdlog::error("standard output: cannot write the results");
  return exit_code == 0 ? static_cast<int>(ErrorKind::input_output) : exit_code;
}

int run_command(const Command& command) {
  try {
    return flush_results(command());
  } catch (const Error& error) {
    spdlog::error("{}", error.what());
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    spdlog::error("out of memory: try a smaller --size, fewer plants or less grass");
  } catch (const std::system_error& error) {  // of files, and of printing to a standard output that is full
    spdlog::error("{}", error.what());
    return static_cast<int>(ErrorKind::input_output);
  } catch (const std::exception& error) {
    spdlog::error("unexpected: {}", error.what());
  }
  return static_cast<int>(ErrorKind::unexpected);
}

}  // namespace

int main(int argument_count, char** arguments) {
  set_up_log();
  CLI::App program("Ambient visibility of wind-blown vegetation, computed with OpenCL.", "understory");
  program.footer(footer);
  program.set_version_flag("--version", "understory " UNDERSTORY_VERSION);
  program.require_subcommand(1);
  Command chosen;
  add_run(program, chosen);
  add_view(program, chosen);
  add_occlude(program, chosen);
  add_truth(program, chosen);
  add_compare(program, chosen);
  add_validate(program, chosen);
  add_schema(program, chosen);
  add_explain(program, chosen);
  add_calibrate(program, chosen);
  add_bake(program, chosen);
  add_tradeoff(program, chosen);
  add_bench(program, chosen);
  add_stability(program, chosen);
  add_devices(program, chosen);
  add_cache(program, chosen);
  try {
    program.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? flush_results(0) : static_cast<int>(ErrorKind::usage);
  }
  return run_command(chosen);
}
