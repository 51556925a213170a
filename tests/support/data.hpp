// Where tests find real meshes, records and images: the folder in the variable UNDERSTORY_DATA.
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace understory {

/// Empty when the variable is unset or names no folder.
inline std::filesystem::path data_folder() {
  const char* folder = std::getenv("UNDERSTORY_DATA");
  return folder && std::filesystem::is_directory(folder) ? std::filesystem::path(folder) : std::filesystem::path();
}

}  // namespace understory

/// First line of a test that needs the data folder: skips it aloud where there is none.
#define UNDERSTORY_NEEDS_DATA() \
  if (understory::data_folder().empty()) GTEST_SKIP() << "needs real data: set UNDERSTORY_DATA to its folder"
