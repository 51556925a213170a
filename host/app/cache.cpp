// `understory cache info` and `understory cache clear`: the folder of compiled kernels.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/commands.hpp"
#include "host/opencl/cache.hpp"

namespace understory {
namespace {

void print(const CacheInfo& cache, bool json, const char* verb) {
  if (json) {
    const nlohmann::ordered_json object = {{"folder", cache.folder.string()},
                                           {"programs", cache.programs},
                                           {"files", cache.files},
                                           {"bytes", cache.bytes}};
    fmt::print("{}\n", object.dump(2));
  } else if (cache.folder.empty()) {
    fmt::print("no kernel cache: no PoCL platform here\n");
  } else {
    fmt::print("{}: {} {} programs, {} files, {:.1f} MiB\n", cache.folder.string(), verb, cache.programs, cache.files,
               static_cast<double>(cache.bytes) / (1 << 20));
  }
}

}  // namespace

void add_cache(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("cache", "Show or empty the folder of compiled kernels");
  command->require_subcommand(1);
  command->footer(
      "PoCL keeps compiled kernels below $POCL_CACHE_DIR, else $XDG_CACHE_HOME/understory or ~/.cache/understory.\n"
      "Damaged entries are found and removed at every start; emptying it only costs the next run a few seconds.");
  const auto json = std::make_shared<bool>(false);
  CLI::App* info = command->add_subcommand("info", "Where it is and how much is in it");
  info->add_flag("--json", *json, "Print a JSON object");
  info->callback([json, &chosen] {
    chosen = [json] {
      print(cache_info(), *json, "holds");
      return 0;
    };
  });
  CLI::App* clear = command->add_subcommand("clear", "Remove every entry");
  clear->add_flag("--json", *json, "Print what was removed as a JSON object");
  clear->callback([json, &chosen] {
    chosen = [json] {
      print(cache_clear(), *json, "removed");
      return 0;
    };
  });
}

}  // namespace understory
