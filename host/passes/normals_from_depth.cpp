#include "host/passes/normals_from_depth.hpp"

namespace understory {

NormalsFromDepthPass::NormalsFromDepthPass(Device& device)
    : kernel_(device, "normals_from_depth", "make_normals", "normals-from-depth") {}

void NormalsFromDepthPass::run(const FragmentPlanes& planes, const ObscuranceView& view, Buffer<float>& normal_x,
                               Buffer<float>& normal_y, Buffer<float>& normal_z) {
  require_view("normals-from-depth", planes, view, normal_x);
  require_size("normals-from-depth", "normal_y", normal_y.size(), planes.padded_fragments);
  require_size("normals-from-depth", "normal_z", normal_z.size(), planes.padded_fragments);
  kernel_.launch(planes.padded_fragments, 0, planes.depth, planes.validity, obscurance_setting(view, NearField{}),
                 static_cast<std::uint32_t>(planes.padded_fragments), normal_x, normal_y, normal_z);
}

}  // namespace understory
