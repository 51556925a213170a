#include "host/app/bench_builds.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/error.hpp"

namespace understory {
namespace fs = std::filesystem;
namespace {

/// A folder that goes when this goes.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "understory-builds-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error(ErrorKind::input_output, name + ": cannot be created");
    path = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  fs::path path;
};

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// This environment with the cache of compiled kernels elsewhere.
std::vector<std::string> environment_with_cache(const fs::path& cache) {
  std::vector<std::string> variables{"POCL_CACHE_DIR=" + cache.string()};
  for (char** variable = environ; *variable; ++variable)
    if (!std::string(*variable).starts_with("POCL_CACHE_DIR=")) variables.emplace_back(*variable);
  return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Runs this program; standard output and error go to `out` and `err`. The exit code, or -1.
int run_self(std::vector<std::string> arguments, std::vector<std::string> environment, const fs::path& out,
             const fs::path& err) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const auto& [descriptor, file] : {std::pair{STDOUT_FILENO, &out}, std::pair{STDERR_FILENO, &err}})
    posix_spawn_file_actions_addopen(&files, descriptor, file->c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &files, nullptr, pointers_to(arguments).data(),
                                 pointers_to(environment).data());
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::map<std::string, BuildTimes> builds_apart(const BenchOptions& options, const fs::path& folder) {
  std::vector<std::string> arguments{"understory", "bench", "--builds"};
  if (!options.filter.empty()) arguments.insert(arguments.end(), {"--filter", options.filter});
  if (!options.device.empty()) arguments.insert(arguments.end(), {"--device", options.device});
  const fs::path out = folder / "out", err = folder / "err";
  if (const int code = run_self(arguments, environment_with_cache(folder / "cache"), out, err); code != 0)
    throw Error(ErrorKind::unexpected,
                fmt::format("'understory bench --builds' ended with {}: {}", code, text_of(err)));
  std::map<std::string, BuildTimes> times;
  std::ifstream stream(out);
  for (std::string line; std::getline(stream, line);) {
    const nlohmann::json row = nlohmann::json::parse(line);
    if (row.contains("build_ms"))
      times[row.at("name")] = {row.at("build_ms"), row.at("first_launch_ms"), row.at("items")};
  }
  return times;
}

}  // namespace

int print_builds(const BenchOptions& options) {
  time_builds(options, [](const std::string& name, const BuildTimes* times) {
    nlohmann::ordered_json row = {{"name", name}};
    if (times == nullptr)
      row["built"] = true;
    else
      row.update({{"build_ms", times->build_ms}, {"first_launch_ms", times->first_launch_ms}, {"items", times->items}});
    fmt::print("{}\n", row.dump());
    std::fflush(stdout);
  });
  return 0;
}

void add_build_times(const BenchOptions& options, BenchReport& report) {
  const ScratchFolder folder;
  fs::create_directory(folder.path / "cache");
  for (std::optional<BuildTimes> BenchResult::*when : {&BenchResult::cold, &BenchResult::warm}) {
    if (options.progress) options.progress(when == &BenchResult::cold ? "cold builds" : "warm builds");
    const std::map<std::string, BuildTimes> times = builds_apart(options, folder.path);
    for (BenchResult& result : report.results)
      if (const auto found = times.find(result.name); found != times.end()) result.*when = found->second;
  }
}

}  // namespace understory
