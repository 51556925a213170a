// Pictures as PNG files, by VTK's writer and reader.
#pragma once
#include <filesystem>

#include "viz/vtk/picture.hpp"

namespace understory {

/// Temporary name, sync, rename. Throws Error(input_output).
void write_png(const std::filesystem::path& path, const Picture& picture);

/// Any 8-bit PNG; grey becomes RGB, alpha is dropped. Throws Error(invalid_input).
Picture read_png(const std::filesystem::path& path);

}  // namespace understory
