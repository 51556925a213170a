// Apart from the window, because Xlib defines macros with everyday names.
#include "viz/vtk/display_check.hpp"

#include <X11/Xlib.h>

#include <cstdlib>
#include <string>

#include "sim/error.hpp"

namespace understory {

void check_display() {
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0')
    throw Error(ErrorKind::no_device,
                "no display: DISPLAY is not set; open the window from a desktop session, or under xvfb-run "
                "(`run` writes pictures without a display)");
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr)
    throw Error(ErrorKind::no_device, "display " + std::string(name) + " (from DISPLAY) cannot be opened");
  int opcode, event, error;
  const bool has_glx = XQueryExtension(display, "GLX", &opcode, &event, &error) != 0;
  XCloseDisplay(display);
  if (!has_glx)
    throw Error(ErrorKind::no_device, "display " + std::string(name) + " has no GLX, which the window needs");
}

}  // namespace understory
