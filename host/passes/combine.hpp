// kernels/combine.cl: `combine`, the terms of a frame into its visibility.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/lanes.hpp"
#include "host/passes/planes.hpp"

namespace understory {

/// Terms of one frame, each [0, 1] and sized like the planes; null: no such term.
struct VisibilityTerms {
  const Buffer<float>* ambient = nullptr;  // own terms, 1 outside their classes
  const Buffer<float>* tree = nullptr;
  const Buffer<float>* grass = nullptr;
  const Buffer<float>* crowns = nullptr;  // shading by spheres
  const Buffer<float>* occluders = nullptr;
  const Buffer<float>* dome = nullptr;  // open-dome factor; null under `sky: sphere`
  const Buffer<float>* near = nullptr;  // obscurance
  bool near_is_limit = false;           // V is at most `near`; else it is a factor
  std::uint32_t horizon_classes = 0;    // class_bit of each class whose own term holds the horizon: no dome factor
};

class CombinePass {
 public:
  explicit CombinePass(Device& device, int lanes = 0);
  /// V = V_own V_dome V_shade V_near, or the lesser of V_near and the rest (FORMULAS.md); 1 where validity says
  /// background or not finite.
  void run(const FragmentPlanes& planes, const OwnerTables& owners, const VisibilityTerms& terms,
           Buffer<float>& visibility);

 private:
  Lanes lanes_;
  Kernel kernel_;
};

}  // namespace understory
