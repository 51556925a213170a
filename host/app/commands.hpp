// The subcommands of the program, one file each. Each adds its options to the parser and, when it is the one typed,
// leaves in `chosen` what is to be done.
#pragma once
#include <functional>

namespace CLI {
class App;
}

namespace understory {

/// Returns the exit code; throws Error.
using Command = std::function<int()>;

/// Exit codes beside those of ErrorKind.
inline constexpr int some_frames_failed = 6;
inline constexpr int comparison_over_threshold = 7;  // also: a budget that no methods keep
/// Exit code after a signal: 130 for SIGINT, 143 for SIGTERM.
inline constexpr int exit_code_of_signal(int signal) { return 128 + signal; }

void add_run(CLI::App& program, Command& chosen);
void add_view(CLI::App& program, Command& chosen);
void add_occlude(CLI::App& program, Command& chosen);
void add_truth(CLI::App& program, Command& chosen);
void add_compare(CLI::App& program, Command& chosen);
void add_validate(CLI::App& program, Command& chosen);
void add_schema(CLI::App& program, Command& chosen);
void add_explain(CLI::App& program, Command& chosen);
void add_calibrate(CLI::App& program, Command& chosen);
void add_bake(CLI::App& program, Command& chosen);
void add_tradeoff(CLI::App& program, Command& chosen);
void add_bench(CLI::App& program, Command& chosen);
void add_stability(CLI::App& program, Command& chosen);
void add_devices(CLI::App& program, Command& chosen);
void add_cache(CLI::App& program, Command& chosen);

}  // namespace understory
