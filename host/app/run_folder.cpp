// Bookkeeping of an output folder with plain files: no state that a kill could leave half written.
#include "host/app/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <regex>
#include <sstream>
#include <utility>

#include "host/app/checksum.hpp"
#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr const char* record_name = "run.json";
constexpr const char* journal_name = "frames.jsonl";

Error cannot(const char* verb, const fs::path& path, int code = errno) {
  return {ErrorKind::input_output, fmt::format("{}: cannot {}: {}", path.string(), verb, std::strerror(code))};
}

/// Finished files of a run, by name.
bool is_run_file(const std::string& name) {
  static const std::regex pattern(
      R"((frame|visibility)_\d{4,}\.(exr|png|vti|vtp|ply)|(planes|geometry)\.pvd|contact_sheet\.png|movie\.ogv|)"
      R"(scene\.json|run\.json|frames\.jsonl)");
  return std::regex_match(name, pattern);
}

/// The names of unfinished files: .STEM.tmp-PROCESS.EXTENSION (write_atomically), .STEM.movie-PROCESS.ogv
/// (MovieWriter).
bool is_temporary_file(const std::string& name) {
  static const std::regex pattern(R"(\.(.+)\.(?:tmp|movie)-\d+(\.\w+)?)");
  std::smatch parts;
  return std::regex_match(name, parts, pattern) && is_run_file(parts[1].str() + parts[2].str());
}

template <typename Predicate>
void remove_files(const fs::path& folder, Predicate predicate) {
  std::vector<fs::path> doomed;
  for (const auto& entry : fs::directory_iterator(folder))
    if (predicate(entry.path().filename().string())) doomed.push_back(entry.path());
  for (const fs::path& path : doomed) {
    std::error_code error;
    if (!fs::remove(path, error)) throw cannot("remove", path, error.value());
  }
}

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw cannot("read", path);
  return text.str();
}

void write_all(int file, std::string_view text, const fs::path& path) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw cannot("write", path);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

bool verifies(const fs::path& folder, const FrameRecord& frame) {
  for (const auto& [name, sha256] : frame.files)
    if (!fs::is_regular_file(folder / name) || sha256_of_file(folder / name) != sha256) return false;
  return true;
}

int open_locked(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) throw cannot("create files in this folder; first one", path);
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  const int code = errno;
  ::close(file);
  if (code == EWOULDBLOCK)
    throw Error(ErrorKind::usage, fmt::format("{}: another process is writing this run", path.parent_path().string()));
  throw cannot("lock", path, code);
}

}  // namespace

std::string frame_file_name(std::string_view stem, int index, std::string_view extension) {
  return fmt::format("{}_{:04}.{}", stem, index, extension);
}

RunFolder::RunFolder(const fs::path& path, ExistingRun existing)
    : path_(path), replace_at_first_write_(existing == ExistingRun::replace) {
  std::error_code error;
  created_ = fs::create_directories(path_, error);
  if (error || !fs::is_directory(path_)) throw cannot("create this folder", path_, error ? error.value() : ENOTDIR);
  const bool empty = fs::is_empty(path_, error);
  if (error) throw cannot("list this folder", path_, error.value());
  if (!empty && existing == ExistingRun::refuse)
    throw Error(
        ErrorKind::usage,
        fmt::format("{}: not empty (--resume goes on with the run in it, --force replaces its files)", path_.string()));
  journal_ = open_locked(path_ / journal_name);
  if (existing != ExistingRun::resume) return;
  try {
    remove_files(path_, is_temporary_file);
    read_earlier();
  } catch (...) {
    ::close(journal_);
    throw;
  }
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (!fs::exists(path_ / record_name, ignored)) {  // nothing has begun: leave no trace
    fs::remove(path_ / journal_name, ignored);
    if (created_) fs::remove(path_, ignored);
  }
  ::close(journal_);
}

void RunFolder::read_earlier() {
  const fs::path record_path = path_ / record_name;
  if (!fs::exists(record_path)) return;
  earlier_ = parse_run_record(read_text(record_path), record_path.string());
  std::istringstream journal(read_text(path_ / journal_name));
  for (std::string line; std::getline(journal, line);) {
    try {
      const FrameRecord frame = parse_frame_record(line, journal_name);
      earlier_->frames[frame.index] = frame;
    } catch (const Error&) {  // cut off by a kill: its frame is computed again
    }
  }
  std::erase_if(earlier_->frames, [&](const auto& entry) { return !verifies(path_, entry.second); });
}

void RunFolder::write(const RunRecord& record) {
  if (std::exchange(replace_at_first_write_, false))
    remove_files(path_, [](const std::string& name) {
      return name != journal_name && (is_run_file(name) || is_temporary_file(name));
    });
  write_file_atomically(path_ / record_name, to_json_text(record));
  if (::ftruncate(journal_, 0) != 0) throw cannot("empty", path_ / journal_name);
}

void RunFolder::add(const FrameRecord& frame) { write_all(journal_, to_json_line(frame), path_ / journal_name); }

void RunFolder::finish(const RunRecord& record) {
  write_file_atomically(path_ / record_name, to_json_text(record));
  fs::remove(path_ / journal_name);
}

}  // namespace understory
