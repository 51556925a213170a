// kernels/normals_from_depth.cl: normals for images that have none.
#pragma once
#include "host/opencl/kernel.hpp"
#include "host/passes/obscurance.hpp"

namespace understory {

class NormalsFromDepthPass {
 public:
  explicit NormalsFromDepthPass(Device& device);
  /// Unit, facing the viewer, world axes; 0 on the background. All sized like the planes.
  void run(const FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& normal_x, Buffer<float>& normal_y,
           Buffer<float>& normal_z);

 private:
  Kernel kernel_;
};

}  // namespace understory
