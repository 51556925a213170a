// Covered pixels are gathered, traced in portions so that progress can be told, and put back.
#include "host/trace/frame_truth.hpp"

#include <algorithm>

namespace understory {
namespace {

constexpr std::size_t portion = 8192;  // points a call

glm::vec3 eye_of(const Frame& frame) { return glm::vec3(glm::inverse(frame.world_to_camera)[3]); }

}  // namespace

Tracer tracer_of(const PosedGeometry& geometry) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  return Tracer(std::span(reinterpret_cast<const glm::vec3*>(geometry.positions.data()), geometry.positions.size() / 3),
                geometry.triangles);
}

void trace_frame(const Tracer& tracer, TruthOptions options, Frame& frame,
                 const std::function<void(double share)>& progress) {
  std::vector<std::size_t> pixels;
  std::vector<glm::vec3> positions, normals;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if ((frame.validity[i] & validity::background) != 0) continue;
    pixels.push_back(i);
    positions.emplace_back(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
    normals.emplace_back(frame.normal[0][i], frame.normal[1][i], frame.normal[2][i]);
  }
  options.eye = eye_of(frame);
  frame.terms.clear();
  frame.visibility.assign(frame.pixels(), 1);
  frame.halfwidth.assign(frame.pixels(), 0);
  frame.rays.assign(frame.pixels(), 0);
  for (std::size_t first = 0; first < pixels.size(); first += portion) {
    const std::size_t count = std::min(portion, pixels.size() - first);
    options.first_point = first;
    const Truth truth = trace_truth(tracer, std::span(positions).subspan(first, count),
                                    std::span(normals).subspan(first, count), options);
    for (std::size_t i = 0; i < count; ++i) {
      frame.visibility[pixels[first + i]] = truth.visibility[i];
      frame.halfwidth[pixels[first + i]] = truth.halfwidth[i];
      frame.rays[pixels[first + i]] = truth.rays[i];
    }
    if (progress) progress(static_cast<double>(first + count) / static_cast<double>(pixels.size()));
  }
}

}  // namespace understory
