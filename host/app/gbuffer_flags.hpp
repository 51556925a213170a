// Options of the commands that read somebody else's G-buffer: which channels, space and camera.
#pragma once
#include <string>
#include <vector>

#include "viz/exr/gbuffer.hpp"

namespace CLI {
class App;
}

namespace understory {

struct GbufferFlags {
  std::string channels, space;
  std::vector<double> camera;  // position, target, vertical field of view in degrees; empty: the file's
};

/// --channels, --space, --camera.
void add_gbuffer_options(CLI::App& command, GbufferFlags& flags);

/// Throws Error(usage) for a camera that sees nothing or channel choices that cannot be read.
GbufferOptions gbuffer_options(const GbufferFlags& flags);

}  // namespace understory
