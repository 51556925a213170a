// What a variant makes of a scene's judged pixels: its planes there, its errors against their truth, and its time.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bench/judged_views.hpp"
#include "bench/tradeoff.hpp"
#include "host/frame/runner.hpp"

namespace understory {

/// Planes of a variant at the judged pixels of all views, one view after the other.
struct JudgedValues {
  std::vector<float> visibility;
  std::vector<JudgedClass> classes;                 // what the variant's own image shows there
  std::map<std::string, std::vector<float>> terms;  // by method name
};

/// Times of the resolve and all visibility passes after it. One entry a round: mean over the views, ms.
struct ShadingSamples {
  std::vector<double> device_ms, wall_ms;
  std::map<std::string, std::vector<double>> pass_ms;       // device's clock
  std::map<std::string, std::vector<double>> pass_wall_ms;  // host's, each pass waited for: fewer rounds, of their own
  double draw_ms = 0;                                       // of what comes before, device time, mean over the views
};

class TradeoffJudge {
 public:
  /// Renders every view once and traces its pixels. `device` and `world`, which is calibrated, must outlive the judge,
  /// which moves the world's camera and changes its image size.
  TradeoffJudge(Device& device, World& world, const JudgeOptions& options);
  ~TradeoffJudge();
  TradeoffJudge(const TradeoffJudge&) = delete;
  TradeoffJudge& operator=(const TradeoffJudge&) = delete;

  /// Goes on with these frames in the place of the others, and the same ones later without tracing them again. A
  /// variant has to be chosen anew.
  void look_at(const std::vector<int>& frames);

  /// Builds the variant's programs and tables: what is asked for next is of it.
  void choose(const Variant& variant);

  /// Renders all views. Throws Error(unexpected) when V anywhere is not in [0, 1], or differs when the first view is
  /// rendered again. With `samples`: shades each view `rounds` times more, or as often as time() would, and tells the
  /// times.
  JudgedValues values(int rounds = 0, ShadingSamples* samples = nullptr);
  /// V at the judged pixels in the frames after those of the views.
  std::vector<float> following();
  /// Draws every view and shades it `rounds` times; fewer, but no fewer than 3, when all views together would take more
  /// than `seconds_of_a_visit`.
  ShadingSamples time(int rounds);
  /// A whole view as the variant shades it, and as traced truth with so many rays a pixel; both of the scene's size.
  Frame frame(const JudgedView& view);
  Frame truth_frame(const JudgedView& view, int rays);

  const std::vector<JudgedView>& views() const { return *views_; }

  /// Errors of JudgedValues::visibility, over all views, by class, and by view.
  RmseInterval error(const std::vector<float>& visibility) const;
  std::map<std::string, RmseInterval> class_errors(const std::vector<float>& visibility) const;
  std::vector<ViewError> view_errors(const std::vector<float>& visibility) const;
  /// Of JudgedValues::visibility and following().
  TemporalError temporal_error(const std::vector<float>& visibility, const std::vector<float>& following) const;

 private:
  Frame render(const JudgedView& view, double time);
  /// Rounds that keep what is timed on one visit short, at least 3 and at most `most`; `frame` is just rendered.
  int rounds_within_reason(const Frame& frame, int most) const;
  /// Adds a view that has just been rendered as `frame`.
  void time_view(const Frame& frame, int rounds, ShadingSamples& samples);
  void look_from(const JudgedView& view);
  /// The pixel of the variant's image that shows the middle of the scene's `pixel`.
  std::size_t seen_pixel(std::uint32_t pixel, const Frame& frame) const;

  Device& device_;
  World& world_;
  FrameRunner runner_;
  const ImageSize image_;  // the scene's
  const Camera camera_;
  JudgeOptions options_;
  int shrink_ = 1;
  std::map<std::vector<int>, std::vector<JudgedView>> traced_;  // by frames
  const std::vector<JudgedView>* views_ = nullptr;              // of traced_
};

}  // namespace understory
