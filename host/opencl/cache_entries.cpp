// Walks PoCL's cache folder, recognises files that are cut off, and keeps the list of checksums under a lock.
#include "host/opencl/cache_entries.hpp"

#include <elf.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace understory {
namespace fs = std::filesystem;
namespace {

constexpr const char* list_name = "understory_checksums";
constexpr const char* lock_name = "understory_lock";

/// Held while the list is read and written. The system drops it when the process dies.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : file_(open((folder / lock_name).c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    if (file_ >= 0) flock(file_, LOCK_EX);
  }
  ~FolderLock() {
    if (file_ >= 0) close(file_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_;
};

/// PoCL spells hashes with the letters A to P: two as a folder, the rest below it.
bool is_hash(const std::string& name) {
  return !name.empty() && name.find_first_not_of("ABCDEFGHIJKLMNOP") == std::string::npos;
}

std::vector<fs::path> children(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> paths;
  for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end; at.increment(ignored)) {
    paths.push_back(at->path());
  }
  return paths;
}

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// FNV-1a, 64 bits (Fowler, Noll, Vo): any single changed byte changes it.
std::uint64_t checksum(const std::string& data) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const char byte : data) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return sum;
}

/// A linker writes the section headers last: a shared object that ends before them is cut off.
bool is_whole_shared_object(const std::string& data) {
  Elf64_Ehdr header;
  if (data.size() < sizeof header || std::memcmp(data.data(), ELFMAG, SELFMAG) != 0) return false;
  std::memcpy(&header, data.data(), sizeof header);
  const std::uint64_t headers = std::uint64_t{header.e_shentsize} * header.e_shnum;
  return header.e_shoff <= data.size() && headers <= data.size() - header.e_shoff;
}

/// LLVM bitcode is a row of blocks, each announced by its length: walk them to the end of the file.
/// A block: abbreviation id 1 in 2 bits, block id (8 bits here), new id width (4 bits), padding to 32 bits, then its
/// length in 32-bit words (LLVM Bitcode File Format, "Blocks").
bool is_whole_bitcode(const std::string& data) {
  if (data.size() < 8 || data.size() % 4 != 0 || data.compare(0, 4, "BC\xC0\xDE") != 0) return false;
  std::size_t at = 4;
  while (at < data.size()) {
    std::uint32_t words;
    if (data.size() - at < 8 || (data[at] & 3) != 1) return false;
    std::memcpy(&words, data.data() + at + 4, sizeof words);
    if (words > (data.size() - at - 8) / 4) return false;
    at += 8 + 4 * std::size_t{words};
  }
  return true;
}

bool is_whole(const fs::path& path, const std::string& data) {
  return path.extension() == ".so" ? is_whole_shared_object(data) : is_whole_bitcode(data);
}

using ChecksumList = std::map<std::string, std::uint64_t>;  // path below the folder: checksum

ChecksumList read_list(const fs::path& folder) {
  ChecksumList list;
  std::ifstream file(folder / list_name);
  std::string name;
  for (std::uint64_t sum; file >> std::hex >> sum >> name;) list[name] = sum;
  return list;
}

/// Under a temporary name first, so that a reader never sees half a list. A list that cannot be written is no error.
void write_list(const fs::path& folder, const ChecksumList& list) {
  const fs::path temporary = folder / (std::string(list_name) + ".new");
  std::ofstream file(temporary);
  for (const auto& [name, sum] : list) file << std::hex << sum << ' ' << name << '\n';
  file.close();
  std::error_code ignored;
  if (file) fs::rename(temporary, folder / list_name, ignored);
}

/// Checks the files of one entry against `listed`, adds what is new to `kept`. False: the entry is damaged.
bool check_entry(const fs::path& folder, const CacheEntry& entry, const ChecksumList& listed, bool trust_listed,
                 ChecksumList& kept) {
  for (const fs::path& path : entry.files) {
    const auto known = listed.find(path.string());
    if (known != listed.end() && trust_listed) {
      kept.insert(*known);
      continue;
    }
    const std::string data = contents(folder / path);
    const std::uint64_t sum = checksum(data);
    if (known != listed.end() ? sum != known->second : !is_whole(path, data)) return false;
    kept[path.string()] = sum;
  }
  return true;
}

std::size_t check_entries(const fs::path& folder, bool trust_listed) {
  const ChecksumList listed = read_list(folder);
  ChecksumList kept;
  std::size_t removed = 0;
  for (const CacheEntry& entry : cache_entries(folder)) {
    ChecksumList sums;
    if (check_entry(folder, entry, listed, trust_listed, sums)) {
      kept.merge(sums);
    } else {
      std::error_code ignored;
      fs::remove_all(folder / entry.folder, ignored);
      ++removed;
    }
  }
  if (kept != listed) write_list(folder, kept);
  return removed;
}

/// PoCL leaves one empty `tempfile_*` per process; a killed one may leave more. Young ones may still be in use.
void remove_temporary_files(const fs::path& folder, std::chrono::minutes older_than) {
  const auto limit = fs::file_time_type::clock::now() - older_than;
  for (const fs::path& path : children(folder)) {
    std::error_code ignored;
    const bool temporary = path.filename().string().starts_with("tempfile_");
    if (temporary && fs::last_write_time(path, ignored) <= limit) fs::remove(path, ignored);
  }
}

}  // namespace

std::vector<CacheEntry> cache_entries(const fs::path& folder) {
  std::vector<CacheEntry> entries;
  for (const fs::path& group : children(folder)) {
    if (!is_hash(group.filename().string()) || group.filename().string().size() != 2) continue;
    for (const fs::path& program : children(group)) {
      if (!is_hash(program.filename().string())) continue;
      CacheEntry entry{program.lexically_relative(folder), {}};
      std::error_code ignored;
      for (fs::recursive_directory_iterator at(program, ignored), end; !ignored && at != end; at.increment(ignored)) {
        const fs::path& path = at->path();
        const bool compiled = path.extension() == ".so" || path.filename() == "program.bc";
        if (compiled && at->is_regular_file(ignored)) entry.files.push_back(path.lexically_relative(folder));
      }
      std::sort(entry.files.begin(), entry.files.end());
      entries.push_back(std::move(entry));
    }
  }
  return entries;
}

std::size_t repair_cache(const fs::path& folder) {
  const FolderLock lock(folder);
  remove_temporary_files(folder, std::chrono::minutes(10));
  return check_entries(folder, false);
}

void seal_cache(const fs::path& folder) {
  const FolderLock lock(folder);
  check_entries(folder, true);
}

void remove_cache_entries(const fs::path& folder) {
  const FolderLock lock(folder);
  for (const CacheEntry& entry : cache_entries(folder)) {
    fs::remove_all(folder / entry.folder);
    std::error_code not_empty;
    fs::remove((folder / entry.folder).parent_path(), not_empty);
  }
  remove_temporary_files(folder, std::chrono::minutes(0));
  fs::remove(folder / list_name);
}

}  // namespace understory
