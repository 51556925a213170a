// Options that several subcommands share: which scene, with what changed in it, on which device.
#pragma once
#include <string>
#include <vector>

#include "sim/scene.hpp"

namespace CLI {
class App;
}

namespace understory {

struct SceneOptions {
  std::string file;
  std::vector<std::string> overrides;                // KEY=VALUE as after --set
  std::string size;                                  // WxH
  std::string tree, grass, crowns, occluders, near;  // method names; empty: the scene's
};

/// SCENE, --set, --size, --tree, --grass, --crowns, --occluders, --near. `scene_flag`: SCENE is the option --scene, not
/// required.
void add_scene_options(CLI::App& command, SceneOptions& options, bool scene_flag = false);

/// Every option that changes a scene key, as overrides in the order of their strength.
/// Throws Error(usage) for a size that is not WxH.
std::vector<std::string> all_overrides(const SceneOptions& options);

/// What images without a scene can be shaded with: the near field alone, and of methods.near* alone.
Methods methods_without_scene(const SceneOptions& options);

/// Reads the scene with its overrides. Throws Error(invalid_input).
Scene load_scene(const SceneOptions& options);

struct DeviceOptions {
  std::string device;
  int threads = 0;  // 0: as many as this process may use
};

/// --device, --threads.
void add_device_options(CLI::App& command, DeviceOptions& options);

/// Limits the threads of the device and of the host's own work. Call before anything touches a device.
void use_threads(const DeviceOptions& options);

}  // namespace understory
