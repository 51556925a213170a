// Environment maps from OpenEXR files.
#pragma once
#include <filesystem>

#include "sim/environment.hpp"

namespace understory {

/// Channels R, G, B (or Y alone) of a latitude-longitude image (sim/environment.hpp says how it is turned). Negative
/// numbers down to a hundredth of the mean, which lossy compression leaves, count as 0. Throws Error(invalid_input)
/// for what is no EXR image, is not twice as wide as high, lacks the channels, or holds a number that is negative,
/// infinite or not one.
EnvironmentMap read_environment(const std::filesystem::path& path);

}  // namespace understory
