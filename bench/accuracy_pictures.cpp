#include "bench/accuracy_pictures.hpp"

#include <algorithm>

#include "viz/vtk/false_colour.hpp"
#include "viz/vtk/png.hpp"

namespace understory {

void write_accuracy_picture(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                            const Frame& truth, const Frame& method) {
  const auto colour = [&](const Plane& plane, const FalseColour& look) {
    return false_colour(truth.width, truth.height, plane, truth.validity, look);
  };
  const Picture left = colour(truth.visibility, {.title = "truth"});
  const Picture middle = colour(method.visibility, {.title = title});
  const Picture right =
      colour(difference(method.visibility, truth.visibility), {ColourMap::difference, -0.5f, 0.5f, "difference"});
  std::string file = name;
  std::replace_if(
      file.begin(), file.end(), [](char c) { return c == ' ' || c == '/' || c == ','; }, '_');
  std::filesystem::create_directories(folder);
  write_png(folder / (file + ".png"), side_by_side(side_by_side(left, middle), right));
}

}  // namespace understory
