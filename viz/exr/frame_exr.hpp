// Frames as EXR files: the product's own layout (DESIGN.md, "What machines read"), written and read without loss.
// Channels: Y (visibility), R, G, B (ambient light, under an environment map only), <method>.Y per term, P.X/Y/Z,
// N.X/Y/Z, Z, A, owner, validity, height; of truth also halfwidth and rays. No dates inside.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/frame.hpp"
#include "sim/scene.hpp"

namespace understory {

/// What the header tells beside the frame itself.
struct ExrAttributes {
  std::uint64_t seed = 0;
  Methods methods;
  std::string scene_sha256;  // of the resolved scene; empty: not stored
  std::string channels_in;   // which channels of a foreign file were taken; empty: not stored
  std::string adaptive;      // methods in words, of a run that changes them to keep a time; empty: not stored
  std::string truth;         // how truth was traced, JSON; empty: not stored
};

/// Temporary name, sync, rename. The same frame gives the same bytes. Throws Error(input_output).
void write_frame_exr(const std::filesystem::path& path, const Frame& frame, const ExrAttributes& attributes);

/// A file that write_frame_exr wrote; pass_ms stays empty. Throws Error(invalid_input) for any other.
Frame read_frame_exr(const std::filesystem::path& path);

/// Maps homogeneous scene points (column vectors) to OpenEXR's NDC: (0,0) upper left, (1,1) lower right corner of the
/// image; z is depth's reversed order near/z. Perspective only: frame.vertical_fov > 0.
glm::dmat4 world_to_ndc(const Frame& frame);

}  // namespace understory
