// Layout of a file: magic, checksum, then the bytes. Little-endian machines only share a cache with their like.
#include "host/trace/bake_cache.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"

namespace understory {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view magic = "understory bake 1\n";
constexpr const char* extension = ".bake";

std::atomic<int> fresh_bakes = 0;  // FreshBakes alive

std::string checksum_of(std::string_view bytes) {
  ContentHash sum;
  sum.add(bytes);
  return sum.text();
}

fs::path file_of(const fs::path& folder, std::string_view kind, const ContentHash& hash) {
  return folder / (std::string(kind) + "-" + hash.text() + extension);
}

bool usable(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  return !error && access(folder.c_str(), R_OK | W_OK | X_OK) == 0;
}

/// Kept results, and the folders of results that were not finished.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error, gone;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == extension || at->is_directory(gone)) entries.push_back(at->path());
  return entries;
}

std::uintmax_t bytes_below(const fs::path& entry) {
  std::error_code gone;
  if (!fs::is_directory(entry, gone)) {
    const std::uintmax_t bytes = fs::file_size(entry, gone);
    return gone ? 0 : bytes;
  }
  std::uintmax_t sum = 0;
  for (fs::recursive_directory_iterator at(entry, gone), end; !gone && at != end; at.increment(gone)) {
    std::error_code changed;
    const std::uintmax_t bytes = at->is_regular_file(changed) ? at->file_size(changed) : 0;
    if (!changed) sum += bytes;
  }
  return sum;
}

}  // namespace

void ContentHash::add_bytes(const void* data, std::size_t bytes) {
  const auto mix = [this](std::uint64_t word) {
    low_ = mix_bits(low_ ^ word);
    high_ = mix_bits(high_ * 0x9e3779b97f4a7c15u + word);
  };
  const char* at = static_cast<const char*>(data);
  mix(bytes);
  for (; bytes >= 8; bytes -= 8, at += 8) {
    std::uint64_t word;
    std::memcpy(&word, at, 8);
    mix(word);
  }
  std::uint64_t rest = 0;
  if (bytes > 0) std::memcpy(&rest, at, bytes);
  mix(rest);
}

std::string ContentHash::text() const {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const std::uint64_t part : {high_, low_})
    for (int shift = 60; shift >= 0; shift -= 4) text += digits[(part >> shift) & 15];
  return text;
}

fs::path bake_cache_folder() {
  std::vector<fs::path> roots;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache == '/')
    roots.emplace_back(cache);
  else if (const char* home = std::getenv("HOME"); home && *home == '/')
    roots.push_back(fs::path(home) / ".cache");
  for (const fs::path& root : roots)
    if (usable(root / "understory" / "bakes")) return root / "understory" / "bakes";
  return {};
}

std::optional<std::string> load_bake(std::string_view kind, const ContentHash& hash) {
  if (fresh_bakes > 0) return std::nullopt;
  const fs::path folder = bake_cache_folder();
  if (folder.empty()) return std::nullopt;
  std::ifstream file(file_of(folder, kind, hash), std::ios::binary);
  std::string all{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::size_t head = magic.size() + 32;
  if (all.size() < head || !std::string_view(all).starts_with(magic)) return std::nullopt;
  std::string bytes = all.substr(head);
  if (all.compare(magic.size(), 32, checksum_of(bytes)) != 0) return std::nullopt;
  return bytes;
}

void store_bake(std::string_view kind, const ContentHash& hash, std::string_view bytes) {
  const fs::path folder = bake_cache_folder();
  if (folder.empty()) return;
  std::string all(magic);
  all += checksum_of(bytes);
  all += bytes;
  try {
    write_file_atomically(file_of(folder, kind, hash), all);
  } catch (const Error&) {  // a full disk, say: the result is at hand all the same
  }
}

FreshBakes::FreshBakes() { ++fresh_bakes; }
FreshBakes::~FreshBakes() { --fresh_bakes; }

BakeCacheInfo bake_cache_info() {
  BakeCacheInfo info;
  info.folder = bake_cache_folder();
  if (info.folder.empty()) return info;
  for (const fs::path& entry : entries_of(info.folder)) {
    info.files += entry.extension() == extension;
    info.bytes += bytes_below(entry);
  }
  return info;
}

BakeCacheInfo bake_cache_clear() {
  const BakeCacheInfo info = bake_cache_info();
  for (const fs::path& entry : info.folder.empty() ? std::vector<fs::path>() : entries_of(info.folder)) {
    std::error_code error;
    fs::remove_all(entry, error);
    if (error)
      throw Error(ErrorKind::input_output, entry.string() + ": cannot clear the cache of bakes: " + error.message());
  }
  return info;
}

}  // namespace understory
