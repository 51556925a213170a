// The window of `understory view`: plays a scene, switches methods, compares two of them.
#pragma once
#include <functional>
#include <string>

#include "sim/frame.hpp"
#include "sim/scene.hpp"

namespace understory {

struct ViewOptions {
  std::string title = "Understory";
  double start = 0, end = 2;  // s; playing wraps around from end to start
  double frames_per_second = 24;
  Methods methods;  // shown at first, and what comparisons compare with
  bool playing = true;
  /// Told in words, once the window shows it: first "button NAME X Y" for every button and "slider LEFT RIGHT Y"
  /// (pixels from the window's upper left corner), then "ready", then "NAME VALUE" per change ("tree ellipsoid-cap",
  /// "play off", "show visibility", "compare difference", "time 0.50") and "closed". May be empty.
  std::function<void(const std::string& event)> on_event;
};

/// Renders one frame at a time in seconds with the given methods; every frame must have the size of the first.
using RenderFrame = std::function<Frame(double time, const Methods& methods)>;

/// Opens an X window and returns when it is closed (key q, Escape, or the window's own button). Keys: space plays and
/// pauses; left and right step; v picture or visibility; s nothing, side by side or difference; t, g, c, o the methods
/// of trees, grass, crowns and occluders. Throws Error(no_device) when there is no X display with GLX; errors that
/// `render` throws end the window and come through.
void show_window(const ViewOptions& options, const RenderFrame& render);

}  // namespace understory
