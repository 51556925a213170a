// `understory validate` and `understory schema`: is a scene file right, and what may stand in one.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/commands.hpp"
#include "host/app/options.hpp"
#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"

namespace understory {
namespace {

int validate(const SceneOptions& options, bool json) {
  const std::vector<std::string> errors = validate_scene(options.file, all_overrides(options));
  const bool valid = errors.empty();
  if (json) {
    const nlohmann::ordered_json object = {{"scene", options.file}, {"valid", valid}, {"errors", errors}};
    fmt::print("{}\n", object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else if (valid) {
    fmt::print("{}: valid\n", options.file);
  }
  if (!json)
    for (const std::string& error : errors) spdlog::error("{}", error);
  return valid ? 0 : static_cast<int>(ErrorKind::invalid_input);
}

}  // namespace

void add_validate(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("validate", "List everything that is wrong with a scene file");
  const auto options = std::make_shared<SceneOptions>();
  const auto json = std::make_shared<bool>(false);
  add_scene_options(*command, *options);
  command->add_flag("--json", *json, "Print {scene, valid, errors}");
  command->footer("Exit code 0: run, view and occlude accept it; 3: they do not. `understory schema` shows every key.");
  command->callback([options, json, &chosen] { chosen = [options, json] { return validate(*options, *json); }; });
}

void add_schema(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("schema", "Print the keys of scene files");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print the JSON Schema (draft 7), for editors and generators of scenes");
  command->callback([json, &chosen] {
    chosen = [json] {
      fmt::print("{}", *json ? scene_json_schema() : scene_help());
      return 0;
    };
  });
}

}  // namespace understory
