// The visibility passes of a plan, on planes that are on the device already: own model, dome, spheres, combine.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "host/frame/environment_light.hpp"
#include "host/frame/near_field.hpp"
#include "host/frame/plan.hpp"
#include "host/passes/planes.hpp"
#include "sim/pose.hpp"

namespace understory {

class VisibilityPasses {
 public:
  /// Builds the programs of the plan's visibility passes and allocates their planes. `world` may be null (dome only).
  VisibilityPasses(Device& device, const World* world, const Methods& methods, const Plan& plan, std::size_t width,
                   std::size_t height);
  ~VisibilityPasses();
  VisibilityPasses(VisibilityPasses&&) noexcept;
  VisibilityPasses& operator=(VisibilityPasses&&) noexcept;

  /// The camera that sees the planes, which the near field needs; for every run until the next call.
  void see(const ObscuranceView& view);
  /// Shades `planes`; `pose` is null exactly when the world is. `eye`: the camera in the planes' coordinates, m.
  void run(const Pose* pose, const OwnerTables& owners, FragmentPlanes& planes, glm::vec3 eye = glm::vec3(0));

  /// What resolve must know of each face (`crown-baked`); null: nothing.
  const Buffer<std::array<std::uint32_t, 2>>* baked_faces() const;
  /// V_c, one element per padded fragment.
  const Buffer<float>& visibility() const;
  /// Each method's own plane, by the name users type.
  const std::map<std::string, Buffer<float>>& terms() const;
  /// Coloured light where the scene has an environment map; else null.
  const EnvironmentLight* environment() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understory
