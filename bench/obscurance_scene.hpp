// One frame for the obscurance table: its planes on the device, every way of sampling them, and what it costs.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/frame/near_field.hpp"
#include "host/frame/runner.hpp"
#include "host/passes/obscurance_samples.hpp"

namespace understory {

/// A way to sample obscurance, or rays, and what the table calls it.
struct ObscuranceWay {
  enum class Kind { lines, points, areas, rays } kind = Kind::lines;
  int samples = 5;
  double area_spread = 1;  // areas: half-width of the box in standard deviations
  std::string name() const;
};

/// Lines 5 to 16, points 6 to 33, areas.
std::vector<ObscuranceWay> obscurance_ways();

/// `count` points of equal share of the ball's volume, on spirals: what lines, which average over pixels, and points
/// converge to. The span lives as long as the program.
const ObscuranceSampleSet& many_points(int count);

/// Milliseconds of processor time, all threads together.
double processor_ms();

class ObscuranceScene {
 public:
  /// Uploads the frame's planes. The device must outlive the scene.
  ObscuranceScene(Device& device, const Frame& frame);
  ~ObscuranceScene();

  /// Obscurance of the frame's pixels.
  Plane shade(const ObscuranceWay& way, const NearField& options);
  Plane shade_points(const ObscuranceSampleSet& set, const NearField& options);
  Plane blurred(const Plane& plane, const NearField& options);

  /// Least processor time of each way over `repetitions` rounds that take them by turns, over the number of processors
  /// that the device uses: milliseconds a quiet machine needs. The last is the blur of radius 4.
  std::vector<double> cost(const std::vector<ObscuranceWay>& ways, const NearField& options, int repetitions);

  /// Pixels that show something, every `step`-th in both directions.
  std::vector<std::size_t> drawn_pixels(int step) const;
  const Frame& frame() const { return frame_; }

 private:
  std::function<void()> runner(const ObscuranceWay& way, const NearField& options);

  Device& device_;
  Frame frame_;
  ObscuranceView view_;
  FragmentPlanes planes_;
  Buffer<float> visibility_, scratch_;
};

}  // namespace understory
