// The files of one PoCL cache folder: FOLDER/XX/HASH/{program.bc, KERNEL/SHAPE/KERNEL.so}, and their checksums.
#pragma once
#include <cstddef>
#include <filesystem>
#include <vector>

namespace understory {

/// One program's folder, FOLDER/XX/HASH, with the compiled files in it (paths relative to FOLDER, sorted).
struct CacheEntry {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;
};

std::vector<CacheEntry> cache_entries(const std::filesystem::path& folder);

/// Removes damaged entries and left-over temporary files, and lists the checksums of new files.
/// Returns the number of entries removed. Safe while other processes do the same.
std::size_t repair_cache(const std::filesystem::path& folder);

/// Lists the checksums of files that are not listed yet, without reading the others again.
void seal_cache(const std::filesystem::path& folder);

/// Removes all entries, temporary files and the list.
void remove_cache_entries(const std::filesystem::path& folder);

}  // namespace understory
