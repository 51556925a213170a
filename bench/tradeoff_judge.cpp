#include "bench/tradeoff_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/tradeoff_variants.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

constexpr double z95 = 1.96;  // of the normal distribution, two-sided 95 %
constexpr double seconds_of_a_visit = 1;
constexpr int least_rounds = 3;

/// Of (value - truth)^2 less the truth's variance: an unbiased estimate of the squared error at one pixel.
class SquaredErrors {
 public:
  void add(double value, const Truth& truth, std::size_t i) {
    const double error = value - double(truth.visibility[i]);
    const double variance = truth_variance(truth.halfwidth[i], truth.rays[i]), square = error * error - variance;
    ++count_;
    bias_ += error;
    variance_ += variance;
    sum_ += square;
    sum_of_squares_ += square * square;
  }

  RmseInterval interval() const {
    RmseInterval result;
    result.pixels = count_;
    if (count_ == 0) return result;
    const auto count = static_cast<double>(count_);
    const double mean = sum_ / count;
    const double spread = std::sqrt(std::max(0.0, sum_of_squares_ / count - mean * mean) / count);
    result.rmse = std::sqrt(std::max(0.0, mean));
    result.low = std::sqrt(std::max(0.0, mean - z95 * spread));
    result.high = std::sqrt(std::max(0.0, mean + z95 * spread));
    result.bias = bias_ / count;
    result.truth_noise = std::sqrt(variance_ / count);
    return result;
  }

 private:
  std::size_t count_ = 0;
  double bias_ = 0, variance_ = 0, sum_ = 0, sum_of_squares_ = 0;
};

/// Calls visit(view, pixel of the view, pixel of all).
template <class Visit>
void for_each_pixel(const std::vector<JudgedView>& views, const Visit& visit) {
  std::size_t all = 0;
  for (const JudgedView& view : views)
    for (std::size_t i = 0; i < view.pixels.size(); ++i) visit(view, i, all++);
}

void require_sound(const Frame& frame, const JudgedView& view) {
  const auto wrong = std::find_if(frame.visibility.begin(), frame.visibility.end(),
                                  [](float v) { return !(v >= 0 && v <= 1); });  // NaN too
  if (wrong != frame.visibility.end())
    throw Error(ErrorKind::unexpected, fmt::format("V is {} at pixel {} of frame {}, camera {}; allowed: 0 to 1",
                                                   *wrong, wrong - frame.visibility.begin(), view.frame, view.camera));
}

/// The passes of a frame before the resolve.
bool is_drawing(const std::string& pass) {
  return pass.starts_with("pose_") || pass.starts_with("draw_") || pass.starts_with("rasterise") ||
         pass == "clear_visible" || pass == "farthest_depth";
}

}  // namespace

TradeoffJudge::TradeoffJudge(Device& device, World& world, const JudgeOptions& options)
    : device_(device),
      world_(world),
      runner_(device, world),
      image_(world.scene.image),
      camera_(world.scene.camera),
      options_(options) {
  look_at(options.frames);
}

void TradeoffJudge::look_at(const std::vector<int>& frames) {
  auto found = traced_.find(frames);
  if (found == traced_.end()) {
    options_.frames = frames;
    world_.scene.camera = camera_;  // views are laid out from the scene's own
    choose(bare_variant(world_.scene));
    found = traced_.emplace(frames, judged_views(runner_, world_, options_)).first;
  }
  views_ = &found->second;
}

TradeoffJudge::~TradeoffJudge() {
  device_.use_build_options("");
  world_.scene.image = image_;
  world_.scene.camera = camera_;
}

void TradeoffJudge::choose(const Variant& variant) {
  device_.use_build_options(variant.relaxed_maths ? "-cl-fast-relaxed-math" : "");
  shrink_ = variant.shrink;
  world_.scene.image = shrunk(image_, shrink_);
  runner_.choose(variant.methods);
}

void TradeoffJudge::look_from(const JudgedView& view) { world_.scene.camera = view.eye; }

