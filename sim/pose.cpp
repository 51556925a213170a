#include "sim/pose.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/dynamics.hpp"
#include "sim/grass_wind.hpp"
#include "sim/limb_pose.hpp"
#include "sim/occluder_motion.hpp"
#include "sim/wind.hpp"

namespace understory {
namespace {

constexpr double turn = 2 * std::numbers::pi;
/// A leaf at full flutter turns by about this angle about its petiole (sim/plants), radians.
constexpr double full_flutter = 0.3;

/// Radians in [0, 2 pi). Reduced before it becomes a float, so that hours into a run leaves still flutter smoothly.
float phase_at(double frequency, double time) {
  const double turns = frequency * time - std::floor(frequency * time);
  return std::min(static_cast<float>(turns * turn), std::nextafter(static_cast<float>(turn), 0.0f));
}

glm::dmat3 about_vertical(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

/// One frame of the world, instance by instance; every instance writes to places of its own.
class Posing {
 public:
  /// `crowns_only`: of plants only their crowns are posed.
  Posing(const World& world, Pose& pose, bool crowns_only) : world_(world), pose_(pose), crowns_only_(crowns_only) {}

  void pose_instance(std::size_t i) {
    const Instance& instance = world_.instances[i];
    switch (instance.role) {
      case Instance::Role::terrain:
        return pose_rigid(i, [](std::size_t) { return LimbFrame{}; });
      case Instance::Role::occluder:
        return pose_occluder(i);
      case Instance::Role::plant:
        return pose_plant(i);
    }
  }

  /// Limbs of one plant; its crown is left alone.
  std::vector<LimbPose> plant_limbs(std::size_t i) {
    std::vector<LimbPose> limbs(prototype_of(i).limbs.size());
    bend_plant(i, limbs.size(), limbs.data());
    return limbs;
  }

 private:
  const Prototype& prototype_of(std::size_t i) const { return world_.prototypes[world_.instances[i].prototype]; }

  /// `frame_of(limb)`: where the limb's rest frame, its base at the prototype's origin, is now.
  template <class FrameOf>
  void pose_rigid(std::size_t i, const FrameOf& frame_of) {
    for (std::size_t limb = 0; limb < prototype_of(i).limbs.size(); ++limb) {
      BentLimb stiff;
      stiff.frame = frame_of(limb);
      stiff.scale = world_.instances[i].scale;
      pose_.limbs[pose_.first_limb[i] + limb] = stiff.record(pose_.eye);
    }
  }

  void pose_occluder(std::size_t i) {
    std::vector<LimbFrame> frames;
    for (const Transform& part : occluder_parts_at(world_, world_.instances[i].occluder, pose_.time))
      frames.push_back({glm::mat3_cast(part.rotation), part.translation});
    pose_rigid(i, [&](std::size_t limb) { return frames[limb]; });
    for (std::size_t s = 0; s < world_.occluder_spheres.size(); ++s)
      if (const OccluderSphere& sphere = world_.occluder_spheres[s]; sphere.instance == i) {
        const LimbFrame& frame = frames[sphere.limb];
        const glm::dvec3 centre = frame.base + frame.rotation * glm::dvec3(sphere.centre) - pose_.eye;
        pose_.spheres[s] = {glm::vec3(centre), sphere.radius, sphere.group};
      }
  }

  void pose_plant(std::size_t i) {
    const Instance& instance = world_.instances[i];
    const Prototype& prototype = prototype_of(i);
    const std::size_t limbs = crowns_only_ ? std::size_t{prototype.crown.limb} + 1 : prototype.limbs.size();
    if (crowns_only_ && instance.crown < 0) return;
    const std::vector<BentLimb> bent = bend_plant(i, limbs, crowns_only_ ? nullptr : &pose_.limbs[pose_.first_limb[i]]);
    if (instance.crown >= 0 && instance.species >= 0)
      pose_.crowns[instance.crown] = crown_of(instance, bent[prototype.crown.limb]);
  }

  /// Bends the first `count` limbs of a plant. `records`: where they go, unless null.
  std::vector<BentLimb> bend_plant(std::size_t i, std::size_t count, LimbPose* records) {
    const Instance& instance = world_.instances[i];
    const LimbFrame root{about_vertical(instance.yaw), instance.position};
    std::vector<BentLimb> bent(count);
    if (instance.species < 0) {  // of no species: nothing sways
      for (std::size_t limb = 0; limb < count; ++limb) {
        bent[limb].frame = root;
        bent[limb].scale = instance.scale;
        if (records) records[limb] = bent[limb].record(pose_.eye);
      }
      return bent;
    }
    const Prototype& prototype = prototype_of(i);
    const SpeciesSway& sway = world_.dynamics->species[instance.species];
    const glm::dvec2 along = world_.wind->direction();
    // A gust reaches the plant when it has travelled to it (Taylor's frozen turbulence).
    const double arrival = glm::dot(along, glm::dvec2(instance.position)) / world_.wind->convection_speed();
    const double time = pose_.time - arrival - instance.delay;
    for (std::size_t limb = 0; limb < count; ++limb) {
      const Limb& rest = prototype.limbs[limb];
      const double local_time = time - rest.delay;
      glm::dvec2 response{0};
      if (rest.kind != SwayKind::rigid)
        response = (rest.kind == SwayKind::trunk ? sway.trunk : sway.branch).at(local_time) *
                   (sway.exposure[limb] * double(rest.flexibility));
      const glm::dvec3 push(response.x * along.x - response.y * along.y, response.x * along.y + response.y * along.x,
                            0);
      const LimbFrame frame =
          rest.parent >= 0
              ? bent[rest.parent].frame_at(glm::dvec3(rest.base))
              : LimbFrame{root.rotation, root.base + instance.scale * (root.rotation * glm::dvec3(rest.base))};
      bent[limb] = bend_limb(rest, frame, instance.scale, push);

      if (!records) continue;
      LimbPose& record = records[limb];
      record = bent[limb].record(pose_.eye);
      const double drive = glm::length(sway.flutter.at(local_time)) * sway.exposure[limb];
      record.flutter_amplitude = static_cast<float>(prototype.flutter_scale / 127 * std::tanh(drive / full_flutter));
      record.flutter_phase = phase_at(sway.leaf_frequency, pose_.time - instance.delay - rest.delay);
    }
    return bent;
  }

  PosedCrown crown_of(const Instance& instance, const BentLimb& trunk) const {
    const CrownShell& shell = world_.prototypes[instance.prototype].crown;
    const CrownModel& model = world_.crown_models[instance.species];
    const LimbFrame there = trunk.frame_at(trunk.base + trunk.axes[0] * double(shell.trunk_height));
    const auto scale = static_cast<float>(instance.scale);
    PosedCrown crown;
    crown.sphere_centre = glm::vec3(trunk.carried(glm::dvec3(shell.sphere_centre), shell.trunk_height) - pose_.eye);
    crown.sphere_radius = shell.sphere_radius * scale;
    crown.ellipsoid_centre =
        glm::vec3(trunk.carried(glm::dvec3(shell.ellipsoid_centre), shell.trunk_height) - pose_.eye);
    crown.ellipsoid_axes = glm::mat3(there.rotation * glm::dmat3(shell.ellipsoid_axes));
    crown.ellipsoid_radii = shell.ellipsoid_radii * scale;
    for (const glm::vec4& rest : shell.shells)
      crown.shells.emplace_back(glm::vec3(trunk.carried(glm::dvec3(rest), double(shell.trunk_height)) - pose_.eye),
                                rest.w * scale);
    crown.shell_opacity = model.shell_opacity;
    crown.shell_scale = model.shell_scale;
    crown.species = instance.species;
    crown.scale = scale;
    crown.alpha_rho_levels = model.alpha_rho_levels / (scale * scale * scale);
    crown.alpha_rho_shells = model.alpha_rho_shells / (scale * scale * scale);
    crown.alpha_rho = model.alpha_rho / (scale * scale * scale);
    crown.alpha_rho_ellipsoid = model.alpha_rho_ellipsoid / (scale * scale * scale);
    crown.reeves_blau_ambient = model.reeves_blau_ambient;
    crown.reeves_blau_extinction = model.reeves_blau_extinction / scale;
    crown.opacity = model.opacity;
    crown.group = world_.owners[instance.run_owner.front()].group;
    return crown;
  }

  const World& world_;
  Pose& pose_;
  bool crowns_only_;
};

Pose pose_parts(const World& world, double time, glm::dvec3 eye, bool with_plants) {
  Pose pose;
  pose.time = time;
  pose.eye = eye;
  std::uint32_t limbs = 0;
  std::size_t crowns = 0;
  for (const Instance& instance : world.instances) {
    pose.first_limb.push_back(limbs);
    if (with_plants || instance.role != Instance::Role::plant)
      limbs += static_cast<std::uint32_t>(world.prototypes[instance.prototype].limbs.size());
    crowns += instance.crown >= 0;
  }
  pose.limbs.resize(limbs);
  pose.crowns.resize(crowns);
  pose.spheres.resize(world.occluder_spheres.size());
  Posing posing(world, pose, !with_plants);
  tbb::parallel_for(std::size_t(0), world.instances.size(), [&](std::size_t i) { posing.pose_instance(i); });
  for (std::size_t f = 0; f < world.grass.size(); ++f)
    pose.grass.push_back(
        grass_wind_at(*world.wind, world.scene.grass[world.grass[f].field], world.dynamics->grass[f], time, eye));
  return pose;
}

}  // namespace

Pose pose_at(const World& world, double time, glm::dvec3 eye) { return pose_parts(world, time, eye, true); }

Pose pose_without_plants(const World& world, double time, glm::dvec3 eye) {
  return pose_parts(world, time, eye, false);
}

std::vector<LimbPose> plant_limbs_at(const World& world, std::size_t instance, double time, glm::dvec3 eye) {
  Pose pose;
  pose.time = time;
  pose.eye = eye;
  return Posing(world, pose, false).plant_limbs(instance);
}

}  // namespace understory
