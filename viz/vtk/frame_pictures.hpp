// Pictures of one moment from several renderings of it, each with its samples shifted inside the pixels
// (supersampling). Light is averaged before it is exposed, V before it is coloured.
#pragma once
#include <cstdint>
#include <vector>

#include "sim/frame.hpp"
#include "viz/vtk/false_colour.hpp"
#include "viz/vtk/sky_light.hpp"

namespace understory {

class FramePictures {
 public:
  explicit FramePictures(const SkyLight& sky = {}) : sky_(sky) {}
  /// All frames must have the same size.
  void add(const Frame& frame);
  Picture sky_lit() const;
  /// With title and bar. Background only where no sample hit anything; elsewhere the mean over the samples that did.
  Picture visibility(const FalseColour& look = {}) const;

 private:
  SkyLight sky_;
  int count_ = 0;
  LightPicture light_;
  Plane visibility_;
  std::vector<std::uint32_t> hits_;
};

}  // namespace understory
