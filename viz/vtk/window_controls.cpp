// Widgets are placed in display coordinates: pixels from the lower left corner.
#include "viz/vtk/window_controls.hpp"

#include <fmt/format.h>
#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkProperty2D.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSliderRepresentation2D.h>
#include <vtkTextProperty.h>
#include <vtkTexturedButtonRepresentation2D.h>

#include <algorithm>
#include <utility>

#include "viz/vtk/picture_image.hpp"
#include "viz/vtk/text.hpp"

namespace understory {
namespace {

constexpr int margin = 8, button_height = 26, row_height = 32, slider_y = 20, slider_inset = 24, font_size = 14;
constexpr std::size_t first_of_second_row = 3;
constexpr glm::u8vec3 button_colour(72, 82, 76), label_colour(240);

int lower_edge_of_row(std::size_t choice) {
  return WindowControls::height - row_height * (choice < first_of_second_row ? 1 : 2);
}

/// As wide as its longest label.
int width_of(const Choice& choice) {
  int width = 0;
  Choice each = choice;
  for (each.at = 0; each.at < each.values.size(); ++each.at)
    width = std::max(width, text_size(each.label(), font_size).x);
  return width + 2 * margin;
}

vtkTexturedButtonRepresentation2D* look_of(vtkButtonWidget* button) {
  return static_cast<vtkTexturedButtonRepresentation2D*>(button->GetRepresentation());
}

vtkSliderRepresentation2D* look_of(vtkSliderWidget* slider) {
  return static_cast<vtkSliderRepresentation2D*>(slider->GetRepresentation());
}

vtkSmartPointer<vtkTexturedButtonRepresentation2D> faces_of(Choice choice, int width) {
  auto look = vtkSmartPointer<vtkTexturedButtonRepresentation2D>::New();
  look->SetPlaceFactor(1);  // fill the bounds
  look->SetNumberOfStates(static_cast<int>(choice.values.size()));
  const std::size_t now = choice.at;
  for (choice.at = 0; choice.at < choice.values.size(); ++choice.at) {
    Picture face(width, button_height, button_colour);
    draw_text(face, choice.label(), margin, 5, font_size, label_colour);
    vtkNew<vtkImageData> image;
    copy_to_image(face, image);
    look->SetButtonTexture(static_cast<int>(choice.at), image);
  }
  look->SetState(static_cast<int>(now));
  return look;
}

vtkSmartPointer<vtkSliderRepresentation2D> time_slider(double start, double end) {
  auto look = vtkSmartPointer<vtkSliderRepresentation2D>::New();
  look->SetMinimumValue(start);
  look->SetMaximumValue(end);
  look->SetValue(start);
  look->ShowSliderLabelOff();
  look->GetPoint1Coordinate()->SetCoordinateSystemToDisplay();
  look->GetPoint2Coordinate()->SetCoordinateSystemToDisplay();
  // Lengths are shares of the area's width, widths of its height.
  look->SetTubeWidth(0.05);
  look->SetSliderLength(0.012);
  look->SetSliderWidth(0.18);
  look->SetEndCapLength(0.003);
  look->SetEndCapWidth(0.12);
  look->GetTubeProperty()->SetColor(0.45, 0.5, 0.47);
  look->GetCapProperty()->SetColor(0.45, 0.5, 0.47);
  look->GetSliderProperty()->SetColor(0.95, 0.95, 0.95);
  look->GetSelectedProperty()->SetColor(0.6, 0.85, 0.5);
  return look;
}

}  // namespace

/// Runs a function on a widget's event.
class WindowControls::Listener : public vtkCommand {
 public:
  static Listener* New() { return new Listener; }
  void Execute(vtkObject*, unsigned long, void*) override { action(); }
  std::function<void()> action;
};

WindowControls::WindowControls(vtkRenderWindowInteractor* interactor, vtkRenderer* renderer,
                               std::vector<Choice>& choices, const ViewOptions& options,
                               std::function<void(std::size_t)> on_press, std::function<void(double)> on_slide)
    : interactor_(interactor), choices_(choices) {
  const auto listen = [&](vtkObject* widget, unsigned long event, std::function<void()> action) {
    listeners_.push_back(vtkSmartPointer<Listener>::New());
    listeners_.back()->action = std::move(action);
    widget->AddObserver(event, listeners_.back());
  };
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    button_widths_.push_back(width_of(choices_[i]));
    auto button = vtkSmartPointer<vtkButtonWidget>::New();
    button->SetInteractor(interactor);
    button->SetCurrentRenderer(renderer);
    button->SetRepresentation(faces_of(choices_[i], button_widths_.back()));
    listen(button, vtkCommand::StateChangedEvent, [this, i, button = button.Get(), on_press] {
      choices_[i].at = static_cast<std::size_t>(look_of(button)->GetState());
      on_press(i);
    });
    buttons_.push_back(button);
  }
  button_centres_.resize(buttons_.size());
  slider_->SetInteractor(interactor);
  slider_->SetCurrentRenderer(renderer);
  slider_->SetRepresentation(time_slider(options.start, options.end));
  slider_->SetAnimationModeToJump();
  listen(slider_, vtkCommand::InteractionEvent, [this, on_slide] { on_slide(look_of(slider_)->GetValue()); });
  status_->GetTextProperty()->SetFontSize(font_size);
  status_->GetTextProperty()->SetColor(0.9, 0.9, 0.9);
  renderer->AddActor2D(status_);
}

WindowControls::~WindowControls() = default;

void WindowControls::enable() {
  place();
  for (auto& button : buttons_) button->On();
  slider_->On();
}

void WindowControls::place() {
  int x = margin;
  for (std::size_t i = 0; i < buttons_.size(); ++i) {
    if (i == first_of_second_row) {
      status_->SetDisplayPosition(x + margin, lower_edge_of_row(0) + 6);
      x = margin;
    }
    const int y = lower_edge_of_row(i), right = x + button_widths_[i], top = y + button_height;
    double bounds[6] = {double(x), double(right), double(y), double(top), 0, 0};
    look_of(buttons_[i])->PlaceWidget(bounds);
    button_centres_[i] = {(x + right) / 2, (y + top) / 2};
    x = right + margin;
  }
  const int width = interactor_->GetRenderWindow()->GetSize()[0];
  look_of(slider_)->GetPoint1Coordinate()->SetValue(slider_inset, slider_y);
  look_of(slider_)->GetPoint2Coordinate()->SetValue(width - slider_inset, slider_y);
}

void WindowControls::show_choice(std::size_t index) {
  look_of(buttons_[index])->SetState(static_cast<int>(choices_[index].at));
}

void WindowControls::show_time(double time) { look_of(slider_)->SetValue(time); }

void WindowControls::show_status(const std::string& text) { status_->SetInput(text.c_str()); }

std::vector<std::string> WindowControls::describe() const {
  const int* size = interactor_->GetRenderWindow()->GetSize();
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < buttons_.size(); ++i)
    lines.push_back(
        fmt::format("button {} {} {}", choices_[i].name, button_centres_[i].x, size[1] - 1 - button_centres_[i].y));
  lines.push_back(fmt::format("slider {} {} {}", slider_inset, size[0] - slider_inset, size[1] - 1 - slider_y));
  return lines;
}

}  // namespace understory
