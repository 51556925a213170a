// Builds embedded programs, once per device and options.
#include <chrono>
#include <thread>

#include "host/opencl/device_impl.hpp"
#include "host/opencl/status.hpp"
#include "kernels/embedded.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

std::string trimmed(const std::string& text) {
  const std::string blanks(" \n\t\0", 4);
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string build_log(const cl::Program& program, const cl::Device& device) {
  std::string log;
  try {
    log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
  } catch (const cl::Error&) {  // no log is told apart below
  }
  // PoCL ends every failed log with this line, also one that says nothing else.
  if (const std::size_t at = log.rfind("Device ");
      at != std::string::npos && log.find("failed to build", at) != std::string::npos) {
    log.erase(at);
  }
  return trimmed(log);
}

}  // namespace

std::string Device::Impl::build_options(const std::string& options) const {
  std::string all = "-cl-std=CL1.2 -cl-kernel-arg-info";
  if ((' ' + options).find(" -DW=") == std::string::npos) all += " -DW=" + std::to_string(info.vector_width);
  if (info.atomic64) all += " -DUNDERSTORY_ATOMIC64";
  if (!options_of_all.empty()) all += " " + options_of_all;
  return options.empty() ? all : all + " " + options;
}

cl::Program& Device::Impl::program(const std::string& stem, const std::string& options) {
  const std::string all_options = build_options(options), key = stem + " " + all_options;
  if (const auto found = programs.find(key); found != programs.end()) return found->second;
  const std::string source = expanded_source(stem);
  const auto start = std::chrono::steady_clock::now();
  // Processes that share one cold cache disturb each other in PoCL 3.1: the build then fails without a word.
  constexpr int attempts = 5;
  for (int attempt = 1;; ++attempt) {
    cl::Program built(context, source);
    const cl_int status = clBuildProgram(built(), 1, &device(), all_options.c_str(), nullptr, nullptr);
    if (status == CL_SUCCESS) {
      build_ms[stem] += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
      return programs.emplace(key, std::move(built)).first->second;
    }
    const std::string log = build_log(built, device);
    if (status == CL_BUILD_PROGRAM_FAILURE && log.empty() && attempt < attempts) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50 << attempt));
      continue;
    }
    throw Error(ErrorKind::unexpected, "kernels/" + stem + ".cl does not build on '" + info.name + "' with '" +
                                           all_options + "': " + status_text(status) + "\n" +
                                           (log.empty() ? "(no compiler log)" : log));
  }
}

}  // namespace understory
