// Files appear under their final name only when they are whole: written beside it, synced, then renamed.
// A killed or failed writer leaves the old file, or none.
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace understory {

/// Calls `write` with a temporary name in the folder of `path`, syncs what it left there and renames it to `path`.
/// The temporary file is removed when `write` throws. Throws Error(input_output) naming `path` and the cause.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for bytes at hand.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace understory
