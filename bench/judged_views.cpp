#include "bench/judged_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <string>

#include "host/trace/bake_cache.hpp"
#include "host/trace/frame_truth.hpp"
#include "sim/random.hpp"
#include "sim/vantage.hpp"

namespace understory {
namespace {

/// Raised whenever the same geometry and points would get another truth.
constexpr std::uint32_t truth_version = 1;

std::string bytes_of(const Truth& truth) {
  const std::size_t count = truth.visibility.size();
  std::string bytes(reinterpret_cast<const char*>(truth.visibility.data()), count * sizeof(float));
  bytes.append(reinterpret_cast<const char*>(truth.halfwidth.data()), count * sizeof(float));
  return bytes.append(reinterpret_cast<const char*>(truth.rays.data()), count * sizeof(std::uint32_t));
}

std::optional<Truth> truth_of(const std::string& bytes, std::size_t count) {
  if (bytes.size() != count * 3 * sizeof(float)) return std::nullopt;
  Truth truth{std::vector<float>(count), std::vector<float>(count), std::vector<std::uint32_t>(count)};
  const char* from = bytes.data();
  for (void* to : {static_cast<void*>(truth.visibility.data()), static_cast<void*>(truth.halfwidth.data()),
                   static_cast<void*>(truth.rays.data())}) {
    std::memcpy(to, from, count * sizeof(float));
    from += count * sizeof(float);
  }
  return truth;
}

/// Traces points of one moment. The triangles are arranged for tracing only when something has to be traced.
class MomentTracer {
 public:
  explicit MomentTracer(PosedGeometry geometry) : geometry_(std::move(geometry)) {
    hash_.add(truth_version);
    hash_.add(geometry_.positions);
    hash_.add(geometry_.triangles);
  }

  Truth truth_at(const std::vector<glm::vec3>& points, const std::vector<glm::vec3>& normals,
                 const TruthOptions& options) {
    ContentHash hash = hash_;
    hash.add(points);
    hash.add(normals);
    hash.add(options.rays);
    hash.add(static_cast<int>(options.sky));
    hash.add(std::span<const float>(&options.eye.x, 3));
    if (const std::optional<std::string> bytes = load_bake("truth", hash))
      if (std::optional<Truth> truth = truth_of(*bytes, points.size())) return std::move(*truth);
    if (!tracer_) tracer_.emplace(tracer_of(geometry_));
    Truth truth = trace_truth(*tracer_, points, normals, options);
    store_bake("truth", hash, bytes_of(truth));
    return truth;
  }

