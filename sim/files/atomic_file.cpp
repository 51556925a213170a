// Temporary name, fsync, rename: POSIX calls, because std::ofstream hides a full disk until after it is closed.
#include "sim/files/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "sim/error.hpp"

namespace understory {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& doing, int code) {
  throw Error(ErrorKind::input_output, path.string() + ": cannot " + doing + ": " + std::strerror(code));
}

/// Closes on every way out; close() itself may report the full disk, so the good way calls it by hand.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags) : value_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  int value() const { return value_; }
  bool close() { return ::close(std::exchange(value_, -1)) == 0; }

 private:
  int value_;
};

void sync(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  Descriptor file(temporary, O_RDWR);
  if (file.value() < 0) fail(path, "open what was just written", errno);
  if (::fsync(file.value()) != 0 || !file.close()) fail(path, "flush to disk", errno);
}

}  // namespace

void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write) {
  // The extension stays last: some writers choose the format by it.
  const auto temporary = path.parent_path() / ("." + path.stem().string() + ".tmp-" + std::to_string(::getpid()) +
                                               path.extension().string());
  try {
    write(temporary);
    sync(temporary, path);
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail(path, "rename the finished file", errno);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    if (file.value() < 0) fail(path, "create", errno);
    for (std::string_view rest = bytes; !rest.empty();) {
      const ssize_t written = ::write(file.value(), rest.data(), rest.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path, "write", errno);
      rest.remove_prefix(static_cast<std::size_t>(written));
    }
    if (!file.close()) fail(path, "write", errno);
  });
}

}  // namespace understory
