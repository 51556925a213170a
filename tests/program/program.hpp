// The program under test, and the folders of the source tree that its tests use.
#pragma once
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/process.hpp"

namespace understory {

inline const std::string program_path = UNDERSTORY_PROGRAM;
inline const std::string scenes_folder = UNDERSTORY_SCENES;

/// `understory ARGUMENTS...` to its end.
inline FinishedProcess understory_command(std::vector<std::string> arguments,
                                          const std::vector<std::string>& environment = {}) {
  arguments.insert(arguments.begin(), program_path);
  return run_process(arguments, environment);
}

inline std::string file_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// One line, naming what went wrong: the form of every message of a failed command.
MATCHER_P(IsOneMessageWith, part, "") {
  const std::string& text = arg;
  return text.rfind("understory: error: ", 0) == 0 && text.find(part) != std::string::npos &&
         text.find('\n') == text.size() - 1;
}

}  // namespace understory
