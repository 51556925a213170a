// `understory view`: plays a scene in a window.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "host/app/commands.hpp"
#include "host/app/options.hpp"
#include "host/app/scene_world.hpp"
#include "host/frame/runner.hpp"
#include "viz/vtk/display_check.hpp"
#include "viz/vtk/window.hpp"

namespace understory {
namespace {

struct ViewCommand {
  SceneOptions scene;
  DeviceOptions device;
  bool paused = false, events = false;
};

bool same_methods(const Methods& a, const Methods& b) {
  return a.tree == b.tree && a.grass == b.grass && a.crowns == b.crowns && a.occluders == b.occluders &&
         a.ambient == b.ambient;
}

int view(const ViewCommand& options) {
  check_display();
  use_threads(options.device);
  const Scene scene = load_scene(options.scene);
  Device device(options.device.device);
  const World world = read_world(scene, true);
  FrameRunner runner(device, world);
  Methods chosen = scene.methods;

  ViewOptions window;
  window.title = "Understory: " + (scene.name.empty() ? options.scene.file : scene.name);
  window.start = scene.time.start;
  window.end = scene.time.at(scene.time.frames);
  window.frames_per_second = scene.time.frames_per_second;
  window.methods = scene.methods;
  window.playing = !options.paused;
  if (options.events)
    window.on_event = [](const std::string& event) {
      fmt::print("{}\n", event);
      std::fflush(stdout);
    };
  show_window(window, [&](double time, const Methods& methods) {
    if (!same_methods(methods, chosen)) runner.choose(chosen = methods);
    return runner.render(static_cast<int>(std::lround((time - scene.time.start) * scene.time.frames_per_second)), time);
  });
  return 0;
}

}  // namespace

void add_view(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("view", "Play a scene in a window, switch and compare methods");
  const auto options = std::make_shared<ViewCommand>();
  add_scene_options(*command, options->scene);
  command->add_option("--size", options->scene.size, "Image size in pixels, e.g. 800x500")->type_name("WxH");
  add_device_options(*command, options->device);
  command->add_flag("--paused", options->paused, "Do not play at first");
  command->add_flag("--events", options->events, "Print what happens in the window, one line each, for scripts");
  command->footer(
      "Keys, each with a button: space plays and pauses; left and right step; v picture or visibility; s one method, "
      "two\n"
      "side by side, or their difference; t, g, c, o the methods of trees, grass, crowns and occluders; q ends.\n"
      "Needs an X display; `understory run` does not.");
  command->callback([options, &chosen] { chosen = [options] { return view(*options); }; });
}

}  // namespace understory
