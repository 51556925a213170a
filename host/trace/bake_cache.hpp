// Results that cost seconds of tracing, kept between runs: one file a result, named by what it is and by a hash of all
// that it depends on. A file carries a checksum; a damaged one counts as missing. Beside the cache of compiled kernels:
// $XDG_CACHE_HOME/understory/bakes or ~/.cache/understory/bakes.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "sim/random.hpp"

namespace understory {

/// 128 bits over everything that was added, in order.
class ContentHash {
 public:
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void add(std::span<const T> values) { add_bytes(values.data(), values.size_bytes()); }
  template <typename T>
  void add(const std::vector<T>& values) {
    add(std::span<const T>(values));
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void add(T value) { add_bytes(&value, sizeof value); }
  void add(std::string_view text) { add_bytes(text.data(), text.size()); }
  /// 32 hexadecimal digits.
  std::string text() const;

 private:
  void add_bytes(const void* data, std::size_t bytes);
  std::uint64_t low_ = 0x243f6a8885a308d3u, high_ = 0x13198a2e03707344u;  // digits of pi
};

/// Empty when there is no place to write: then every result is made anew.
std::filesystem::path bake_cache_folder();

/// The bytes that were stored under `kind` (letters and hyphens) and `hash`; nothing if missing or damaged.
std::optional<std::string> load_bake(std::string_view kind, const ContentHash& hash);

/// Keeps `bytes`; whole or not at all. A cache that cannot be written is no error.
void store_bake(std::string_view kind, const ContentHash& hash, std::string_view bytes);

/// While one lives, load_bake finds nothing: everything is baked anew, and kept again. For measuring what bakes cost.
class FreshBakes {
 public:
  FreshBakes();
  ~FreshBakes();
  FreshBakes(const FreshBakes&) = delete;
  FreshBakes& operator=(const FreshBakes&) = delete;
};

struct BakeCacheInfo {
  std::filesystem::path folder;
  std::size_t files = 0;    // finished results
  std::uint64_t bytes = 0;  // of them, and of what lies in folders below: work that was not finished
};

BakeCacheInfo bake_cache_info();
/// Removes every result, finished or not, and returns what was there. Throws Error(input_output).
BakeCacheInfo bake_cache_clear();

}  // namespace understory
