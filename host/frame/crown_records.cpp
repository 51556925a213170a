#include "host/frame/crown_records.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "sim/transmittance_fit.hpp"

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
    for (int axis = 0; axis < 3; ++axis) {
      const float radius = crown.ellipsoid_radii[axis];
      for (int column = 0; column < 3; ++column)
        record.to_unit[4 * axis + column] = crown.ellipsoid_axes[axis][column] / radius;
      record.to_unit[4 * axis + 3] = radius * radius;
    }
    record.volume_scale = crown.ellipsoid_radii.x * crown.ellipsoid_radii.y * crown.ellipsoid_radii.z;
    record.ambient = crown.reeves_blau_ambient;
    record.extinction = crown.reeves_blau_extinction;
    records.push_back(record);
  }
  return records;
}

ShellRows<CrownRecord> cap_shells(const Pose& pose, bool levels) {
  ShellRows<CrownRecord> rows;
  rows.first.push_back(0);
  for (const PosedCrown& crown : pose.crowns) {
    const auto add = [&](const glm::vec3& centre, float radius) {
      CrownRecord record{};
      record.x = centre.x;
      record.y = centre.y;
      record.z = centre.z;
      record.radius = radius;
      record.alpha_rho = levels ? crown.alpha_rho_levels : crown.alpha_rho_shells;
      rows.shells.push_back(record);
    };
    add(crown.sphere_centre, crown.sphere_radius);
    for (const glm::vec4& shell : crown.shells) add(glm::vec3(shell), shell.w);
    rows.first.push_back(static_cast<std::uint32_t>(rows.shells.size()));
  }
  return rows;
}

std::vector<std::vector<TransmittanceShell>> fit_species(const World& world) {
  std::vector<std::vector<TransmittanceShell>> fits(world.crown_models.size());
  const bool dome = world.scene.sky == Sky::dome;
  tbb::parallel_for(std::size_t(0), fits.size(), [&](std::size_t species) {
    const auto instance = std::find_if(world.instances.begin(), world.instances.end(), [&](const Instance& one) {
      return one.species == static_cast<std::int32_t>(species) && one.crown >= 0;
    });
    if (instance == world.instances.end()) return;
    fits[species] = fit_shells(world.prototypes[instance->prototype].crown, world.crown_models[species], dome);
  });
  return fits;
}

ShellRows<TransmittanceShell> transmittance_shells(const Pose& pose,
                                                   const std::vector<std::vector<TransmittanceShell>>& fits) {
  ShellRows<TransmittanceShell> rows;
  rows.first.push_back(0);
  for (const PosedCrown& crown : pose.crowns) {
    const std::vector<TransmittanceShell>& own = fits[static_cast<std::size_t>(crown.species)];
    const bool clustered = own.size() == crown.shells.size() && own.size() > 1;
    for (std::size_t i = 0; i < own.size(); ++i) {
      TransmittanceShell shell = own[i];
      const bool sphere = shell.sphere > 0;
      const glm::vec3 centre = clustered ? glm::vec3(crown.shells[i])
                               : sphere  ? crown.sphere_centre
                                         : crown.ellipsoid_centre;
      shell.x = centre.x;
      shell.y = centre.y;
      shell.z = centre.z;
      shell.radius *= crown.scale;
      shell.sphere /= crown.scale;
      for (int axis = 0; axis < 3; ++axis)
        for (int column = 0; column < 3; ++column)
          shell.to_unit[4 * axis + column] =
              sphere ? shell.to_unit[4 * axis + column] / crown.scale
                     : crown.ellipsoid_axes[axis][column] / (crown.shell_scale * crown.ellipsoid_radii[axis]);
      rows.shells.push_back(shell);
    }
    rows.first.push_back(static_cast<std::uint32_t>(rows.shells.size()));
  }
  return rows;
}

std::vector<ShadingSphere> shading_spheres(const Pose& pose, bool crowns, bool occluders, bool clustered) {
  std::vector<ShadingSphere> spheres;
  const auto add = [&](const glm::vec3& centre, float radius, float opacity, std::int32_t group) {
    spheres.push_back({centre.x, centre.y, centre.z, radius, opacity, group, {0, 0}});
  };
  if (crowns)
    for (const PosedCrown& crown : pose.crowns) {
      if (!clustered) add(crown.sphere_centre, crown.sphere_radius, crown.opacity, crown.group);
      for (std::size_t i = 0; clustered && i < crown.shells.size(); ++i)
        add(glm::vec3(crown.shells[i]), crown.shells[i].w, crown.shell_opacity[i], crown.group);
    }
  if (occluders)
    for (const PosedSphere& sphere : pose.spheres) add(sphere.centre, sphere.radius, 1, sphere.group);
  return spheres;
}

}  // namespace understory
