// A VTK render window: the picture as an image slice above, the controls below, a timer that plays.
#include "viz/vtk/window.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkImageProperty.h>
#include <vtkImageSlice.h>
#include <vtkImageSliceMapper.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>

#include "viz/vtk/display_check.hpp"
#include "viz/vtk/picture_image.hpp"
#include "viz/vtk/view_state.hpp"
#include "viz/vtk/window_controls.hpp"

namespace understory {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int smallest_width = 900;  // the second row of buttons
constexpr unsigned long tick_ms = 10;
constexpr std::size_t rate_window = 12;  // frames that the frame rate is averaged over

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class Window {
 public:
  Window(const ViewOptions& options, const RenderFrame& render);
  void run();

 private:
  static void on_vtk_event(vtkObject*, unsigned long event, void* self, void*);
  void handle(unsigned long event);
  void handle_key();
  void press(std::size_t choice);
  void tick();
  void go_to(double time);
  void draw();
  void fit_picture();
  void tell(const std::string& event) const;
  /// Runs an action inside VTK's event loop; what it throws ends the loop and is thrown again after it.
  template <class Action>
  void guarded(Action action);

  const ViewOptions& options_;
  const RenderFrame& render_;
  ViewState state_;
  double time_;
  Clock::time_point last_tick_ = Clock::now();
  std::deque<Clock::time_point> drawn_;
  std::exception_ptr failure_;
  bool ready_ = false;
  int known_width_ = 0, known_height_ = 0;
  vtkNew<vtkImageData> image_;
  vtkNew<vtkRenderer> picture_area_, control_area_;
  vtkNew<vtkRenderWindow> window_;
  vtkNew<vtkRenderWindowInteractor> interactor_;
  vtkNew<vtkCallbackCommand> callback_;
  std::unique_ptr<WindowControls> controls_;
};

Window::Window(const ViewOptions& options, const RenderFrame& render)
    : options_(options), render_(render), state_(options), time_(options.start) {
  const Picture first = state_.picture(time_, render_);
  copy_to_image(first, image_);
  vtkNew<vtkImageSliceMapper> mapper;
  mapper->SetInputData(image_);
  mapper->BorderOn();  // without it half a pixel is missing on every edge
  vtkNew<vtkImageSlice> slice;
  slice->SetMapper(mapper);
  slice->GetProperty()->SetInterpolationTypeToLinear();
  picture_area_->AddViewProp(slice);
  picture_area_->GetActiveCamera()->ParallelProjectionOn();
  picture_area_->SetBackground(0.1, 0.1, 0.1);
  control_area_->SetBackground(0.14, 0.16, 0.15);
  control_area_->InteractiveOff();
  window_->SetMultiSamples(0);
  window_->SetWindowName(options.title.c_str());
  window_->SetSize(std::max(smallest_width, first.width), first.height + WindowControls::height);
  window_->AddRenderer(picture_area_);
  window_->AddRenderer(control_area_);
  interactor_->SetRenderWindow(window_);
  interactor_->SetInteractorStyle(nullptr);  // no camera to turn, and its keys would clash with ours
  controls_ = std::make_unique<WindowControls>(
      interactor_, control_area_, state_.choices(), options, [this](std::size_t i) { guarded([&] { press(i); }); },
      [this](double time) {
        guarded([&] {
          go_to(time);
          tell(fmt::format("time {:.2f}", time_));
        });
      });
  callback_->SetClientData(this);
  callback_->SetCallback(&Window::on_vtk_event);
  for (const unsigned long event :
       {vtkCommand::KeyPressEvent, vtkCommand::TimerEvent, vtkCommand::ConfigureEvent, vtkCommand::ExitEvent})
    interactor_->AddObserver(event, callback_);
}

void Window::run() {
  fit_picture();
  window_->Render();
  interactor_->Initialize();
  controls_->enable();
  fit_picture();
  draw();
  for (const std::string& line : controls_->describe()) tell(line);
  ready_ = true;
  tell("ready");
  interactor_->CreateRepeatingTimer(tick_ms);
  last_tick_ = Clock::now();
  interactor_->Start();
  if (failure_) std::rethrow_exception(failure_);
  tell("closed");
}

void Window::on_vtk_event(vtkObject*, unsigned long event, void* self, void*) {
  auto* window = static_cast<Window*>(self);
  window->guarded([&] { window->handle(event); });
}

template <class Action>
void Window::guarded(Action action) {
  if (failure_) return;
  try {
    action();
  } catch (...) {
    failure_ = std::current_exception();
    interactor_->TerminateApp();
  }
}

void Window::handle(unsigned long event) {
  if (event == vtkCommand::KeyPressEvent) handle_key();
  if (event == vtkCommand::TimerEvent) tick();
  if (event == vtkCommand::ExitEvent) interactor_->TerminateApp();
  if (event == vtkCommand::ConfigureEvent && ready_) {
    const int* size = window_->GetSize();
    if (size[0] == known_width_ && size[1] == known_height_) return;
    fit_picture();
    controls_->place();
    window_->Render();
  }
}

void Window::handle_key() {
  const std::string symbol = interactor_->GetKeySym() == nullptr ? "" : interactor_->GetKeySym();
  if (symbol == "q" || symbol == "Escape") return interactor_->TerminateApp();
  const double step = 1 / options_.frames_per_second;
  if (symbol == "Left" || symbol == "Right") {
    go_to(time_ + (symbol == "Left" ? -step : step));
    return tell(fmt::format("time {:.2f}", time_));
  }
  for (std::size_t i = 0; i < state_.choices().size(); ++i) {
    Choice& choice = state_.choices()[i];
    if (interactor_->GetKeyCode() != choice.key) continue;
    choice.at = (choice.at + 1) % choice.values.size();
    controls_->show_choice(i);
    press(i);
  }
}

void Window::press(std::size_t i) {
  const Choice& choice = state_.choices()[i];
  last_tick_ = Clock::now();
  draw();
  tell(choice.name + " " + choice.value());
}

/// Plays in real time: frames that a slow device cannot make are left out. Times are whole frames, as `run` makes them.
void Window::tick() {
  if (!state_.playing()) return;
  const double elapsed = seconds_since(last_tick_) * options_.frames_per_second;
  if (elapsed < 1) return;
  last_tick_ = Clock::now();
  go_to(time_ + std::floor(elapsed) / options_.frames_per_second);
}

void Window::go_to(double time) {
  const double length = std::max(options_.end - options_.start, 1e-9);
  const double rate = options_.frames_per_second;
  // Half a frame of grace keeps the end itself from wrapping by rounding.
  double within = std::round((time - options_.start) * rate) / rate;
  within -= length * std::floor(within / length + 1e-9);
  time_ = options_.start + std::max(0.0, within);
  draw();
}

void Window::draw() {
  const int width_before = image_->GetDimensions()[0];
  copy_to_image(state_.picture(time_, render_), image_);
  if (image_->GetDimensions()[0] != width_before) fit_picture();
  controls_->show_time(time_);
  drawn_.push_back(Clock::now());
  if (drawn_.size() > rate_window) drawn_.pop_front();
  const double span = std::chrono::duration<double>(drawn_.back() - drawn_.front()).count();
  const double rate = span > 0 ? static_cast<double>(drawn_.size() - 1) / span : 0;
  controls_->show_status(fmt::format("t = {:.2f} s     {:.1f} frames/s", time_, state_.playing() ? rate : 0));
  window_->Render();
}

/// Controls keep their height in pixels; the picture fills the rest without distortion.
void Window::fit_picture() {
  const int* size = window_->GetSize();
  known_width_ = size[0];
  known_height_ = size[1];
  const double foot = std::min(0.9, static_cast<double>(WindowControls::height) / std::max(1, size[1]));
  picture_area_->SetViewport(0, foot, 1, 1);
  control_area_->SetViewport(0, 0, 1, foot);
  const int* pixels = image_->GetDimensions();
  const double across = 0.5 * pixels[0], up = 0.5 * pixels[1];
  const double aspect = size[0] / std::max(1.0, size[1] * (1 - foot));
  vtkCamera* camera = picture_area_->GetActiveCamera();
  camera->SetFocalPoint(across - 0.5, up - 0.5, 0);  // image points lie at whole numbers, pixels around them
  camera->SetPosition(across - 0.5, up - 0.5, 10);
  camera->SetParallelScale(std::max(up, across / aspect));
  picture_area_->ResetCameraClippingRange();
}

void Window::tell(const std::string& event) const {
  if (options_.on_event) options_.on_event(event);
}

}  // namespace

void show_window(const ViewOptions& options, const RenderFrame& render) {
  check_display();
  Window(options, render).run();
}

}  // namespace understory
