// `understory cache info` and `understory cache clear`: the folders of compiled kernels and of bakes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/commands.hpp"
#include "host/opencl/cache.hpp"
#include "host/trace/bake_cache.hpp"

namespace understory {
namespace {

void print(const CacheInfo& cache, const BakeCacheInfo& bakes, bool json, const char* verb) {
  if (json) {
    const nlohmann::ordered_json object = {{"folder", cache.folder.string()},
                                           {"programs", cache.programs},
                                           {"files", cache.files},
                                           {"bytes", cache.bytes},
                                           {"bakes_folder", bakes.folder.string()},
                                           {"bakes", bakes.files},
                                           {"bakes_bytes", bakes.bytes}};
    fmt::print("{}\n", object.dump(2));
    return;
  }
  if (cache.folder.empty())
    fmt::print("no kernel cache: no PoCL platform here\n");
  else
    fmt::print("{}: {} {} programs, {} files, {:.1f} MiB\n", cache.folder.string(), verb, cache.programs, cache.files,
               static_cast<double>(cache.bytes) / (1 << 20));
  if (!bakes.folder.empty())
    fmt::print("{}: {} {} bakes, {:.1f} MiB\n", bakes.folder.string(), verb, bakes.files,
               static_cast<double>(bakes.bytes) / (1 << 20));
}

}  // namespace

void add_cache(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("cache", "Show or empty the folders of compiled kernels and of bakes");
  command->require_subcommand(1);
  command->footer(
      "PoCL keeps compiled kernels below $POCL_CACHE_DIR, else $XDG_CACHE_HOME/understory or ~/.cache/understory.\n"
      "What was traced once for a plant (crown-field, calibrations) lies in `bakes` below the last two.\n"
      "Damaged entries are found and removed at every start; emptying it only costs the next run a few seconds.");
  const auto json = std::make_shared<bool>(false);
  CLI::App* info = command->add_subcommand("info", "Where it is and how much is in it");
  info->add_flag("--json", *json, "Print a JSON object");
  info->callback([json, &chosen] {
    chosen = [json] {
      print(cache_info(), bake_cache_info(), *json, "holds");
      return 0;
    };
  });
  CLI::App* clear = command->add_subcommand("clear", "Remove every entry");
  clear->add_flag("--json", *json, "Print what was removed as a JSON object");
  clear->callback([json, &chosen] {
    chosen = [json] {
      print(cache_clear(), bake_cache_clear(), *json, "removed");
      return 0;
    };
  });
}

}  // namespace understory
