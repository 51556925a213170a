// Buttons and the time slider at the window's foot, as VTK widgets. For viz/vtk/window.cpp only.
#pragma once
#include <vtkButtonWidget.h>
#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSliderWidget.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include <functional>
#include <string>
#include <vector>

#include "viz/vtk/view_state.hpp"

namespace understory {

class WindowControls {
 public:
  static constexpr int height = 112;  // pixels: two rows of buttons, the slider, a line of text

  /// `on_press` gets the index of the choice whose button was pressed, with its new value already set in `choices`;
  /// `on_slide` the time in seconds.
  WindowControls(vtkRenderWindowInteractor* interactor, vtkRenderer* renderer, std::vector<Choice>& choices,
                 const ViewOptions& options, std::function<void(std::size_t)> on_press,
                 std::function<void(double)> on_slide);
  ~WindowControls();

  /// Only after the window has been drawn once: the widgets need its size.
  void enable();
  /// After the window's width has changed.
  void place();
  void show_choice(std::size_t index);
  void show_time(double time);
  void show_status(const std::string& text);
  /// Lines "button NAME X Y" and "slider LEFT RIGHT Y", see ViewOptions::on_event.
  std::vector<std::string> describe() const;

 private:
  class Listener;
  vtkRenderWindowInteractor* interactor_;
  std::vector<Choice>& choices_;
  std::vector<vtkSmartPointer<vtkButtonWidget>> buttons_;
  std::vector<int> button_widths_;
  std::vector<glm::ivec2> button_centres_;  // from the lower left corner
  vtkNew<vtkSliderWidget> slider_;
  vtkNew<vtkTextActor> status_;
  std::vector<vtkSmartPointer<Listener>> listeners_;
};

}  // namespace understory
