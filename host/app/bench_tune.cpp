#include "host/app/bench_tune.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "bench/tune.hpp"
#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"

namespace understory {

int bench_tune(const BenchOptions& options) {
  const DeviceInfo device = Device(options.device).info();
  const std::filesystem::path file = tuning_file(device);
  if (file.empty())
    throw Error(ErrorKind::usage,
                "--tune: there is no place for the table; set HOME, XDG_CONFIG_HOME or UNDERSTORY_TUNING");
  const std::vector<TunedPass> passes = tune_passes(options);
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  write_file_atomically(file, tuning_text(device, passes, read_tuning(file)));
  fmt::print("{:24}{:>8}{:>8}{:>10}{:>14}\n", "pass", "lanes", "group", "ms", "built-in ms");
  for (const TunedPass& row : passes)
    fmt::print("{:24}{:>8}{:>8}{:10.3f}{:14.3f}\n", row.pass, row.shape.lanes ? std::to_string(row.shape.lanes) : "",
               row.shape.group ? std::to_string(row.shape.group) : "", row.ms, row.built_in_ms);
  fmt::print("{}\n", file.string());
  return 0;
}

}  // namespace understory