Frame TradeoffJudge::render(const JudgedView& view, double time) {
  look_from(view);
  Frame frame = runner_.render(view.frame, time);
  require_sound(frame, view);
  return frame;
}

JudgedValues TradeoffJudge::values(int rounds, ShadingSamples* samples) {
  JudgedValues values;
  for (const JudgedView& view : *views_) {
    const Frame frame = render(view, view.time);
    if (&view == &views_->front() && render(view, view.time).visibility != frame.visibility)
      throw Error(ErrorKind::unexpected, fmt::format("frame {} rendered twice gives two results", view.frame));
    if (samples && &view == &views_->front()) rounds = rounds_within_reason(frame, rounds);
    if (samples) time_view(frame, rounds, *samples);
    for (const std::uint32_t pixel : view.pixels) {
      const std::size_t i = seen_pixel(pixel, frame);
      values.visibility.push_back(frame.visibility[i]);
      values.classes.push_back(judged_class(frame.owners.at(frame.owner[i]).surface));
      for (const auto& [name, plane] : frame.terms) values.terms[name].push_back(plane[i]);
    }
  }
  return values;
}

std::vector<float> TradeoffJudge::following() {
  std::vector<float> visibility;
  for (const JudgedView& view : *views_) {
    const Frame next = render(view, view.next_time);
    for (const std::uint32_t pixel : view.pixels) visibility.push_back(next.visibility[seen_pixel(pixel, next)]);
  }
  return visibility;
}

int TradeoffJudge::rounds_within_reason(const Frame& frame, int most) const {
  double shading_ms = 0;
  for (const auto& [pass, milliseconds] : frame.pass_ms)
    if (!is_drawing(pass)) shading_ms += milliseconds;
  const double fitting = 1000 * seconds_of_a_visit / std::max(shading_ms * static_cast<double>(views_->size()), 1e-3);
  return std::min(most, static_cast<int>(std::clamp(fitting, double{least_rounds}, 1e6)));
}

void TradeoffJudge::time_view(const Frame& frame, int rounds, ShadingSamples& samples) {
  const auto count = static_cast<std::size_t>(rounds);
  samples.device_ms.resize(count);
  samples.wall_ms.resize(count);
  const double share = 1 / static_cast<double>(views_->size());
  for (const auto& [pass, milliseconds] : frame.pass_ms)
    if (is_drawing(pass)) samples.draw_ms += share * milliseconds;
  for (std::size_t round = 0; round < count; ++round) {
    device_.take_pass_times();
    samples.wall_ms[round] += share * wall_milliseconds(device_, [&] { runner_.shade_again(); });
    for (const auto& [pass, milliseconds] : device_.take_pass_times()) {
      std::vector<double>& all = samples.pass_ms[pass];
      all.resize(count);
      all[round] += share * milliseconds;
      samples.device_ms[round] += share * milliseconds;
    }
  }
  // Waiting for each pass keeps others from overlapping it, which is another thing than the frame: rounds of their own.
  const std::size_t waited = (count + 2) / 3;
  for (std::size_t round = 0; round < waited; ++round)
    for (const auto& [pass, milliseconds] : device_.host_pass_times([&] { runner_.shade_again(); })) {
      std::vector<double>& all = samples.pass_wall_ms[pass];
      all.resize(waited);
      all[round] += share * milliseconds;
    }
}

ShadingSamples TradeoffJudge::time(int rounds) {
  ShadingSamples samples;
  for (const JudgedView& view : *views_) {
    look_from(view);
    const Frame frame = runner_.render(view.frame, view.time);
    if (&view == &views_->front()) rounds = rounds_within_reason(frame, rounds);
    time_view(frame, rounds, samples);
  }
  return samples;
}

Frame TradeoffJudge::frame(const JudgedView& view) {
  Frame frame = render(view, view.time);
  if (shrink_ == 1) return frame;
  Frame large;
  large.width = image_.width;
  large.height = image_.height;
  for (std::uint32_t pixel = 0; pixel < large.pixels(); ++pixel) {
    const std::size_t i = seen_pixel(pixel, frame);
    large.visibility.push_back(frame.visibility[i]);
    large.validity.push_back(frame.validity[i]);
  }
  return large;
}

