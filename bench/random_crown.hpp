// A ball of random leaves as a glTF file: the crown for which Beer and Lambert's law holds exactly on average.
#pragma once
#include <cstdint>
#include <filesystem>

namespace understory {

/// `leaves` equilateral triangles of material `leaf`, centres and directions uniform, in a ball of `radius` m that
/// stands on the ground. `optical_radius`: k R with k half the leaf area density; it decides the size of a leaf, which
/// is radius/60 for 200,000 leaves of k R = 2.9. Two files: `path` and beside it one that ends in .bin.
void write_random_crown(const std::filesystem::path& path, std::uint32_t leaves, double radius, double optical_radius);

}  // namespace understory
