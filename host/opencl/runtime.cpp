// PoCL's environment: signal handler, cache folder of this version and processor, repair before first use.
#include "host/opencl/runtime.hpp"

#include <sys/stat.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>

#include "host/opencl/cache_entries.hpp"
#include "sim/error.hpp"

namespace understory {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t least_free_bytes = 64 << 20;  // a full disk makes LLVM end the process

std::vector<cl::Platform> platforms() {
  std::vector<cl::Platform> found;
  try {
    cl::Platform::get(&found);
  } catch (const cl::Error&) {  // the loader's way to say that there is none
    found.clear();
  }
  return found;
}

/// "3.1" of "OpenCL 3.0 PoCL 3.1+debian ..."; empty for other platforms.
std::string pocl_version(const cl::Platform& platform) {
  const std::string text = platform.getInfo<CL_PLATFORM_VERSION>(), mark = "PoCL ";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return {};
  const std::size_t start = at + mark.size();
  return text.substr(start, text.find_first_not_of("0123456789.", start) - start);
}

/// Model name and a hash of the instruction sets: a home folder may be shared by unlike machines.
std::string processor_name() {
  std::string model = "processor", features, line;
  std::ifstream file("/proc/cpuinfo");
  while (std::getline(file, line) && !line.empty()) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    if (line.starts_with("model name")) model = line.substr(colon + 2);
    if (line.starts_with("flags") || line.starts_with("Features")) features = line.substr(colon + 2);
  }
  for (char& c : model) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return model + "-" + std::to_string(std::hash<std::string>{}(features));
}

/// Creates `folder` for this user alone. False when it cannot be used: compiled code is loaded from it, so it must not
/// belong to anybody else.
bool prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  struct stat status {};
  if (error || stat(folder.c_str(), &status) != 0 || status.st_uid != geteuid()) return false;
  if (access(folder.c_str(), R_OK | W_OK | X_OK) != 0) return false;
  const fs::space_info space = fs::space(folder, error);
  return !error && space.available >= least_free_bytes;
}

fs::path user_cache() {
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder == '/') return folder;
  if (const char* home = std::getenv("HOME"); home && *home == '/') return fs::path(home) / ".cache";
  return {};
}

fs::path choose_folder(const std::string& version) {
  const fs::path below = fs::path("pocl-" + version) / processor_name();
  std::string tried;
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  for (const fs::path& root : {user_cache() / "understory", temporary / ("understory-" + std::to_string(geteuid()))}) {
    if (!root.is_absolute()) continue;
    if (prepare_folder(root) && prepare_folder(root / below)) return root / below;
    tried += (tried.empty() ? "" : ", ") + root.string();
  }
  throw Error(ErrorKind::input_output, "no folder for compiled kernels: tried " + tried +
                                           "; one must be yours, writable and have 64 MiB free (XDG_CACHE_HOME or "
                                           "POCL_CACHE_DIR names another)");
}

/// Each frame asks for a dozen planes of some MiB and gives them back. By default glibc then returns them to the
/// system, which clears every page of the next frame's anew: a tenth of the time of a frame.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int planes = 32 << 20, several_frames = 512 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, planes);
  mallopt(M_TRIM_THRESHOLD, several_frames);
#endif
}

fs::path set_up_pocl(const std::string& version) {
  // PoCL 3.1 catches SIGFPE for the whole process: 5 / 0 on the host would silently be 5.
  setenv("POCL_SIGFPE_HANDLER", "0", 0);
  const char* chosen = std::getenv("POCL_CACHE_DIR");
  const fs::path folder = chosen && *chosen ? fs::path(chosen) : choose_folder(version);
  setenv("POCL_CACHE_DIR", folder.c_str(), 1);
  std::error_code ignored;
  if (fs::is_directory(folder, ignored)) repair_cache(folder);
  return folder;
}

}  // namespace

const fs::path& runtime_cache_folder() {
  static const fs::path folder = [] {
    keep_freed_memory();
    for (const cl::Platform& platform : platforms()) {
      const std::string version = pocl_version(platform);
      if (!version.empty()) return set_up_pocl(version);
    }
    return fs::path();
  }();
  return folder;
}

std::vector<cl::Device> all_devices() {
  runtime_cache_folder();
  std::vector<cl::Device> devices;
  for (const cl::Platform& platform : platforms()) {
    std::vector<cl::Device> found;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
    } catch (const cl::Error&) {  // a platform without devices
      continue;
    }
    devices.insert(devices.end(), found.begin(), found.end());
  }
  return devices;
}

}  // namespace understory