Frame TradeoffJudge::truth_frame(const JudgedView& view, int rays) {
  choose(bare_variant(world_.scene));
  look_from(view);
  return traced_frame(runner_, world_, view, rays);
}

std::size_t TradeoffJudge::seen_pixel(std::uint32_t pixel, const Frame& frame) const {
  const int x = static_cast<int>(pixel) % image_.width, y = static_cast<int>(pixel) / image_.width;
  const int column = (2 * x + 1) * frame.width / (2 * image_.width);
  const int row = (2 * y + 1) * frame.height / (2 * image_.height);
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(column);
}

RmseInterval TradeoffJudge::error(const std::vector<float>& visibility) const {
  SquaredErrors errors;
  for_each_pixel(*views_, [&](const JudgedView& view, std::size_t i, std::size_t all) {
    errors.add(double(visibility.at(all)), view.truth, i);
  });
  return errors.interval();
}

std::map<std::string, RmseInterval> TradeoffJudge::class_errors(const std::vector<float>& visibility) const {
  std::map<std::string, SquaredErrors> errors;
  for_each_pixel(*views_, [&](const JudgedView& view, std::size_t i, std::size_t all) {
    errors[judged_class_names.at(static_cast<std::size_t>(view.classes[i]))].add(double(visibility.at(all)), view.truth,
                                                                                 i);
  });
  std::map<std::string, RmseInterval> intervals;
  for (const auto& [name, squares] : errors) intervals[name] = squares.interval();
  return intervals;
}

std::vector<ViewError> TradeoffJudge::view_errors(const std::vector<float>& visibility) const {
  std::vector<ViewError> result;
  std::size_t all = 0;
  for (const JudgedView& view : *views_) {
    SquaredErrors errors;
    std::map<std::string, SquaredErrors> classes;
    for (std::size_t i = 0; i < view.pixels.size(); ++i) {
      const auto value = double(visibility.at(all++));
      errors.add(value, view.truth, i);
      classes[judged_class_names.at(static_cast<std::size_t>(view.classes[i]))].add(value, view.truth, i);
    }
    ViewError& one = result.emplace_back();
    one.camera = view.camera;
    one.frame = view.frame;
    one.all = errors.interval();
    for (const auto& [name, squares] : classes) one.classes[name] = squares.interval();
  }
  return result;
}

TemporalError TradeoffJudge::temporal_error(const std::vector<float>& visibility,
                                            const std::vector<float>& following) const {
  TemporalError result;
  double squares = 0, truth_squares = 0;
  std::size_t count = 0;
  for_each_pixel(*views_, [&](const JudgedView& view, std::size_t i, std::size_t all) {
    if (view.following.rays.at(i) == 0) return;  // nothing is seen there any more
    const double per_second = 1 / (view.next_time - view.time);
    const double change = double(following.at(all)) - double(visibility.at(all));
    const double truth_change = double(view.following.visibility[i]) - double(view.truth.visibility[i]);
    const double variance = truth_variance(view.truth.halfwidth[i], view.truth.rays[i]) +
                            truth_variance(view.following.halfwidth[i], view.following.rays[i]);
    const double error = change - truth_change,
                 reach = std::hypot(view.truth.halfwidth[i], view.following.halfwidth[i]);
    squares += (error * error - variance) * per_second * per_second;
    truth_squares += (truth_change * truth_change - variance) * per_second * per_second;
    result.flicker = std::max(result.flicker, std::abs(error) - reach);
    ++count;
  });
  if (count == 0) return result;
  result.rmse_dvdt = std::sqrt(std::max(0.0, squares / static_cast<double>(count)));
  result.truth_dvdt = std::sqrt(std::max(0.0, truth_squares / static_cast<double>(count)));
  return result;
}

}  // namespace understory
