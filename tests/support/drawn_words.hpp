// The visibility buffer as a drawing kernel leaves it, in either layout (kernels/shared/visibility_buffer.h).
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "host/frame/camera_view.hpp"
#include "host/opencl/kernel.hpp"
#include "host/passes/geometry.hpp"

namespace understory {

/// From the eye at the origin along +y, 33 x 21 pixels: no multiple of any width.
inline CameraView small_level_view() {
  Camera camera;
  camera.position = {0, 0, 0};
  camera.target = {0, 1, 0};
  camera.vertical_fov = 0.9;
  camera.near_plane = 0.1;
  return camera_view(camera, {33, 21}, glm::dvec2(0));
}

/// A kernel of `program` at `lanes` per work-item, and the buffer that it draws into.
using Draw = std::function<void(Kernel& kernel, Buffer<std::uint32_t>& words)>;

/// Two words per pixel after `draw` of every raster pass into a cleared buffer.
inline std::vector<std::uint32_t> drawn_words(Device& device, const char* program, const char* name, int lanes,
                                              bool wide_atomics, const Draw& draw) {
  const CameraView camera = small_level_view();
  const auto count = static_cast<std::uint32_t>(2 * camera.width * camera.height);
  Buffer<std::uint32_t> words(device, count, "visible");
  words.write(std::vector<std::uint32_t>(count, 0xffffffffu));
  for (int pass = 0; pass < (wide_atomics ? 1 : 2); ++pass) {
    Kernel kernel(device, program, name, name,
                  "-DW=" + std::to_string(lanes) +
                      (wide_atomics ? "" : " -DNARROW_ATOMICS -DRASTER_PASS=" + std::to_string(pass)));
    draw(kernel, words);
  }
  return words.read();
}

/// How many pixels see anything.
inline std::size_t drawn_pixels(const std::vector<std::uint32_t>& words, bool wide_atomics) {
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < words.size() / 2; ++i) pixels += words[wide_atomics ? 2 * i : i] != 0xffffffffu;
  return pixels;
}

}  // namespace understory
