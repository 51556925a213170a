// A G-buffer that another renderer wrote: position and normal per pixel, and what else can be found, as a Frame.
// Nothing is guessed silently: which channels, space and camera were taken is told line by line.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/frame.hpp"
#include "sim/scene.hpp"

namespace understory {

enum class GbufferSpace { automatic, world, camera };

struct GbufferOptions {
  std::map<std::string, std::string> channels;  // role to layer, see viz/exr/channel_roles.hpp
  GbufferSpace space = GbufferSpace::automatic;
  std::optional<Camera> camera;  // for files whose header has none and whose positions determine none
};

struct Gbuffer {
  Frame frame;                     // visibility and terms are empty; owner is 0 unless its channel was chosen
  std::vector<std::string> notes;  // for a person and for `understory:channels_in`: "position: P.X/P.Y/P.Z", ...
};

/// Background (validity 1): alpha 0, depth >= 1e9, a normal of length 0, or a position that is not finite.
/// Normals are made unit and turned to the viewer; depth is computed from position and camera.
/// Frames of this program come back whole, owners and all. Throws Error(invalid_input) naming file and channels.
Gbuffer read_gbuffer(const std::filesystem::path& path, const GbufferOptions& options = {});

}  // namespace understory
