// What the window shows at a moment: the choices made, and the picture that follows from them. No VTK here.
#pragma once
#include <string>
#include <vector>

#include "viz/vtk/picture.hpp"
#include "viz/vtk/window.hpp"

namespace understory {

/// One thing to choose; pressing its button or key takes the next value.
struct Choice {
  std::string name;
  char key = 0;
  std::vector<std::string> values;
  std::size_t at = 0;
  const std::string& value() const { return values[at]; }
  std::string label() const { return name + ": " + value(); }
};

class ViewState {
 public:
  explicit ViewState(const ViewOptions& options);

  std::vector<Choice>& choices() { return choices_; }
  const std::string& value(const std::string& name) const;
  bool playing() const { return value("play") == "on"; }
  Methods methods() const;
  /// The picture at `time`: one rendering, or two when comparing.
  Picture picture(double time, const RenderFrame& render) const;

 private:
  Picture picture_of(const Frame& frame) const;
  Methods scene_methods_;
  std::vector<Choice> choices_;
};

}  // namespace understory
