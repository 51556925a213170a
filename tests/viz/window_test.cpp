// The window, driven like a person would: real clicks and keys on a virtual display, judged by what the screen shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <sstream>

#include "sim/error.hpp"
#include "tests/support/virtual_display.hpp"
#include "tests/viz/synthetic_frame.hpp"
#include "viz/vtk/png.hpp"
#include "viz/vtk/sky_light.hpp"
#include "viz/vtk/view_state.hpp"
#include "viz/vtk/window.hpp"

namespace understory {
namespace {

constexpr int width = 640, height = 360;

/// Visibility depends on the chosen methods: `none` for the occluders leaves open-dome only.
Frame render(double time, const Methods& methods) {
  Frame frame = synthetic_frame(width, height, time);
  if (methods.occluders == "none") frame.visibility = frame.terms.at("open-dome");
  if (methods.tree == "ambient")
    for (std::size_t i = 0; i < frame.pixels(); ++i)
      if (frame.owner[i] == 2) frame.visibility[i] = 0.1f;
  return frame;
}

/// `show_window` in a process of its own, its events line by line.
class WindowProcess {
 public:
  WindowProcess(const VirtualDisplay& display, ViewOptions options, RenderFrame render_frame = render) {
    int ends[2];
    if (pipe(ends) != 0) std::abort();
    child_ = fork();
    if (child_ == 0) {
      close(ends[0]);
      setenv("DISPLAY", display.name().c_str(), 1);
      options.on_event = [&](const std::string& event) { dprintf(ends[1], "%s\n", event.c_str()); };
      int code = 0;
      try {
        show_window(options, render_frame);
      } catch (const Error& error) {
        dprintf(ends[1], "error %s\n", error.what());
        code = static_cast<int>(error.kind());
      }
      _exit(code);
    }
    close(ends[1]);
    events_ = ends[0];
    for (std::string line; (line = next()) != "ready" && !line.empty();) {
      std::istringstream words(line);
      std::string kind, name;
      words >> kind;
      if (kind == "button") words >> name >> buttons[name].first >> buttons[name].second;
      if (kind == "slider") words >> slider_left >> slider_right >> slider_y;
      if (kind == "error") ADD_FAILURE() << line;
    }
  }
  ~WindowProcess() {
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
    close(events_);
  }

  /// The next event, "" after 20 s or at the end.
  std::string next() {
    std::string line;
    pollfd waiting{events_, POLLIN, 0};
    for (char c = 0; poll(&waiting, 1, 20000) > 0 && read(events_, &c, 1) == 1 && c != '\n';) line += c;
    return line;
  }

