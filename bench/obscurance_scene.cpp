#include "bench/obscurance_scene.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <map>

#include "host/frame/read_back.hpp"
#include "host/passes/obscurance_area.hpp"
#include "host/passes/obscurance_blur.hpp"
#include "host/passes/obscurance_line.hpp"
#include "host/passes/obscurance_point.hpp"
#include "host/passes/screen_rays.hpp"

namespace understory {
namespace {

/// Positions are of no use to obscurance; relative to the eye they keep their digits all the same.
glm::dvec3 eye_of(const Frame& frame) { return glm::dvec3(glm::inverse(frame.world_to_camera)[3]); }

}  // namespace

std::string ObscuranceWay::name() const {
  const std::string number = " " + std::to_string(samples);
  if (kind == Kind::lines) return "lines" + number;
  if (kind == Kind::points) return "points" + number;
  if (kind == Kind::rays) return "rays" + number;
  return "areas" + number + (area_spread == 1 ? ", sigma" : ", sqrt(3) sigma");
}

std::vector<ObscuranceWay> obscurance_ways() {
  using Kind = ObscuranceWay::Kind;
  std::vector<ObscuranceWay> ways;
  for (const int count : {5, 7, 9, 12, 13, 15, 16}) ways.push_back({Kind::lines, count, 1});
  for (const int count : {6, 12, 33}) ways.push_back({Kind::points, count, 1});
  for (const int count : {1, 5})
    for (const double spread : {1.0, std::sqrt(3.0)}) ways.push_back({Kind::areas, count, spread});
  return ways;
}

const ObscuranceSampleSet& many_points(int count) {
  struct Many {
    std::vector<ObscuranceSample> samples;
    ObscuranceSampleSet set;
  };
  static std::map<int, Many> all;
  Many& many = all[count];
  if (!many.samples.empty()) return many.set;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    // Radii by the square root of two's multiples, so that neighbours in direction are none in radius.
    const double shell = std::fmod((i + 0.5) * std::sqrt(2.0), 1.0), r = std::cbrt(shell);
    const double z = 1 - 2 * (i + 0.5) / count, turn = 2 * glm::pi<double>() * 0.6180339887498949 * i;
    const double flat = r * std::sqrt(1 - z * z), weight = 1 - r * r;
    many.samples.push_back({static_cast<float>(flat * std::cos(turn)), static_cast<float>(flat * std::sin(turn)),
                            static_cast<float>(r * z), 1.0f / static_cast<float>(count), static_cast<float>(weight)});
    sum += weight;
  }
  for (ObscuranceSample& sample : many.samples) sample.quadratic_share /= static_cast<float>(sum);
  many.set = {many.samples, false, 0, 0, 0};
  return many.set;
}

double processor_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

ObscuranceScene::ObscuranceScene(Device& device, const Frame& frame)
    : device_(device),
      frame_(frame),
      view_(obscurance_view(frame)),
      planes_(upload_planes(device, frame, eye_of(frame))),
      visibility_(device, planes_.padded_fragments, "obscurance"),
      scratch_(device, planes_.padded_fragments, "scratch") {}

ObscuranceScene::~ObscuranceScene() = default;

std::function<void()> ObscuranceScene::runner(const ObscuranceWay& way, const NearField& options) {
  if (way.kind == ObscuranceWay::Kind::lines)
    return [this, pass = std::make_shared<ObscuranceLinePass>(device_, options, line_samples(way.samples))] {
      pass->run(planes_, view_, visibility_);
    };
  if (way.kind == ObscuranceWay::Kind::points)
    return [this, pass = std::make_shared<ObscurancePointPass>(device_, options, point_samples(way.samples))] {
      pass->run(planes_, view_, visibility_);
    };
  if (way.kind == ObscuranceWay::Kind::rays)
    return [this, pass = std::make_shared<ScreenRaysPass>(device_, options, way.samples)] {
      pass->run(planes_, view_, visibility_);
    };
  const auto gather = std::make_shared<DepthMomentsPass>(device_);
  const auto moments = std::make_shared<DepthMoments>(gather->allocate(device_, view_));
  NearField constant = options;  // areas have no other falloff
  constant.falloff = "constant";
  const auto pass = std::make_shared<ObscuranceAreaPass>(device_, constant, line_samples(way.samples), way.area_spread);
  return [this, gather, moments, pass] {
    gather->run(planes_, view_, *moments);
    pass->run(planes_, view_, *moments, visibility_);
  };
}

Plane ObscuranceScene::shade(const ObscuranceWay& way, const NearField& options) {
  runner(way, options)();
  Plane values(planes_.fragments);
  visibility_.read(std::span<float>(values));
  return values;
}

Plane ObscuranceScene::shade_points(const ObscuranceSampleSet& set, const NearField& options) {
  ObscurancePointPass(device_, options, set).run(planes_, view_, visibility_);
  Plane values(planes_.fragments);
  visibility_.read(std::span<float>(values));
  return values;
}

Plane ObscuranceScene::blurred(const Plane& plane, const NearField& options) {
  Plane padded = plane;
  padded.resize(planes_.padded_fragments, 1.0f);
  visibility_.write(std::span<const float>(padded));
  ObscuranceBlurPass(device_).run(planes_, view_, 4, 0.2 * options.radius, visibility_, scratch_);
  Plane values(planes_.fragments);
  visibility_.read(std::span<float>(values));
  return values;
}

std::vector<double> ObscuranceScene::cost(const std::vector<ObscuranceWay>& ways, const NearField& options,
                                          int repetitions) {
  std::vector<std::function<void()>> actions;
  for (const ObscuranceWay& way : ways) actions.push_back(runner(way, options));
  actions.push_back([this, &options, blur = std::make_shared<ObscuranceBlurPass>(device_)] {
    blur->run(planes_, view_, 4, 0.2 * options.radius, visibility_, scratch_);
  });
  std::vector<double> least(actions.size(), std::numeric_limits<double>::max());
  for (int round = 0; round <= repetitions; ++round)
    for (std::size_t i = 0; i < actions.size(); ++i) {
      const double start = processor_ms();
      actions[i]();
      device_.finish();
      if (round > 0) least[i] = std::min(least[i], (processor_ms() - start) / device_.info().compute_units);
    }
  device_.take_pass_times();
  return least;
}

std::vector<std::size_t> ObscuranceScene::drawn_pixels(int step) const {
  std::vector<std::size_t> pixels;
  for (int y = step / 2; y < frame_.height; y += step)
    for (int x = step / 2; x < frame_.width; x += step) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.width) + static_cast<std::size_t>(x);
      if ((frame_.validity[i] & validity::background) == 0) pixels.push_back(i);
    }
  return pixels;
}

}  // namespace understory
