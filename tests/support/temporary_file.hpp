// A text file that lives as long as its object, for tests of readers.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace understory {

class TemporaryFile {
 public:
  /// `name` keeps its extension; the folder is new for every object.
  TemporaryFile(const std::string& name, const std::string& text) {
    std::string folder = (std::filesystem::temp_directory_path() / "understory_XXXXXX").string();
    if (!mkdtemp(folder.data())) throw std::filesystem::filesystem_error("mkdtemp", folder, std::error_code());
    path_ = std::filesystem::path(folder) / name;
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove_all(path_.parent_path(), ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace understory
