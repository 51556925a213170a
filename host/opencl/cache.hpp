// Where PoCL keeps compiled kernels for this program, and how that folder is kept sound.
//
// PoCL 3.1 dies (SIGBUS, SIGABRT) when it loads a damaged entry, in every process until somebody removes it. Therefore
// a list of checksums lies beside the entries. Once per process, before PoCL reads the folder, each file is compared
// with it, files that are not yet listed are checked to be complete, and a damaged entry is removed: PoCL compiles it
// again.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace understory {

/// $POCL_CACHE_DIR if the user set it, else (XDG_CACHE_HOME or ~/.cache)/understory/pocl-VERSION/CPU; below the
/// temporary folder when that cannot be written or has less than 64 MiB free. Empty where there is no PoCL platform.
/// Throws Error(input_output) when no place can be written.
std::filesystem::path cache_folder();

struct CacheInfo {
  std::filesystem::path folder;
  std::size_t programs = 0;  // program entries
  std::size_t files = 0;     // compiled files in them
  std::uint64_t bytes = 0;   // of those files
};

CacheInfo cache_info();

/// Removes every entry and returns what was there. Touches nothing that PoCL or this module did not write.
/// Throws Error(input_output).
CacheInfo cache_clear();

}  // namespace understory
