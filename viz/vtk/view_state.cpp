// Choices and the pictures they lead to.
#include "viz/vtk/view_state.hpp"

#include <algorithm>

#include "sim/error.hpp"
#include "viz/vtk/false_colour.hpp"
#include "viz/vtk/sky_light.hpp"
#include "viz/vtk/text.hpp"

namespace understory {
namespace {

constexpr float difference_limit = 0.5f;

/// The choice starts at `value`, which joins the list when it is not in it.
Choice choice(const std::string& name, char key, std::vector<std::string> values, const std::string& value) {
  auto at = std::find(values.begin(), values.end(), value);
  if (at == values.end()) at = values.insert(values.end(), value);
  const auto place = static_cast<std::size_t>(at - values.begin());
  return {name, key, std::move(values), place};
}

void caption(Picture& picture, const std::string& text, int x) {
  draw_text(picture, text, x + 9, 9, 15, glm::u8vec3(0));
  draw_text(picture, text, x + 8, 8, 15, glm::u8vec3(255));
}

}  // namespace

ViewState::ViewState(const ViewOptions& options) : scene_methods_(options.methods) {
  const std::vector<std::string> shading{"solid-angle", "solid-angle-exact", "solid-angle-cosine", "none"};
  std::vector<std::string> occluders = shading;
  occluders.insert(occluders.end(), {"grid", "grid-cone"});
  choices_ = {
      choice("play", ' ', {"on", "off"}, options.playing ? "on" : "off"),
      choice("show", 'v', {"picture", "visibility"}, "picture"),
      choice("compare", 's', {"nothing", "side-by-side", "difference"}, "nothing"),
      choice("tree", 't', {"sphere-cap", "ellipsoid-cap", "reeves-blau", "ambient", "none"}, scene_methods_.tree),
      choice("grass", 'g', {"grass-transmittance", "grass-height", "ambient", "none"}, scene_methods_.grass),
      choice("crowns", 'c', shading, scene_methods_.crowns),
      choice("occluders", 'o', occluders, scene_methods_.occluders),
  };
}

const std::string& ViewState::value(const std::string& name) const {
  const auto at = std::find_if(choices_.begin(), choices_.end(), [&](const Choice& c) { return c.name == name; });
  if (at == choices_.end()) throw Error(ErrorKind::unexpected, "the window has no choice `" + name + "`");
  return at->value();
}

Methods ViewState::methods() const {
  Methods methods = scene_methods_;
  methods.tree = value("tree");
  methods.grass = value("grass");
  methods.crowns = value("crowns");
  methods.occluders = value("occluders");
  return methods;
}

Picture ViewState::picture_of(const Frame& frame) const {
  if (value("show") == "picture") return sky_lit_picture(frame);
  return colour_plane(frame.width, frame.height, frame.visibility, frame.validity, {});
}

Picture ViewState::picture(double time, const RenderFrame& render) const {
  const Frame chosen = render(time, methods());
  if (value("compare") == "nothing") return picture_of(chosen);
  const Frame scene = render(time, scene_methods_);
  if (value("compare") == "difference") {
    const FalseColour look{ColourMap::difference, -difference_limit, difference_limit, ""};
    Picture picture = colour_plane(chosen.width, chosen.height, difference(chosen.visibility, scene.visibility),
                                   chosen.validity, look);
    caption(picture, "V chosen - V of the scene's own methods, -0.5 (blue) to 0.5 (red)", 0);
    return picture;
  }
  Picture picture = side_by_side(picture_of(chosen), picture_of(scene));
  caption(picture, "chosen", 0);
  caption(picture, "the scene's own", picture.width - chosen.width);
  return picture;
}

}  // namespace understory
