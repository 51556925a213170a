// The table of kernel benchmarks. References are the shared formulas in double, fragment by fragment.
#include "bench/kernel_cases.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "host/passes/combine.hpp"
#include "host/passes/crown_transmittance.hpp"
#include "host/passes/ellipsoid_cap.hpp"
#include "host/passes/grass_height.hpp"
#include "host/passes/open_dome.hpp"
#include "host/passes/reeves_blau.hpp"
#include "host/passes/shells_cap.hpp"
#include "host/passes/solid_angle.hpp"
#include "host/passes/sphere_cap.hpp"
#include "kernels/shared/crown_transmittance.h"
#include "kernels/shared/ellipsoid_cap.h"
#include "kernels/shared/grass_height.h"
#include "kernels/shared/open_dome.h"
#include "kernels/shared/reeves_blau.h"
#include "kernels/shared/solid_angle.h"
#include "kernels/shared/sphere_cap.h"
#include "sim/transmittance_fit.hpp"

namespace understory {
namespace {

/// Of the kernels' float arithmetic against the same formula in double; exponents here stay below 10.
constexpr double float_error = 1e-5;
/// Of a product over the spheres that shade a fragment (tests/support/tolerances.hpp).
constexpr double solid_angle_product = 4e-5;

/// The crown of a fragment; null without one.
const CrownRecord* crown_of(const BenchFragments& all, const BenchFragment& fragment) {
  const std::int32_t row = all.owner_rows()[fragment.owner].crown;
  return row < 0 ? nullptr : &all.crown_rows()[static_cast<std::size_t>(row)];
}

SurfaceClass class_of(const BenchFragments& all, const BenchFragment& fragment) {
  return all.owner_rows()[fragment.owner].surface;
}

/// A method that shades fragments by their crown.
template <typename Pass>
KernelCase crown_case(const std::string& method, double (*reference)(const CrownRecord&, const BenchFragment&)) {
  return visibility_case(
      method, float_error,
      [](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        return
            [&, pass = std::make_shared<Pass>(device)] { pass->run(all.planes, all.owners, all.crowns, visibility); };
      },
      [reference](const BenchFragments& all, const BenchFragment& fragment) {
        const CrownRecord* crown = crown_of(all, fragment);
        return crown ? reference(*crown, fragment) : 1.0;
      });
}

double sphere_cap_reference(const CrownRecord& crown, const BenchFragment& f) {
  const glm::dvec3 p = glm::dvec3(f.position) - glm::dvec3(crown.x, crown.y, crown.z), n(f.normal);
  return sphere_cap(p.x, p.y, p.z, n.x, n.y, n.z, double(crown.radius), double(crown.alpha_rho));
}

double reeves_blau_reference(const CrownRecord& crown, const BenchFragment& f) {
  const glm::dvec3 p = glm::dvec3(f.position) - glm::dvec3(crown.x, crown.y, crown.z);
  return reeves_blau(p.x, p.y, p.z, double(crown.radius), double(crown.ambient), double(crown.extinction));
}

/// One shell a crown, its sphere, at k R = 3: the same error everywhere as in the crowns of a scene.
TransmittanceShell transmittance_shell(const CrownRecord& crown, bool dome) {
  const glm::dvec3 radii(crown.radius);
  TransmittanceShell shell = fit_transmittance(glm::dmat3(1), radii, 3 / radii.x, dome);
  shell.x = crown.x;
  shell.y = crown.y;
  shell.z = crown.z;
  return shell;
}

/// `dome`: with the horizon in the model.
KernelCase crown_transmittance_case(bool dome) {
  return visibility_case(
      std::string("crown-transmittance") + (dome ? "/dome" : ""),
      3e-5,  // tests/support/tolerances.hpp
      [dome](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        std::vector<std::uint32_t> first{0};
        std::vector<TransmittanceShell> shells;
        for (const CrownRecord& crown : all.crown_rows()) {
          shells.push_back(transmittance_shell(crown, dome));
          first.push_back(static_cast<std::uint32_t>(shells.size()));
        }
        struct State {
          CrownTransmittancePass pass;
          Buffer<std::uint32_t> first;
          Buffer<TransmittanceShell> shells;
        };
        const auto state = std::make_shared<State>(
            State{CrownTransmittancePass(device, dome),
                  Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(first), "first shells"),
                  Buffer<TransmittanceShell>(device, std::span<const TransmittanceShell>(shells), "shells")});
        return [&all, &visibility, state] {
          state->pass.run(all.planes, all.owners, state->first, all.crown_rows().size(), state->shells, visibility);
        };
      },
      [dome, fits = std::map<float, TransmittanceShell>()](const BenchFragments& all, const BenchFragment& f) mutable {
        const CrownRecord* crown = crown_of(all, f);
        if (!crown) return 1.0;
        if (!fits.contains(crown->radius)) fits[crown->radius] = transmittance_shell(*crown, dome);
        const glm::dvec3 p = glm::dvec3(f.position) - glm::dvec3(crown->x, crown->y, crown->z), n(f.normal);
        return crown_transmittance(fits[crown->radius], p.x, p.y, p.z, n.x, n.y, n.z, dome);
      });
}

/// The whole crown and four spheres of half its size in it.
KernelCase shells_cap_case() {
  const auto shells_of = [](const CrownRecord& crown) {
    std::vector<CrownRecord> shells{crown};
    for (const auto& [x, y] : {std::pair{-0.5f, -0.5f}, {-0.5f, 0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}}) {
      CrownRecord& shell = shells.emplace_back(crown);
      shell.x += x * crown.radius;
      shell.y += y * crown.radius;
      shell.radius *= 0.7f;
    }
    return shells;
  };
  return visibility_case(
      "shells-cap", float_error,
      [shells_of](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        std::vector<std::uint32_t> first{0};
        std::vector<CrownRecord> shells;
        for (const CrownRecord& crown : all.crown_rows()) {
          for (const CrownRecord& shell : shells_of(crown)) shells.push_back(shell);
          first.push_back(static_cast<std::uint32_t>(shells.size()));
        }
        const auto starts =
            std::make_shared<Buffer<std::uint32_t>>(device, std::span<const std::uint32_t>(first), "first shells");
        const auto table =
            std::make_shared<Buffer<CrownRecord>>(device, std::span<const CrownRecord>(shells), "shells");
        return [&all, &visibility, starts, table, pass = std::make_shared<ShellsCapPass>(device, false)] {
          pass->run(all.planes, all.owners, *starts, all.crown_rows().size(), *table, visibility);
        };
      },
      [shells_of](const BenchFragments& all, const BenchFragment& f) {
        const CrownRecord* crown = crown_of(all, f);
        if (!crown) return 1.0;
        const std::vector<CrownRecord> shells = shells_of(*crown);
        const auto away = [&](const CrownRecord& shell) {
          return glm::distance(glm::dvec3(f.position), glm::dvec3(shell.x, shell.y, shell.z));
        };
        return sphere_cap_reference(*std::min_element(shells.begin() + 1, shells.end(),
                                                      [&](const auto& a, const auto& b) { return away(a) < away(b); }),
                                    f);
      });
}

double ellipsoid_cap_reference(const CrownRecord& crown, const BenchFragment& f) {
  const auto row = [&](int first) {
    return Direction{double(crown.to_unit[first]), double(crown.to_unit[first + 1]), double(crown.to_unit[first + 2])};
  };
  const Direction offset{double(f.position.x) - double(crown.centre_x), double(f.position.y) - double(crown.centre_y),
                         double(f.position.z) - double(crown.centre_z)};
  const Direction normal{double(f.normal.x), double(f.normal.y), double(f.normal.z)};
  const Direction squares{double(crown.to_unit[3]), double(crown.to_unit[7]), double(crown.to_unit[11])};
  return ellipsoid_cap(to_unit_sphere(offset, row(0), row(4), row(8)), normal, row(0), row(4), row(8), squares,
                       double(crown.volume_scale), double(crown.alpha_rho));
}

using Share = double (*)(double, double, double, double, double, double, double);

/// All spheres shade all fragments; `exactly`: none is approximated.
KernelCase sphere_case(const std::string& method, Share share, bool exactly) {
  const FarFieldError error = exactly ? FarFieldError{0, 0} : FarFieldError{};
  return visibility_case(
      method + (exactly ? "/each" : ""), solid_angle_product + double(error.total),
      [=](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        return [&, pass = std::make_shared<SolidAnglePass>(device, method, error)] {
          pass->run(all.planes, all.owners, all.spheres, all.sphere_rows().size(), visibility);
        };
      },
      [share](const BenchFragments& all, const BenchFragment& f) {
        double v = 1;
        for (const ShadingSphere& sphere : all.sphere_rows()) {
          if (sphere.group == all.owner_rows()[f.owner].group) continue;
          const glm::dvec3 d = glm::dvec3(sphere.x, sphere.y, sphere.z) - glm::dvec3(f.position), n(f.normal);
          v *= 1 - double(sphere.opacity) * share(d.x, d.y, d.z, n.x, n.y, n.z, double(sphere.radius));
        }
        return v;
      });
}

KernelCase ambient_case() {
  constexpr double constant = 0.6;
  return visibility_case(
      "ambient", float_error,
      [](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        return [&, pass = std::make_shared<AmbientPass>(device)] {
          pass->run(all.planes, all.owners, constant, class_bit(SurfaceClass::leaf), all.cover, glm::dvec3(0),
                    visibility);
        };
      },
      [](const BenchFragments& all, const BenchFragment& f) {
        if (class_of(all, f) == SurfaceClass::leaf) return constant;
        const bool terrain = class_of(all, f) == SurfaceClass::terrain;
        return terrain ? BenchFragments::cover_at(double(f.position.x), double(f.position.y)) : 1.0;
      },
      BenchFragments::Cover::ground);
}

KernelCase grass_height_case() {
  return visibility_case(
      "grass-height", float_error,
      [](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        return [&, pass = std::make_shared<GrassHeightPass>(device)] { pass->run(all.planes, all.owners, visibility); };
      },
      [](const BenchFragments& all, const BenchFragment& f) {
        if (class_of(all, f) != SurfaceClass::blade) return 1.0;
        return grass_height(double(f.height), double(f.blade_length));
      },
      BenchFragments::Cover::grass);
}

KernelCase open_dome_case() {
  return visibility_case(
      "open-dome", float_error,
      [](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        return [&, pass = std::make_shared<OpenDomePass>(device)] { pass->run(all.planes, visibility); };
      },
      [](const BenchFragments&, const BenchFragment& f) { return open_dome(double(f.normal.z)); });
}

/// Three terms, all of them the plane normal_x, which combine limits to [0, 1].
KernelCase combine_case() {
  return visibility_case(
      "combine", float_error,
      [](Device& device, BenchFragments& all, Buffer<float>& visibility) {
        return [&, pass = std::make_shared<CombinePass>(device)] {
          VisibilityTerms terms;
          terms.tree = &all.planes.normal_x;
          terms.crowns = &all.planes.normal_y;
          terms.dome = &all.planes.normal_z;
          pass->run(all.planes, all.owners, terms, visibility);
        };
      },
      [](const BenchFragments&, const BenchFragment& f) {
        const glm::vec3 v = glm::clamp(f.normal, 0.0f, 1.0f);
        return double(v.x) * double(v.y) * double(v.z);
      });
}

}  // namespace

