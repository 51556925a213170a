// An OpenEXR file as named planes and attributes, and nothing else of the format: the only file pair that uses the
// library. Single part, scan lines, 32 bits a sample, ZIP when written; any flat image when read.
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sim/frame.hpp"

namespace understory {

/// Header attributes by name. Unknown types are skipped when read.
struct ExrAttributeTable {
  std::map<std::string, std::string> texts;
  std::map<std::string, double> numbers;
  std::map<std::string, glm::dvec3> vectors;
  /// As the header holds them: OpenEXR multiplies row vectors, so element [row][column] of the header is
  /// matrix[row][column] here and GLM, which reads [column][row], sees the matrix for column vectors.
  std::map<std::string, glm::dmat4> matrices;
};

/// Planes are row-major, top row first, of width * height samples.
struct ExrImage {
  int width = 0, height = 0;
  std::map<std::string, Plane> floats;
  std::map<std::string, std::vector<std::uint32_t>> integers;
  ExrAttributeTable attributes;
};

/// Writes FLOAT and UINT channels with ZIP. The same image gives the same bytes. `worldToCamera` and `worldToNDC` are
/// stored in 32 bits, as the standard has them, all other numbers in 64. Throws Error(input_output).
void write_exr(const std::filesystem::path& path, const ExrImage& image);

enum class ExrSample { half_float, float32, uint32 };

struct ExrChannel {
  std::string name;  // with the part's name before it in files of several parts: "part:layer.component"
  int part = 0;
  std::string name_in_part;
  ExrSample sample = ExrSample::float32;
};

/// What a file says about itself, read without its pixels.
struct ExrHeader {
  int width = 0, height = 0;  // display window
  std::vector<ExrChannel> channels;
  ExrAttributeTable attributes;  // of the first part
  bool data_window_differs = false;
  const ExrChannel* find(const std::string& name) const;
};

/// Throws Error(invalid_input) for what is no complete flat EXR image of at most 2^28 pixels.
ExrHeader read_exr_header(const std::filesystem::path& path);

/// The named channels, in the display window; samples outside the data window are 0. HALF is widened; UINT and FLOAT
/// convert to the plane's type. Every name must be in the header.
std::vector<Plane> read_exr_floats(const std::filesystem::path& path, const ExrHeader& header,
                                   std::span<const std::string> names);
std::vector<std::vector<std::uint32_t>> read_exr_integers(const std::filesystem::path& path, const ExrHeader& header,
                                                          std::span<const std::string> names);

/// All channels of a file: UINT as integers, the rest as floats.
ExrImage read_exr(const std::filesystem::path& path);

}  // namespace understory
