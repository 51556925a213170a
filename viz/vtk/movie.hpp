// A movie in Ogg Theora (.ogv), the one format that Debian's VTK writes; browsers and players read it.
#pragma once
#include <filesystem>
#include <memory>

#include "viz/vtk/picture.hpp"

namespace understory {

/// Writes under a temporary name; the movie appears when `finish` is called. Without it nothing is left.
/// The same pictures give the same bytes.
class MovieWriter {
 public:
  /// `frames_per_second` is rounded to a whole number, at least 1. Throws Error(input_output).
  MovieWriter(const std::filesystem::path& path, double frames_per_second);
  ~MovieWriter();
  /// All pictures must have the size of the first. Throws Error(input_output).
  void add(const Picture& picture);
  /// Throws Error(input_output); also when no picture was added.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understory