KernelCase visibility_case(
    const std::string& kernel, double tolerance,
    std::function<std::function<void()>(Device&, BenchFragments&, Buffer<float>& visibility)> build,
    std::function<double(const BenchFragments&, const BenchFragment&)> reference, BenchFragments::Cover filled_by) {
  return {kernel, tolerance, [=](Device& device, BenchFragments& given) {
            std::shared_ptr<BenchFragments> own;
            if (filled_by != BenchFragments::Cover::crowns)
              own = std::make_shared<BenchFragments>(device, given.planes.fragments, filled_by);
            BenchFragments& all = own ? *own : given;
            const auto visibility = std::make_shared<Buffer<float>>(device, all.planes.padded_fragments, "visibility");
            ReadyKernel ready;
            ready.run = [own, visibility, shade = build(device, all, *visibility)] { shade(); };
            ready.error = [own, visibility, reference, &all] {
              const std::vector<float> values = visibility->read();
              double largest = 0;
              for (std::size_t i = 0; i < all.planes.fragments; i += 101) {
                const double error = std::abs(double(values[i]) - reference(all, all.at(i)));
                largest = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
              }
              return largest;
            };
            ready.items = static_cast<double>(all.planes.padded_fragments);
            return ready;
          }};
}

std::vector<KernelCase> kernel_cases() {
  std::vector<KernelCase> cases = {ambient_case(),
                                   open_dome_case(),
                                   grass_height_case(),
                                   grass_transmittance_case(),
                                   crown_case<ReevesBlauPass>("reeves-blau", reeves_blau_reference),
                                   crown_case<SphereCapPass>("sphere-cap", sphere_cap_reference),
                                   crown_case<EllipsoidCapPass>("ellipsoid-cap", ellipsoid_cap_reference),
                                   shells_cap_case(),
                                   crown_transmittance_case(false),
                                   crown_transmittance_case(true),
                                   crown_field_case(),
                                   crown_baked_case(),
                                   sphere_case("solid-angle", solid_angle, false),
                                   sphere_case("solid-angle-exact", solid_angle_exact, false),
                                   sphere_case("solid-angle-cosine", solid_angle_cosine, false),
                                   sphere_case("solid-angle-cosine", solid_angle_cosine, true),
                                   grid_case("grid"),
                                   grid_case("grid-cone"),
                                   combine_case(),
                                   environment_case(),
                                   farthest_depth_case()};
  for (auto* more : {&geometry_cases, &foliage_cases, &image_cases})
    for (KernelCase& one : more()) cases.push_back(std::move(one));
  return cases;
}

}  // namespace understory