 private:
  PosedGeometry geometry_;
  ContentHash hash_;
  std::optional<Tracer> tracer_;
};

/// One pixel at random in each cell of a grid of about `wanted` square cells; all when there are no more.
std::vector<std::uint32_t> spread_pixels(const ImageSize& image, std::size_t wanted, std::uint64_t view) {
  const double width = image.width, height = image.height;
  const double cell = std::max(1.0, std::sqrt(width * height / static_cast<double>(std::max<std::size_t>(wanted, 1))));
  const int columns = std::max(1, static_cast<int>(width / cell)), rows = std::max(1, static_cast<int>(height / cell));
  std::vector<std::uint32_t> pixels;
  const auto edge = [](int part, int parts, int size) {
    return static_cast<std::uint32_t>(std::int64_t{part} * size / parts);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t left = edge(column, columns, image.width), right = edge(column + 1, columns, image.width);
      const std::uint32_t top = edge(row, rows, image.height), bottom = edge(row + 1, rows, image.height);
      Random random(view, stream_of("judged pixels"), pixels.size());
      const auto x = left + static_cast<std::uint32_t>(random.below(right - left));
      const auto y = top + static_cast<std::uint32_t>(random.below(bottom - top));
      pixels.push_back(y * static_cast<std::uint32_t>(image.width) + x);
    }
  std::sort(pixels.begin(), pixels.end());
  return pixels;
}

bool is_covered(const Frame& frame, std::size_t pixel) {
  return (frame.validity[pixel] & (validity::background | validity::not_finite)) == 0;
}

/// Truth at `pixels` of the frame; V 1 where nothing is seen.
Truth truth_at(MomentTracer& tracer, const Frame& frame, const std::vector<std::uint32_t>& pixels,
               TruthOptions options) {
  std::vector<glm::vec3> points, normals;
  for (const std::uint32_t i : pixels) {
    if (!is_covered(frame, i)) continue;
    points.emplace_back(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
    normals.emplace_back(frame.normal[0][i], frame.normal[1][i], frame.normal[2][i]);
  }
  options.eye = glm::vec3(glm::inverse(frame.world_to_camera)[3]);
  const Truth traced = tracer.truth_at(points, normals, options);
  Truth truth;
  std::size_t next = 0;
  for (const std::uint32_t i : pixels) {
    const bool covered = is_covered(frame, i);
    truth.visibility.push_back(covered ? traced.visibility[next] : 1);
    truth.halfwidth.push_back(covered ? traced.halfwidth[next] : 0);
    truth.rays.push_back(covered ? traced.rays[next] : 0);
    next += covered;
  }
  return truth;
}

/// The pixels of a view, and its truth in that frame.
void look_at_frame(const Frame& frame, const JudgeOptions& options, JudgedView& view) {
  const auto key = static_cast<std::uint64_t>(view.frame) * 2 + static_cast<std::uint64_t>(view.camera);
  for (const std::uint32_t i : spread_pixels({frame.width, frame.height}, options.pixels, key)) {
    const JudgedClass seen = judged_class(frame.owners.at(frame.owner[i]).surface);
    if (!is_covered(frame, i) || seen == JudgedClass::background) continue;
    view.pixels.push_back(i);
    view.classes.push_back(seen);
  }
}

}  // namespace

JudgedClass judged_class(SurfaceClass surface) {
  switch (surface) {
    case SurfaceClass::leaf:
    case SurfaceClass::wood:
      return JudgedClass::tree;
    case SurfaceClass::blade:
      return JudgedClass::grass;
    case SurfaceClass::terrain:
      return JudgedClass::ground;
    case SurfaceClass::occluder:
      return JudgedClass::occluder;
    case SurfaceClass::background:
      break;
  }
  return JudgedClass::background;
}

std::vector<int> spread_frames(int frames, int count) {
  count = std::min(frames, count);
  std::vector<int> spread;
  for (int i = 0; i < count; ++i)
    spread.push_back(static_cast<int>((2 * std::int64_t{i} + 1) * frames / (2 * std::int64_t{count})));
  return spread;
}

std::vector<JudgedView> judged_views(FrameRunner& runner, World& world, const JudgeOptions& options) {
  const Camera own = world.scene.camera;
  const std::vector<Camera> cameras = vantage_cameras(world);
  TruthOptions truth_options;
  truth_options.rays = options.rays;
  truth_options.sky = world.scene.sky;
  std::vector<JudgedView> views;
  for (const int frame_index : options.frames) {
    std::optional<MomentTracer> now, next;
    for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
      JudgedView view;
      view.camera = static_cast<int>(camera);
      view.frame = frame_index;
      view.time = world.scene.time.at(frame_index);
      view.next_time = world.scene.time.at(frame_index + 1);
      view.eye = world.scene.camera = cameras[camera];
      const Frame frame = runner.render(frame_index, view.time);
      if (!now) now.emplace(runner.posed_geometry());
      look_at_frame(frame, options, view);
      view.truth = truth_at(*now, frame, view.pixels, truth_options);
      if (options.following) {
        const Frame following = runner.render(frame_index + 1, view.next_time);
        if (!next) next.emplace(runner.posed_geometry());
        view.following = truth_at(*next, following, view.pixels, truth_options);
      }
      views.push_back(std::move(view));
    }
  }
  world.scene.camera = own;
  return views;
}

Frame traced_frame(FrameRunner& runner, World& world, const JudgedView& view, int rays) {
  const Camera own = world.scene.camera;
  world.scene.camera = view.eye;
  Frame frame = runner.render(view.frame, view.time);
  world.scene.camera = own;
  std::vector<std::uint32_t> pixels(frame.pixels());
  std::iota(pixels.begin(), pixels.end(), 0u);
  TruthOptions options;
  options.rays = rays;
  options.sky = world.scene.sky;
  MomentTracer tracer(runner.posed_geometry());
  Truth truth = truth_at(tracer, frame, pixels, options);
  frame.visibility = std::move(truth.visibility);
  frame.halfwidth = std::move(truth.halfwidth);
  frame.rays = std::move(truth.rays);
  return frame;
}

}  // namespace understory
