// The stability of the tree methods that need no bake: their kernels beside tests/reference in double.
#include "bench/stability_crowns.hpp"
#include "host/passes/crown_transmittance.hpp"
#include "host/passes/ellipsoid_cap.hpp"
#include "host/passes/reeves_blau.hpp"
#include "host/passes/shells_cap.hpp"
#include "host/passes/sphere_cap.hpp"
#include "sim/transmittance_fit.hpp"
#include "tests/reference/crown_transmittance.hpp"
#include "tests/reference/reeves_blau.hpp"
#include "tests/reference/shells_cap.hpp"

namespace understory {
namespace {

glm::dvec3 centre_of(const CrownRecord& r) { return {r.x, r.y, r.z}; }

/// Methods whose table of crowns is one record each.
template <typename Pass>
CrownMethod record_method(const std::string& name,
                          double (*exact)(const CrownRecord&, glm::dvec3 position, glm::dvec3 normal)) {
  CrownMethod method;
  method.name = name;
  method.shade = [](Device& device, const std::vector<TestCrown>& crowns, FragmentPlanes& planes, Buffer<float>& out) {
    Pass(device).run(planes, crown_owners(device, crowns.size()), upload_crowns(device, crowns), out);
  };
  method.exact = [exact](const std::vector<TestCrown>& crowns) {
    std::vector<CrownRecord> records;
    for (const TestCrown& crown : crowns) records.push_back(crown.record());
    return [records, exact](std::size_t crown, glm::dvec3 p, glm::dvec3 n) { return exact(records[crown], p, n); };
  };
  return method;
}

double exact_sphere_cap(const CrownRecord& r, glm::dvec3 p, glm::dvec3 n) {
  return reference::sphere_cap(p - centre_of(r), n, double(r.radius), double(r.alpha_rho));
}

double exact_reeves_blau(const CrownRecord& r, glm::dvec3 p, glm::dvec3) {
  return reference::reeves_blau(p - centre_of(r), double(r.radius), double(r.ambient), double(r.extinction));
}

/// From the record's own numbers, the normal by the library's inverse.
double exact_ellipsoid_cap(const CrownRecord& r, glm::dvec3 p, glm::dvec3 n) {
  glm::dmat3 to_unit;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) to_unit[column][row] = double(r.to_unit[4 * row + column]);
  const glm::dvec3 unit = to_unit * (p - glm::dvec3(r.centre_x, r.centre_y, r.centre_z));
  const glm::dvec3 normal = glm::normalize(glm::inverse(glm::transpose(to_unit)) * n);
  return std::exp(-double(r.alpha_rho) * double(r.volume_scale) * reference::cap_occluders(unit, normal, 1));
}

/// Crown i as three spheres: the whole, and two that overlap within it.
std::vector<TestCrown> shells_of(const std::vector<TestCrown>& crowns) {
  std::vector<TestCrown> shells;
  for (const TestCrown& crown : crowns) {
    shells.push_back(crown);
    for (const double side : {-0.375, 0.25}) {
      shells.push_back(crown);
      shells.back().centre.x = as_float(crown.centre.x + side * crown.radius);
      shells.back().radius = as_float(0.75 * crown.radius);
    }
  }
  return shells;
}

std::vector<std::uint32_t> firsts(std::size_t crowns, std::uint32_t each) {
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i <= crowns; ++i) first.push_back(each * i);
  return first;
}

