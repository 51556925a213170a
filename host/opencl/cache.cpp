// What the commands `cache info` and `cache clear` see and do.
#include "host/opencl/cache.hpp"

#include <system_error>

#include "host/opencl/cache_entries.hpp"
#include "host/opencl/runtime.hpp"
#include "sim/error.hpp"

namespace understory {

std::filesystem::path cache_folder() { return runtime_cache_folder(); }

CacheInfo cache_info() {
  CacheInfo info;
  info.folder = cache_folder();
  if (info.folder.empty()) return info;
  for (const CacheEntry& entry : cache_entries(info.folder)) {
    ++info.programs;
    for (const std::filesystem::path& path : entry.files) {
      std::error_code gone;
      const std::uintmax_t bytes = std::filesystem::file_size(info.folder / path, gone);
      if (gone) continue;
      ++info.files;
      info.bytes += bytes;
    }
  }
  return info;
}

CacheInfo cache_clear() {
  const CacheInfo info = cache_info();
  if (info.folder.empty()) return info;
  try {
    remove_cache_entries(info.folder);
  } catch (const std::filesystem::filesystem_error& error) {
    throw Error(ErrorKind::input_output, std::string("cannot clear the kernel cache: ") + error.what());
  }
  return info;
}

}  // namespace understory
