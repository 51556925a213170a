// Runs the plan of a scene on a device, frame by frame. A frame depends on (world, methods, time) and nothing else.
#pragma once
#include <glm/glm.hpp>
#include <memory>

#include "host/frame/plan.hpp"
#include "host/opencl/device.hpp"
#include "sim/frame.hpp"
#include "sim/world.hpp"

namespace understory {

class FrameRunner {
 public:
  /// Uploads what does not change with time. `device` and `world` must outlive the runner.
  /// `most_posed_vertices`: at a time, unless everything is drawn (`detail: brute`).
  FrameRunner(Device& device, const World& world, std::uint32_t most_posed_vertices = 1u << 24);
  ~FrameRunner();

  /// Changes the visibility methods (world.scene.methods at first); programs of new methods are built, of old ones
  /// dropped.
  void choose(const Methods& methods);
  const Plan& plan() const;

  /// Poses, rasterises, resolves and shades one frame at world.scene.image size. `pixel_offset` in [-0.5, 0.5] shifts
  /// the sample inside every pixel (supersampling).
  Frame render(int index, double time, glm::dvec2 pixel_offset = glm::dvec2(0));
  /// The same into a frame that is there, whose memory is used again: new pages for every frame cost a tenth of it.
  void render(Frame& frame, int index, double time, glm::dvec2 pixel_offset = glm::dvec2(0));
  /// Resolves and shades the last rendered frame once more, with the methods chosen since; nothing is read back, so
  /// that the passes can be timed. The methods' guard bands must be that frame's.
  void shade_again();
  /// All triangles at the time of the last rendered frame, whether it drew them or not (`detail`).
  PosedGeometry posed_geometry() const;
  /// How many of them there were, those without area that fill up chunks included.
  std::uint64_t drawn_triangles() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Visibility passes on planes rendered elsewhere: fills `terms`, `visibility` and flags in `validity`.
/// frame.owner indexes world->owners (all 0: each fragment inside a crown's sphere belongs to the nearest crown).
/// `world` null: open-dome factor only. Of the grass methods only grass-transmittance is run: foreign planes lack the
/// blades' lengths that the others need.
void shade_planes(Device& device, const World* world, const Methods& methods, double time, Frame& frame);

}  // namespace understory
