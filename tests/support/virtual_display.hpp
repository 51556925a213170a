// An X server without a screen, a mouse and keys to drive what runs on it, and pictures of what it would show.
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace understory {

/// What the virtual screen shows: 3 bytes a pixel, RGB, top row first.
struct Screenshot {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Xvfb, started here and ended with the object. `-noreset`: a server that resets when its last client leaves breaks
/// the next window.
class VirtualDisplay {
 public:
  /// Throws std::runtime_error when Xvfb is not installed or does not start.
  VirtualDisplay(int width, int height);
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;
  ~VirtualDisplay();

  /// For the variable DISPLAY, such as ":7".
  const std::string& name() const { return name_; }
  /// Pixels from the upper left corner. Without a window manager the window lies at (0, 0).
  void click(int x, int y) const;
  /// xdotool's key names; goes to the window under the pointer.
  void key(const std::string& name) const;
  Screenshot screenshot() const;

  /// Xvfb and xdotool are installed.
  static bool available();

 private:
  void xdotool(const std::string& arguments) const;
  pid_t server_ = -1;
  std::string name_;
};

}  // namespace understory
