#include "host/frame/tree_model.hpp"

#include <algorithm>
#include <iterator>

#include "host/frame/crown_records.hpp"
#include "sim/error.hpp"

namespace understory {

bool TreeModel::knows(const std::string& method) {
  const char* const methods[] = {"sphere-cap",        "ellipsoid-cap", "shells-cap",
                                 "shells-cap-levels", "reeves-blau",   "crown-transmittance"};
  return std::find(std::begin(methods), std::end(methods), method) != std::end(methods);
}

TreeModel::Pass TreeModel::make_pass(Device& device, const World& world, const std::string& method) {
  if (method == "sphere-cap") return Pass(std::in_place_type<SphereCapPass>, device);
  if (method == "ellipsoid-cap") return Pass(std::in_place_type<EllipsoidCapPass>, device);
  if (method == "reeves-blau") return Pass(std::in_place_type<ReevesBlauPass>, device);
  if (method == "shells-cap") return Pass(std::in_place_type<ShellsCapPass>, device, false);
  if (method == "shells-cap-levels") return Pass(std::in_place_type<ShellsCapPass>, device, true);
  if (method == "crown-transmittance")
    return Pass(std::in_place_type<CrownTransmittancePass>, device, world.scene.sky == Sky::dome);
  throw Error(ErrorKind::unexpected, "'" + method + "' is no method of crowns");
}

TreeModel::TreeModel(Device& device, const World& world, const std::string& method)
    : device_(&device), world_(&world), method_(method), pass_(make_pass(device, world, method)) {
  if (std::holds_alternative<CrownTransmittancePass>(pass_)) fits_ = fit_species(world);
}

bool TreeModel::has_horizon() const {
  return std::holds_alternative<CrownTransmittancePass>(pass_) && world_->scene.sky == Sky::dome;
}

void TreeModel::run(const Pose& pose, const FragmentPlanes& planes, const OwnerTables& owners,
                    Buffer<float>& visibility) {
  if (auto* transmittance = std::get_if<CrownTransmittancePass>(&pass_)) {
    const ShellRows<TransmittanceShell> rows = transmittance_shells(pose, fits_);
    first_.write(*device_, rows.first, "first shells");
    shells_.write(*device_, rows.shells, "transmittance shells");
    transmittance->run(planes, owners, first_.buffer(), pose.crowns.size(), shells_.buffer(), visibility);
  } else if (auto* shells = std::get_if<ShellsCapPass>(&pass_)) {
    const ShellRows<CrownRecord> rows = cap_shells(pose, method_ == "shells-cap-levels");
    first_.write(*device_, rows.first, "first shells");
    crowns_.write(*device_, rows.shells, "shells");
    shells->run(planes, owners, first_.buffer(), pose.crowns.size(), crowns_.buffer(), visibility);
  } else {
    crowns_.write(*device_, crown_records(pose, method_), "crowns");
    if (auto* sphere = std::get_if<SphereCapPass>(&pass_)) sphere->run(planes, owners, crowns_.buffer(), visibility);
    if (auto* ellipsoid = std::get_if<EllipsoidCapPass>(&pass_))
      ellipsoid->run(planes, owners, crowns_.buffer(), visibility);
    if (auto* depth = std::get_if<ReevesBlauPass>(&pass_)) depth->run(planes, owners, crowns_.buffer(), visibility);
  }
}

}  // namespace understory
