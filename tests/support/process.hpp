// Starts programs as a shell would and keeps what they print: for tests of commands as a user types them.
// posix_spawn, because a fork after the first OpenCL call hangs the child (POCL.md).
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace understory {

struct FinishedProcess {
  int exit_code = -1;  // 128 + signal for a killed process, as in a shell
  std::string out, err;
};

/// A running child with empty standard input; killed when it goes out of scope.
class Process {
 public:
  /// `environment`: "NAME=VALUE" added to this process's own; a later entry wins.
  explicit Process(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {}) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, out_path().c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&files, 2, err_path().c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    std::vector<std::string> all(environment.rbegin(), environment.rend());  // the first entry of a name counts
    for (char** entry = environ; *entry; ++entry) all.push_back(*entry);
    const int failure = posix_spawnp(&pid_, arguments.front().c_str(), &files, nullptr, pointers(arguments).data(),
                                     pointers(all).data());
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) throw std::runtime_error("cannot start " + arguments.front());
  }
  ~Process() {
    if (pid_ > 0) send(SIGKILL), wait();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { ::kill(pid_, signal); }
  std::string out() const { return text_of(out_path()); }
  std::string err() const { return text_of(err_path()); }

  FinishedProcess wait() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return {WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status), out(), err()};
  }

  /// Polls `ready` until it holds; false when the time is over or the process has ended.
  template <typename Condition>
  bool wait_until(Condition ready, std::chrono::seconds limit = std::chrono::seconds(60)) const {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (!ready()) {
      siginfo_t info = {};
      const bool ended = ::waitid(P_PID, pid_, &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid_;
      if (ended || std::chrono::steady_clock::now() > deadline) return ready();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

 private:
  static std::vector<char*> pointers(const std::vector<std::string>& texts) {
    std::vector<char*> list;
    for (const std::string& text : texts) list.push_back(const_cast<char*>(text.c_str()));
    list.push_back(nullptr);
    return list;
  }
  static std::string text_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  std::filesystem::path out_path() const { return folder_.path() / "out"; }
  std::filesystem::path err_path() const { return folder_.path() / "err"; }

  TemporaryFolder folder_;
  pid_t pid_ = -1;
};

inline FinishedProcess run_process(const std::vector<std::string>& arguments,
                                   const std::vector<std::string>& environment = {}) {
  return Process(arguments, environment).wait();
}

}  // namespace understory
