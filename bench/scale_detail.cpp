#include "bench/scale_detail.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/frame/runner.hpp"
#include "sim/files/scene_file.hpp"
#include "viz/vtk/frame_pictures.hpp"

namespace understory {
namespace {

constexpr int box = 8;             // pixels
constexpr int samples_a_side = 4;  // 16 a pixel
constexpr int dolly_steps = 10;
constexpr double dolly_step = 0.05;  // m

/// V and picture of one moment, each value the mean over box x box pixels.
struct Filtered {
  std::vector<double> visibility;
  std::vector<double> picture;  // three channels a pixel
};

template <typename ValueAt>
void add_filtered(int width, int height, const ValueAt& value_at, std::vector<double>& into) {
  for (int y = 0; y + box <= height; y += box)
    for (int x = 0; x + box <= width; x += box) {
      double sum = 0;
      for (int j = 0; j < box; ++j)
        for (int i = 0; i < box; ++i) sum += value_at(x + i, y + j);
      into.push_back(sum / (box * box));
    }
}

/// `a_side`^2 samples in every pixel, moved by `shift` of their distance.
Filtered filtered_frame(FrameRunner& runner, double time, int a_side, double shift) {
  FramePictures pictures;
  std::vector<double> mean;
  Frame frame;
  for (int j = 0; j < a_side; ++j)
    for (int i = 0; i < a_side; ++i) {
      frame = runner.render(0, time, {(i + 0.5 + shift) / a_side - 0.5, (j + 0.5 + shift) / a_side - 0.5});
      pictures.add(frame);
      mean.resize(frame.pixels());
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += double(frame.visibility[k]) / (a_side * a_side);
    }
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
  };
  Filtered filtered;
  add_filtered(
      frame.width, frame.height, [&](int x, int y) { return mean[index(x, y)]; }, filtered.visibility);
  const Picture picture = pictures.sky_lit();
  for (glm::length_t channel = 0; channel < 3; ++channel)
    add_filtered(
        frame.width, frame.height, [&](int x, int y) { return picture.at(x, y)[channel] / 255.0; }, filtered.picture);
  return filtered;
}

double root_mean_square(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

FilteredErrors errors_of(const Filtered& now, const Filtered& brute) {
  FilteredErrors errors;
  for (std::size_t i = 0; i < now.visibility.size(); ++i)
    errors.bias += (now.visibility[i] - brute.visibility[i]) / static_cast<double>(now.visibility.size());
  errors.rmse = root_mean_square(now.visibility, brute.visibility);
  errors.picture_rmse = root_mean_square(now.picture, brute.picture);
  return errors;
}

/// The camera moves towards its target while the wind stands still, so that only the drawing changes.
void measure_dolly(World& world, FrameRunner& runner, double time, DetailRow& row) {
  const Camera camera = world.scene.camera;
  const glm::dvec3 step = dolly_step * glm::normalize(camera.target - camera.position);
  std::optional<Filtered> before;
  for (int k = 0; k <= dolly_steps; ++k) {
    world.scene.camera.position = camera.position + double(k) * step;
    world.scene.camera.target = camera.target + double(k) * step;
    Filtered now = filtered_frame(runner, time, 1, 0);
    if (before) {
      row.mean_change = std::max(row.mean_change, root_mean_square(now.visibility, before->visibility));
      for (std::size_t i = 0; i < now.visibility.size(); ++i)
        row.largest_change = std::max(row.largest_change, std::abs(now.visibility[i] - before->visibility[i]));
    }
    before = std::move(now);
  }
  world.scene.camera = camera;
}

}  // namespace

std::vector<DetailRow> measure_detail(const std::filesystem::path& file, int frames) {
  World world = build_world(load_scene(file));
  const double time = world.scene.time.at(3);
  std::vector<DetailRow> rows;
  Filtered brute_one, brute_many;
  for (const char* detail : {"brute", "culled", "thinned"}) {
    world.scene.detail = detail;
    Device device;
    FrameRunner runner(device, world);
    Frame frame;
    runner.render(frame, 0, time);
    DetailRow row;
    row.detail = detail;
    std::vector<double> ms;
    for (int k = 1; k <= frames; ++k)
      ms.push_back(wall_milliseconds(device, [&] { runner.render(frame, k, world.scene.time.at(k)); }));
    row.ms = spread_of(ms);
    row.triangles = static_cast<double>(runner.drawn_triangles());
    row.device_mib = static_cast<double>(device.peak_buffer_bytes()) / (1024.0 * 1024.0);
    const Filtered one = filtered_frame(runner, time, 1, 0), many = filtered_frame(runner, time, samples_a_side, 0);
    if (rows.empty()) {
      brute_one = one;
      brute_many = many;
    }
    row.one = errors_of(one, brute_one);
    row.many = errors_of(many, brute_many);
    measure_dolly(world, runner, time, row);
    rows.push_back(row);
    if (rows.size() == 1) {
      DetailRow other;
      other.detail = "brute, other samples";
      other.one = errors_of(filtered_frame(runner, time, 1, 1.0 / 3), brute_one);
      other.many = errors_of(filtered_frame(runner, time, samples_a_side, 1.0 / 3), brute_many);
      rows.push_back(other);
    }
  }
  return rows;
}

}  // namespace understory
