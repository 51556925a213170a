// The benchmark of `environment`: cones about the normals, under a constant sky, whose light is V times its radiance.
#include <memory>

#include "bench/kernel_cases.hpp"
#include "host/passes/environment.hpp"

namespace understory {
namespace {

constexpr float radiance = 0.75f, visibility = 0.5f, aperture = 0.1f, share = 0.36f;

/// What the pass reads beside the fragments, and what it writes beside the red light.
struct Planes {
  Planes(Device& device, BenchFragments& all)
      : visibility_of_all(filled(device, all, visibility)),
        cones{filled(device, all, 0), filled(device, all, 0), filled(device, all, 1), filled(device, all, aperture),
              filled(device, all, share)},
        tables(device, prefilter({2, 1, std::vector<glm::vec3>(2, glm::vec3(radiance))}, 0, Sky::dome), Sky::dome),
        pass(device) {
    for (Buffer<float>& channel : light) channel = Buffer<float>(device, all.planes.padded_fragments, "light");
  }
  static Buffer<float> filled(Device& device, const BenchFragments& all, float value) {
    const std::vector<float> values(all.planes.padded_fragments, value);
    return Buffer<float>(device, std::span<const float>(values), "cones");
  }
  Buffer<float> visibility_of_all;
  ConePlanes cones;
  EnvironmentTables tables;
  EnvironmentPass pass;
  std::array<Buffer<float>, 3> light;
};

}  // namespace

KernelCase environment_case() {
  return visibility_case(
      "environment", 1e-5,
      [](Device& device, BenchFragments& all, Buffer<float>& out) {
        const auto planes = std::make_shared<Planes>(device, all);
        return [&all, &out, planes] {
          std::swap(planes->light[0], out);
          planes->pass.run(all.planes, all.owners, planes->visibility_of_all, &planes->cones, planes->tables, {},
                           planes->light);
          std::swap(planes->light[0], out);
        };
      },
      [](const BenchFragments&, const BenchFragment&) { return double(radiance) * double(visibility); });
}

}  // namespace understory
