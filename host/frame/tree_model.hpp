// How crowns shade their own leaves and wood: the pass of one method, and the tables that it reads.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "host/frame/table.hpp"
#include "host/passes/crown_transmittance.hpp"
#include "host/passes/ellipsoid_cap.hpp"
#include "host/passes/reeves_blau.hpp"
#include "host/passes/shells_cap.hpp"
#include "host/passes/sphere_cap.hpp"
#include "sim/pose.hpp"

namespace understory {

class TreeModel {
 public:
  /// `method`: sphere-cap, ellipsoid-cap, shells-cap, shells-cap-levels, reeves-blau or crown-transmittance; true for
  /// these.
  static bool knows(const std::string& method);
  /// Builds the method's program, and fits what it reads of each species' crown. `world` must outlive the model.
  TreeModel(Device& device, const World& world, const std::string& method);

  /// V_c, 1 outside crowns.
  void run(const Pose& pose, const FragmentPlanes& planes, const OwnerTables& owners, Buffer<float>& visibility);
  /// The horizon is in the term already: no open-dome factor.
  bool has_horizon() const;

 private:
  using Pass = std::variant<SphereCapPass, EllipsoidCapPass, ReevesBlauPass, ShellsCapPass, CrownTransmittancePass>;
  static Pass make_pass(Device& device, const World& world, const std::string& method);

  Device* device_;
  const World* world_;
  std::string method_;
  Pass pass_;
  std::vector<std::vector<TransmittanceShell>> fits_;  // per species: crown-transmittance only
  Table<CrownRecord> crowns_;
  Table<std::uint32_t> first_;
  Table<TransmittanceShell> shells_;
};

}  // namespace understory
