// The near field of a frame: obscurance from depth and normals, and what its options ask for around it (half
// resolution, normals from depth, blur). Built only where a plan has it.
#pragma once
#include <memory>

#include "host/frame/plan.hpp"
#include "host/passes/obscurance.hpp"
#include "sim/frame.hpp"

namespace understory {

/// Samples that the scene asks for, or the method's own: 5 lines, 12 points, 1 area.
int near_samples(const Methods& methods);

/// Appends the passes of `methods.near`, if any.
void plan_near_field(const Methods& methods, Plan& plan);

class NearFieldPasses {
 public:
  /// For images of `width` x `height` pixels. Throws Error(invalid_input) for a number of samples without a set.
  NearFieldPasses(Device& device, const Methods& methods, std::size_t width, std::size_t height);
  ~NearFieldPasses();
  NearFieldPasses(NearFieldPasses&&) noexcept;
  NearFieldPasses& operator=(NearFieldPasses&&) noexcept;

  /// Obscurance of the planes that `view` saw. Adds validity codes 32 and 64.
  void run(FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& visibility);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The view of our own camera, and of a frame that another program rendered. Throws Error(invalid_input) when the frame
/// tells neither a field of view nor an orthographic height.
ObscuranceView obscurance_view(const CameraView& camera);
ObscuranceView obscurance_view(const Frame& frame);

}  // namespace understory
