// What each term of a scene's plan is worth: the scene rendered as planned and once without each term, how far the
// pictures differ, and what the difference costs. What `understory explain` prints.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "bench/timing.hpp"
#include "host/frame/plan.hpp"
#include "host/opencl/device.hpp"

namespace understory {

struct ExplainOptions {
  std::string device;                                // as --device
  int frames = 3;                                    // spread over the scene's, at least 1; seen by both cameras
  int rounds = 5;                                    // of timing, each choice in turn
  double visible = 0.01;                             // a pixel that changes by more counts as changed
  double negligible = 0.01;                          // a term that changes a smaller share of pixels could go
  std::function<void(const std::string&)> progress;  // told what comes next; may be empty
};

/// What a choice of methods takes before and while it runs, measured on a device context of its own.
struct Footprint {
  double start_s = 0;                    // uploading, building programs, drawing the first frame
  double buffers_mib = 0, peak_mib = 0;  // of device buffers, after a frame and at most
  std::vector<std::string> programs;     // that were built
  std::size_t kernels = 0;               // that were made of them
  Spread95 frame_ms, shading_ms;         // device time: all passes, and those after the resolve
};

/// A term, found by leaving it out.
struct TermWorth {
  std::string term;          // in words: the near field
  std::string key, method;   // methods.near, obscurance-line
  double changed = 0;        // share of covered pixels that differ by more than ExplainOptions::visible
  double rms = 0, most = 0;  // of the difference, over covered pixels
  Spread95 cost_ms;          // of device time per frame; below 0: the frame is slower without it
  double cost_share = 0;     // of the shading, the passes after the resolve
  bool could_go = false;     // it changes less than ExplainOptions::negligible
  Footprint without;
};

struct Explanation {
  DeviceInfo device;
  Plan plan;
  std::vector<int> frames;  // that were rendered, by each of vantage_cameras()
  double device_s = 0;      // to open the device, once
  std::size_t covered = 0;  // pixels of them that show a surface
  Footprint whole;
  std::vector<TermWorth> terms;  // in the order of the keys of `methods`
};

/// Takes the world because it tries other methods in it. Throws Error(no_device).
Explanation explain_scene(World world, const ExplainOptions& options);

}  // namespace understory
