// Numbers as colours that can be read back: perceptual maps, a bar with labels, a title.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "sim/frame.hpp"
#include "viz/vtk/picture.hpp"

namespace understory {

enum class ColourMap {
  viridis,     // dark blue to yellow, even in lightness (S. van der Walt, N. Smith 2015)
  difference,  // blue, white at the middle, red (K. Moreland 2009, "cool to warm")
};

struct FalseColour {
  ColourMap map = ColourMap::viridis;
  float low = 0, high = 1;
  std::string title = "ambient visibility V";
};

/// Clamped to [low, high]; NaN is magenta.
glm::u8vec3 map_colour(ColourMap map, float value, float low, float high);

/// `plane` without bar and title. Pixels whose `validity` has the background bit are grey; `validity` may be empty.
Picture colour_plane(int width, int height, const Plane& plane, const std::vector<std::uint32_t>& validity,
                     const FalseColour& look);

/// The same in a frame: title above, bar with labels to the right.
Picture false_colour(int width, int height, const Plane& plane, const std::vector<std::uint32_t>& validity,
                     const FalseColour& look = {});

/// a - b; sizes must be equal.
Plane difference(const Plane& a, const Plane& b);

}  // namespace understory
