#include "host/frame/crown_records.hpp"

namespace understory {

std::vector<CrownRecord> crown_records(const Pose& pose, const std::string& tree_method) {
  std::vector<CrownRecord> records;
  for (const PosedCrown& crown : pose.crowns) {
    CrownRecord record{};
    record.x = crown.sphere_centre.x;
    record.y = crown.sphere_centre.y;
    record.z = crown.sphere_centre.z;
    record.radius = crown.sphere_radius;
    record.centre_x = crown.ellipsoid_centre.x;
    record.centre_y = crown.ellipsoid_centre.y;
    record.centre_z = crown.ellipsoid_centre.z;
    record.alpha_rho = tree_method == "ellipsoid-cap" ? crown.alpha_rho_ellipsoid : crown.alpha_rho;
    for (int axis = 0; axis < 3; ++axis)
      for (int column = 0; column < 3; ++column)
        record.to_unit[4 * axis + column] = crown.ellipsoid_axes[axis][column] / crown.ellipsoid_radii[axis];
    record.volume_scale = crown.ellipsoid_radii.x * crown.ellipsoid_radii.y * crown.ellipsoid_radii.z;
    record.ambient = crown.reeves_blau_ambient;
    record.extinction = crown.reeves_blau_extinction;
    records.push_back(record);
  }
  return records;
}

std::vector<ShadingSphere> shading_spheres(const Pose& pose, bool crowns, bool occluders) {
  std::vector<ShadingSphere> spheres;
  if (crowns)
    for (const PosedCrown& crown : pose.crowns)
      spheres.push_back({crown.sphere_centre.x,
                         crown.sphere_centre.y,
                         crown.sphere_centre.z,
                         crown.sphere_radius,
                         crown.opacity,
                         crown.group,
                         {0, 0}});
  if (occluders)
    for (const PosedSphere& sphere : pose.spheres)
      spheres.push_back({sphere.centre.x, sphere.centre.y, sphere.centre.z, sphere.radius, 1, sphere.group, {0, 0}});
  return spheres;
}

}  // namespace understory
