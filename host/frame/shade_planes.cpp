// Visibility passes on planes that another program rendered: owners may be unknown, values may be anything.
#include <limits>
#include <optional>

#include "host/frame/crown_bakes.hpp"
#include "host/frame/read_back.hpp"
#include "host/frame/runner.hpp"
#include "host/frame/visibility.hpp"
#include "host/passes/check_fragments.hpp"
#include "sim/pose.hpp"

namespace understory {
namespace {

/// Where float keeps the most of the positions: the middle of what the frame sees, m relative to the origin.
glm::dvec3 middle_of(const Frame& frame) {
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    const glm::dvec3 p(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
    if ((frame.validity[i] & validity::background) != 0 || !glm::all(glm::lessThan(glm::abs(p), glm::dvec3(1e30))))
      continue;
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return low.x <= high.x ? 0.5 * (low + high) : glm::dvec3(0);
}

/// A leaf row of the owner table for every crown; fragments in a crown's sphere go to the crown whose centre is nearest
/// (Hegeman et al. 2006, section 5), all others keep row 0.
void own_by_nearest_crown(const World& world, const Pose& pose, Frame& frame) {
  std::vector<std::uint32_t> crown_owner(pose.crowns.size(), 0);
  for (std::uint32_t row = 0; row < world.owners.size(); ++row)
    if (world.owners[row].crown >= 0 && world.owners[row].surface == SurfaceClass::leaf)
      crown_owner[static_cast<std::size_t>(world.owners[row].crown)] = row;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if ((frame.validity[i] & validity::background) != 0) continue;
    const glm::vec3 p(glm::dvec3(frame.position[0][i], frame.position[1][i], frame.position[2][i]) - pose.eye);
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t crown = 0; crown < pose.crowns.size(); ++crown) {
      const float distance = glm::length(p - pose.crowns[crown].sphere_centre);
      if (distance >= nearest || distance > pose.crowns[crown].sphere_radius) continue;
      nearest = distance;
      frame.owner[i] = crown_owner[crown];
    }
  }
}

bool owners_unknown(const Frame& frame) {
  for (std::size_t i = 0; i < frame.owner.size(); ++i)
    if (frame.owner[i] != 0) return false;
  return true;
}

}  // namespace

void shade_planes(Device& device, const World* world, const Methods& methods, double time, Frame& frame) {
  const glm::dvec3 eye = middle_of(frame);
  std::optional<Pose> pose;
  if (world) {
    pose = pose_at(*world, time, eye);
    if (owners_unknown(frame)) own_by_nearest_crown(*world, *pose, frame);
    frame.owners = world->owners;
  } else {
    frame.owners.assign(1, Owner{});
    frame.owner.assign(frame.pixels(), 0);
  }
  Methods usable = methods;
  if (usable.grass != "grass-transmittance") usable.grass = "none";  // planes of other renderers lack blades' lengths
  const Plan plan = make_visibility_plan(world, usable);
  FragmentPlanes planes = upload_planes(device, frame, eye);
  const OwnerTables owners = upload_owners(device, frame.owners);
  CheckFragmentsPass(device).run(planes);
  if (plan.has("crown-field")) map_back_rigidly(device, *world, frame, planes);
  VisibilityPasses passes(device, world, usable, plan, static_cast<std::size_t>(frame.width),
                          static_cast<std::size_t>(frame.height));
  if (usable.near != "none") passes.see(obscurance_view(frame));
  const glm::dvec3 camera = glm::dvec3(glm::inverse(frame.world_to_camera)[3]);
  passes.run(pose ? &*pose : nullptr, owners, planes, glm::vec3(camera - eye));
  frame.pass_ms = device.take_pass_times();
  std::vector<std::uint32_t> flags(planes.padded_fragments);
  planes.validity.read(std::span<std::uint32_t>(flags));
  frame.validity.assign(flags.begin(), flags.begin() + static_cast<std::ptrdiff_t>(frame.pixels()));
  read_visibility(passes, planes.row_length, frame);
}

}  // namespace understory
