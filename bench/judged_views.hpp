// The pixels by which variants of a scene are judged: some of several frames seen by several cameras, with their truth.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "host/frame/runner.hpp"
#include "host/trace/truth.hpp"

namespace understory {

enum class JudgedClass : std::uint8_t { tree, grass, ground, occluder, background };
inline constexpr std::array judged_class_names = {"tree", "grass", "ground", "occluder"};  // but of the background

JudgedClass judged_class(SurfaceClass surface);

struct JudgeOptions {
  std::vector<int> frames;    // of the scene; each is judged by every camera of vantage_cameras()
  std::size_t pixels = 2000;  // per view: one at random in each cell of a grid; images that have no more, whole
  int rays = 512;             // of the truth, per pixel
  bool following = false;     // the frame after each as well, for changes in time
};

/// One frame seen by one camera, and the pixels that are judged in it: covered ones only.
struct JudgedView {
  int camera = 0, frame = 0;
  double time = 0, next_time = 0;  // s, of the frame and of the one after it
  Camera eye;
  std::vector<std::uint32_t> pixels;  // ascending, of the scene's own image size
  std::vector<JudgedClass> classes;   // of each
  Truth truth;
  /// The same pixels in the frame after; where nothing is seen there: V 1, half-width 0, no rays. Empty unless judged.
  Truth following;
};

/// Renders the views at the runner's image size and traces them; truth is kept between runs (bake_cache.hpp), found by
/// what is traced. `world` is the runner's; its camera is moved.
std::vector<JudgedView> judged_views(FrameRunner& runner, World& world, const JudgeOptions& options);

/// The whole frame of a view with its truth, which is kept likewise.
Frame traced_frame(FrameRunner& runner, World& world, const JudgedView& view, int rays);

/// `count` frames, one in the middle of each of as many equal parts of the scene's; fewer when it has no more.
std::vector<int> spread_frames(int frames, int count);

}  // namespace understory
