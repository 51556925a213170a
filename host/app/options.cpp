// Shared options; method and size options become scene overrides so that one decoder judges all of them.
#include "host/app/options.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <optional>

#include "sim/error.hpp"
#include "sim/files/scene_file.hpp"

namespace understory {

void add_scene_options(CLI::App& command, SceneOptions& options, bool scene_flag) {
  CLI::Option* scene = command.add_option(scene_flag ? "--scene" : "SCENE", options.file, "Scene file, YAML or JSON");
  scene->required(!scene_flag);
  command.add_option("--set", options.overrides, "Override a scene key: --set wind.speed=8; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command
      .add_option("--tree", options.tree, "How crowns shade their own leaves and wood: sphere-cap, ellipsoid-cap, ...")
      ->type_name("METHOD");
  command
      .add_option("--grass", options.grass,
                  "How grass shades its own blades: grass-transmittance, grass-height, ambient, none")
      ->type_name("METHOD");
  command.add_option("--crowns", options.crowns, "How crowns shade everything else: solid-angle-cosine, ..., none")
      ->type_name("METHOD");
  command.add_option("--occluders", options.occluders, "The same for moving occluders")->type_name("METHOD");
  command
      .add_option("--near", options.near,
                  "Near field from depth and normals: obscurance-line, -point, -area, screen-rays, none")
      ->type_name("METHOD");
}

std::vector<std::string> all_overrides(const SceneOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) overrides.push_back(fmt::format("{}={}", key, value));
  };
  if (!options.size.empty()) {
    const std::size_t cross = options.size.find('x');
    const std::string width = options.size.substr(0, cross);
    const std::string height = cross == std::string::npos ? "" : options.size.substr(cross + 1);
    const auto is_number = [](const std::string& text) {
      return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    };
    if (!is_number(width) || !is_number(height))
      throw Error(ErrorKind::usage, fmt::format("--size {}: not WxH in pixels, e.g. 800x500", options.size));
    add("image.width", width);
    add("image.height", height);
  }
  add("methods.tree", options.tree);
  add("methods.grass", options.grass);
  add("methods.crowns", options.crowns);
  add("methods.occluders", options.occluders);
  add("methods.near", options.near);
  return overrides;
}

Methods methods_without_scene(const SceneOptions& options) {
  Methods methods = load_methods(all_overrides(options));
  methods.tree = methods.grass = methods.crowns = methods.occluders = "none";
  return methods;
}

Scene load_scene(const SceneOptions& options) { return load_scene(options.file, all_overrides(options)); }

void add_device_options(CLI::App& command, DeviceOptions& options) {
  command.add_option("--device", options.device, "Index, cpu, gpu, or part of a name; see `understory devices`")
      ->envname("UNDERSTORY_DEVICE");
  command.add_option("--threads", options.threads, "Processor threads to use; results do not depend on it")
      ->check(CLI::Range(1, 4096));
}

void use_threads(const DeviceOptions& options) {
  static std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  // PoCL ignores the affinity of the process and reads this variable at its first call.
  cpu_set_t allowed;
  int threads = options.threads;
  if (threads == 0 && sched_getaffinity(0, sizeof(allowed), &allowed) == 0) threads = CPU_COUNT(&allowed);
  if (threads > 0) setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(threads).c_str(), options.threads > 0);
}

}  // namespace understory
