// Running sums; divided when asked.
#include "viz/vtk/frame_pictures.hpp"

#include <fmt/format.h>

#include "sim/error.hpp"

namespace understory {

void FramePictures::add(const Frame& frame) {
  if (count_ == 0) {
    light_ = {frame.width, frame.height, std::vector<glm::vec3>(frame.pixels(), glm::vec3(0))};
    visibility_.assign(frame.pixels(), 0);
    hits_.assign(frame.pixels(), 0);
  }
  if (frame.width != light_.width || frame.height != light_.height)
    throw Error(ErrorKind::unexpected, fmt::format("samples of {} x {} and {} x {} pixels cannot be averaged",
                                                   light_.width, light_.height, frame.width, frame.height));
  ++count_;
  const LightPicture sample = sky_light_picture(frame, sky_);
  for (std::size_t i = 0; i < sample.light.size(); ++i) {
    light_.light[i] += sample.light[i];
    if ((frame.validity[i] & validity::background) != 0) continue;
    visibility_[i] += frame.visibility[i];
    ++hits_[i];
  }
}

Picture FramePictures::sky_lit() const {
  LightPicture mean = light_;
  for (glm::vec3& light : mean.light) light /= static_cast<float>(count_);
  return develop(mean, sky_.exposure);
}

Picture FramePictures::visibility(const FalseColour& look) const {
  Plane mean(visibility_.size());
  std::vector<std::uint32_t> flags(visibility_.size());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    flags[i] = hits_[i] == 0 ? validity::background : 0;
    if (hits_[i] != 0) mean[i] = visibility_[i] / static_cast<float>(hits_[i]);
  }
  return false_colour(light_.width, light_.height, mean, flags, look);
}

}  // namespace understory
