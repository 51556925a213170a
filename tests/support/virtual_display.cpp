// Xvfb by fork and exec, xdotool by the shell, screenshots by Xlib.
#include "tests/support/virtual_display.hpp"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace understory {
namespace {

/// One line from Xvfb's -displayfd, or "" after `timeout_ms`.
std::string read_line(int descriptor, int timeout_ms) {
  std::string line;
  pollfd waiting{descriptor, POLLIN, 0};
  for (char c = 0; poll(&waiting, 1, timeout_ms) > 0 && read(descriptor, &c, 1) == 1 && c != '\n';) line += c;
  return line;
}

}  // namespace

bool VirtualDisplay::available() {
  return std::system("command -v Xvfb >/dev/null && command -v xdotool >/dev/null") == 0;
}

VirtualDisplay::VirtualDisplay(int width, int height) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
  const std::string descriptor = std::to_string(ends[1]);
  server_ = fork();
  if (server_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    close(ends[0]);
    execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", screen.c_str(), "-noreset", "-nolisten",
           "tcp", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  const std::string number = read_line(ends[0], 10000);
  close(ends[0]);
  if (number.empty()) throw std::runtime_error("Xvfb did not start");
  name_ = ":" + number;
}

VirtualDisplay::~VirtualDisplay() {
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

void VirtualDisplay::xdotool(const std::string& arguments) const {
  const std::string command = "DISPLAY=" + name_ + " xdotool " + arguments;
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // events that come faster are lost (VTK 9.1)
}

void VirtualDisplay::click(int x, int y) const {
  xdotool("mousemove " + std::to_string(x) + " " + std::to_string(y));
  xdotool("mousedown 1");
  xdotool("mouseup 1");
}

void VirtualDisplay::key(const std::string& name) const { xdotool("key " + name); }

Screenshot VirtualDisplay::screenshot() const {
  Display* display = XOpenDisplay(name_.c_str());
  if (display == nullptr) throw std::runtime_error("cannot open display " + name_);
  XWindowAttributes root;
  XGetWindowAttributes(display, DefaultRootWindow(display), &root);
  XImage* image = XGetImage(display, DefaultRootWindow(display), 0, 0, static_cast<unsigned>(root.width),
                            static_cast<unsigned>(root.height), AllPlanes, ZPixmap);
  Screenshot shot{root.width, root.height, {}};
  for (int y = 0; y < shot.height; ++y)
    for (int x = 0; x < shot.width; ++x) {
      const unsigned long pixel = XGetPixel(image, x, y);
      for (const int shift : {16, 8, 0}) shot.rgb.push_back(static_cast<std::uint8_t>(pixel >> shift & 0xff));
    }
  XDestroyImage(image);
  XCloseDisplay(display);
  return shot;
}

}  // namespace understory