  /// Waits for the end; the exit code, or -1 when a signal ended it.
  int wait() {
    int status = 0;
    waitpid(std::exchange(child_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::map<std::string, std::pair<int, int>> buttons;
  int slider_left = 0, slider_right = 0, slider_y = 0;

 private:
  pid_t child_ = -1;
  int events_ = -1;
};

/// The upper part of the screen, where the picture is.
Picture picture_of(const Screenshot& shot, const char* name) {
  Picture picture(shot.width, height, glm::u8vec3(0));
  std::copy_n(shot.rgb.begin(), picture.rgb.size(), picture.rgb.begin());
  if (const char* folder = std::getenv("UNDERSTORY_TEST_OUT")) {
    Picture whole(shot.width, shot.height, glm::u8vec3(0));
    whole.rgb = shot.rgb;
    write_png(std::filesystem::path(folder) / name, whole);
  }
  return picture;
}

double share_that_differs(const Picture& a, const Picture& b) {
  std::size_t count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += a.at(x, y) != b.at(x, y);
  return static_cast<double>(count) / (a.width * a.height);
}

class WindowTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!VirtualDisplay::available()) GTEST_SKIP() << "Xvfb or xdotool is not installed";
  }
  ViewOptions paused() const {
    ViewOptions options;
    options.playing = false;
    return options;
  }
};

TEST_F(WindowTest, ShowsThePictureAndEndsWithQ) {
  const VirtualDisplay display(1000, 600);
  WindowProcess window(display, paused());
  const Picture shown = picture_of(display.screenshot(), "window_start.png");
  // The picture stands in the middle of the wider window, pixel for pixel.
  const Picture expected = sky_lit_picture(render(0, {}));
  const int left = (900 - width) / 2;
  int wrong = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) wrong += shown.at(left + x, y) != expected.at(x, y);
  EXPECT_LT(wrong, width * height / 100);
  display.click(450, 100);
  display.key("q");
  EXPECT_EQ(window.next(), "closed");
  EXPECT_EQ(window.wait(), 0);
}

TEST_F(WindowTest, ButtonsSwitchMethodsAndViews) {
  const VirtualDisplay display(1000, 600);
  WindowProcess window(display, paused());
  ASSERT_EQ(window.buttons.size(), 7u);
  const auto press = [&](const std::string& name) {
    display.click(window.buttons.at(name).first, window.buttons.at(name).second);
    return window.next();
  };
  const Picture picture = picture_of(display.screenshot(), "window_picture.png");
  EXPECT_EQ(press("show"), "show visibility");
  const Picture visibility = picture_of(display.screenshot(), "window_visibility.png");
  EXPECT_GT(share_that_differs(picture, visibility), 0.5);

  EXPECT_EQ(press("tree"), "tree ellipsoid-cap");
  EXPECT_EQ(press("tree"), "tree reeves-blau");
  EXPECT_EQ(press("tree"), "tree ambient");
  const Picture ambient = picture_of(display.screenshot(), "window_ambient.png");
  const double changed = share_that_differs(visibility, ambient);
  EXPECT_GT(changed, 0.01);  // the ball that stands for a tree, and nothing else
  EXPECT_LT(changed, 0.15);

  EXPECT_EQ(press("compare"), "compare side-by-side");
  const Picture both = picture_of(display.screenshot(), "window_side_by_side.png");
  EXPECT_GT(share_that_differs(ambient, both), 0.3);
  EXPECT_EQ(press("compare"), "compare difference");
  const Picture difference = picture_of(display.screenshot(), "window_difference.png");
  EXPECT_EQ(difference.at(450, 300), glm::u8vec3(238));  // ground: equal, so white
  EXPECT_EQ(press("occluders"), "occluders none");
  EXPECT_GT(share_that_differs(difference, picture_of(display.screenshot(), "window_difference2.png")), 0.01);
  display.key("Escape");
  EXPECT_EQ(window.next(), "closed");
  EXPECT_EQ(window.wait(), 0);
}

TEST_F(WindowTest, PlaysPausesStepsAndSlides) {
  const VirtualDisplay display(1000, 600);
  ViewOptions options;
  options.end = 40;  // so long that the slider's knob is still at the left when the middle is clicked
  WindowProcess window(display, options);
  const Picture first = picture_of(display.screenshot(), "window_play0.png");
  usleep(700'000);
  EXPECT_GT(share_that_differs(first, picture_of(display.screenshot(), "window_play1.png")), 0.001);
  display.click(450, 100);
  display.key("space");
  EXPECT_EQ(window.next(), "play off");
  const Screenshot still = display.screenshot();
  usleep(300'000);
  EXPECT_EQ(display.screenshot().rgb, still.rgb);
  display.click((window.slider_left + window.slider_right) / 2, window.slider_y);
  const std::string event = window.next();
  ASSERT_THAT(event, testing::StartsWith("time "));
  const double slid_to = std::stod(event.substr(5));
  EXPECT_NEAR(slid_to, 20, 0.5);
  display.key("Right");
  EXPECT_NEAR(std::stod(window.next().substr(5)), slid_to + 1.0 / 24, 0.011);
  EXPECT_GT(
      share_that_differs(picture_of(still, "window_still.png"), picture_of(display.screenshot(), "window_slid.png")),
      0.001);
  display.key("q");
  EXPECT_EQ(window.wait(), 0);
}

TEST_F(WindowTest, AnErrorOfTheRendererEndsItAndComesThrough) {
  const VirtualDisplay display(1000, 600);
  WindowProcess window(display, paused(), [](double time, const Methods& methods) {
    if (methods.grass == "none") throw Error(ErrorKind::invalid_input, "this grass cannot be shown");
    return render(time, methods);
  });
  display.click(window.buttons.at("grass").first, window.buttons.at("grass").second);
  EXPECT_EQ(window.next(), "grass ambient");
  display.click(window.buttons.at("grass").first, window.buttons.at("grass").second);
  EXPECT_EQ(window.next(), "error this grass cannot be shown");
  EXPECT_EQ(window.wait(), static_cast<int>(ErrorKind::invalid_input));
}

TEST(Window, WithoutADisplayIsAnErrorAndNoAbort) {
  const char* before = std::getenv("DISPLAY");
  const std::string kept = before == nullptr ? "" : before;
  for (const char* name : {"", ":98765"}) {
    setenv("DISPLAY", name, 1);
    try {
      show_window({}, render);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::no_device);
      EXPECT_THAT(error.what(), testing::HasSubstr("DISPLAY"));
    }
  }
  setenv("DISPLAY", kept.c_str(), 1);
}

TEST(ViewState, MethodsOfTheSceneAreTheFirstChoiceEvenWhenUnknownToTheList) {
  ViewOptions options;
  options.methods.tree = "shells-cap";
  ViewState state(options);
  EXPECT_EQ(state.methods().tree, "shells-cap");
  EXPECT_EQ(state.methods().ambient, options.methods.ambient);
}

}  // namespace
}  // namespace understory
