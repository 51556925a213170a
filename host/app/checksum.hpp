// SHA-256 of what a run reads and writes, as 64 lower-case hexadecimal digits.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace understory {

std::string sha256_of_text(std::string_view text);

/// Throws Error(input_output) naming the file when it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace understory