CrownMethod shells_method(bool levels) {
  CrownMethod method;
  method.name = levels ? "shells-cap-levels" : "shells-cap";
  method.shade = [levels](Device& device, const std::vector<TestCrown>& crowns, FragmentPlanes& planes,
                          Buffer<float>& out) {
    const std::vector<std::uint32_t> numbers = firsts(crowns.size(), 3);
    const Buffer<std::uint32_t> first(device, std::span<const std::uint32_t>(numbers), "first shells");
    ShellsCapPass(device, levels)
        .run(planes, crown_owners(device, crowns.size()), first, crowns.size(),
             upload_crowns(device, shells_of(crowns)), out);
  };
  method.exact = [levels](const std::vector<TestCrown>& crowns) {
    std::vector<reference::CapSphere> spheres;
    for (const TestCrown& shell : shells_of(crowns)) {
      const CrownRecord r = shell.record();
      spheres.push_back({centre_of(r), double(r.radius), double(r.alpha_rho)});
    }
    return [spheres, levels](std::size_t crown, glm::dvec3 p, glm::dvec3 n) {
      const std::span<const reference::CapSphere> own(spheres.data() + 3 * crown, 3);
      return reference::shells_cap(p, n, own[0], own.subspan(1), levels);
    };
  };
  return method;
}

std::vector<TransmittanceShell> fitted(const std::vector<TestCrown>& crowns, bool dome) {
  std::vector<TransmittanceShell> shells;
  for (const TestCrown& crown : crowns) {
    shells.push_back(fit_transmittance(crown.axes, crown.radii, crown.extinction, dome));
    const CrownRecord r = crown.record();
    shells.back().x = r.x;
    shells.back().y = r.y;
    shells.back().z = r.z;
  }
  return shells;
}

CrownMethod transmittance_method(bool dome) {
  CrownMethod method;
  method.name = dome ? "crown-transmittance/dome" : "crown-transmittance";
  method.shade = [dome](Device& device, const std::vector<TestCrown>& crowns, FragmentPlanes& planes,
                        Buffer<float>& out) {
    const std::vector<std::uint32_t> numbers = firsts(crowns.size(), 1);
    const std::vector<TransmittanceShell> rows = fitted(crowns, dome);
    const Buffer<std::uint32_t> first(device, std::span<const std::uint32_t>(numbers), "first shells");
    const Buffer<TransmittanceShell> shells(device, std::span<const TransmittanceShell>(rows), "shells");
    CrownTransmittancePass(device, dome)
        .run(planes, crown_owners(device, crowns.size()), first, crowns.size(), shells, out);
  };
  method.exact = [dome](const std::vector<TestCrown>& crowns) {
    return [shells = fitted(crowns, dome), dome](std::size_t crown, glm::dvec3 p, glm::dvec3 n) {
      const TransmittanceShell& shell = shells[crown];
      return reference::fitted_transmittance(shell, p - glm::dvec3(shell.x, shell.y, shell.z), n, dome);
    };
  };
  return method;
}

}  // namespace

std::vector<StabilityCase> crown_stability(std::size_t samples) {
  CrownMethod depth = record_method<ReevesBlauPass>("reeves-blau", exact_reeves_blau);
  depth.rises_along_normal = false;
  std::vector<StabilityCase> all;
  for (const CrownMethod& method : {depth, record_method<SphereCapPass>("sphere-cap", exact_sphere_cap),
                                    record_method<EllipsoidCapPass>("ellipsoid-cap", exact_ellipsoid_cap),
                                    shells_method(false), shells_method(true)})
    for (StabilityCase& one : crown_cases(method, samples)) all.push_back(std::move(one));
  return all;
}

std::vector<StabilityCase> transmittance_stability(std::size_t samples) {
  std::vector<StabilityCase> all;
  for (const bool dome : {false, true}) {
    CrownMethod method = transmittance_method(dome);
    method.rises_as_foliage_thins = false;  // each density has a fit of its own
    method.stated_error = dome ? 6e-5 : 3e-6;
    method.note = dome ? "lune_first 3e-5 (kernels/shared/lune.h), twice"
                       : "rounding of sums of 25 terms up to 4 with alternating signs: 3e-6";
    if (!dome) {
      method.stated_jump = 6.4e-3;
      method.note += "; fits within and outside meet at the shell within 6.4e-3";
    }
    for (StabilityCase& one : crown_cases(method, samples)) all.push_back(std::move(one));
  }
  return all;
}

}  // namespace understory
