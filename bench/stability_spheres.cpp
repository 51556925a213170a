// The stability of shading by spheres: `solid-angle`, its exact forms and `crown-shells`, beside quadrature in double.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/stability_case.hpp"
#include "host/passes/solid_angle.hpp"
#include "kernels/shared/fragment_tiles.h"
#include "kernels/shared/solid_angle.h"
#include "tests/reference/solid_angle.hpp"

namespace understory {
namespace {

constexpr std::size_t own_tile = UNIT * TILE_UNITS;  // elements: no two fragments in one tile
constexpr FarFieldError exactly{0, 0};

ShadingSphere sphere(double radius, double opacity = 1, glm::dvec3 centre = glm::dvec3(0)) {
  ShadingSphere one{};
  const glm::vec3 c(centre);
  one.x = c.x;
  one.y = c.y;
  one.z = c.z;
  one.radius = static_cast<float>(radius);
  one.opacity = static_cast<float>(opacity);
  one.group = -1;
  return one;
}

/// Share of an opaque sphere. `c`: its centre from the fragment, m.
double exact_share(const std::string& method, glm::dvec3 c, glm::dvec3 n, double radius) {
  if (method == "solid-angle") return reference::paper_share(c, radius);
  const auto weighting = method == "solid-angle-exact" ? reference::Weighting::uniform : reference::Weighting::cosine;
  return reference::blocked_share(c, glm::normalize(n), radius, weighting);
}

/// The shared text in double: the sum of very many spheres would take quadrature too long.
double fitted_share(const std::string& method, glm::dvec3 c, glm::dvec3 n, double r) {
  const auto share = method == "solid-angle"         ? solid_angle
                     : method == "solid-angle-exact" ? solid_angle_exact
                                                     : solid_angle_cosine;
  return share(c.x, c.y, c.z, n.x, n.y, n.z, r);
}

FragmentModel model_of(const std::string& method, const std::vector<ShadingSphere>& spheres, bool comparable = true,
                       FarFieldError error = exactly) {
  FragmentModel model;
  model.shade = [=](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
    const OwnerTables owners = upload_owners(device, std::vector<Owner>(3));
    const Buffer<ShadingSphere> table(device, std::span<const ShadingSphere>(spheres), "spheres");
    SolidAnglePass(device, method, error).run(planes, owners, table, spheres.size(), out);
  };
  if (!comparable) return model;
  const auto share = spheres.size() > 50 ? fitted_share : exact_share;
  model.exact = [=](const ExactFragment& f) {
    double v = 1;
    for (const ShadingSphere& s : spheres)
      v *= 1 - double(std::min(s.opacity, 1.0f)) *
                   share(method, glm::dvec3(s.x, s.y, s.z) - f.position, f.normal, double(s.radius));
    return v;
  };
  return model;
}

TestFragment at(glm::vec3 position, glm::vec3 normal) {
  TestFragment f;
  f.position = position;
  f.normal = normal;
  return f;
}

/// `nearest` to `farthest` radii from `centre`; the plane of every other one cuts the sphere.
std::vector<TestFragment> around(double radius, glm::dvec3 centre, double nearest, double farthest, std::size_t count) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random = case_random("around", i);
    const double d = radius * nearest * std::pow(farthest / nearest, random.uniform());
    const glm::dvec3 n = glm::normalize(glm::dvec3(random_direction(random)));
    const glm::dvec3 any = glm::normalize(glm::dvec3(random_direction(random)));
    const glm::dvec3 level = glm::normalize(any - glm::dot(any, n) * n) * d + n * radius * random.uniform(-1, 1);
    all.push_back(at(glm::vec3(centre + (i % 2 ? any * d : level)), glm::vec3(n)));
  }
  return all;
}

class SphereCases {
 public:
  SphereCases(const std::string& method, std::size_t samples) : method_(method), samples_(samples) {}

  StabilityCase& add(const std::string& name, const std::vector<TestFragment>& fragments, const FragmentModel& model,
                     std::size_t apart = 1) {
    all.push_back(fragment_case(method_, name, fragments, model, apart));
    if (method_ == "solid-angle-cosine" || method_ == "crown-shells") {
      all.back().stated_error = 1.5e-5;
      all.back().note = "fits of the form factor, 1.5e-5 (kernels/shared/solid_angle.h)";
    }
    return all.back();
  }

  void add_sizes_and_places() {
    const FragmentModel ball = model_of(method_, {sphere(1.5)});
    add("one ordinary sphere", around(1.5, glm::dvec3(0), 1.02, 30, samples_), ball).extreme = false;
    add("one ordinary sphere, each fragment in its own tile", around(1.5, glm::dvec3(0), 1.02, 30, samples_ / 8), ball,
        own_tile)
        .extreme = false;
    for (const double radius : {1e-6, 1e-3, 1e3, 1e6})
      add("radius " + text(radius) + " m", around(radius, glm::dvec3(0), 0.1, 30, samples_ / 8),
          model_of(method_, {sphere(radius)}));
    StabilityCase& within = add("within the sphere", around(1.5, glm::dvec3(0), 1e-9, 1, samples_ / 4), ball);
    if (method_ == "solid-angle-exact") {
      within.stated_error = 1.2e-4;
      within.note = "an angle from its cosine near 1, where the normal points at the centre: sqrt(2^-23) / pi = 1.1e-4";
    }
    add("far away", around(1.5, glm::dvec3(0), 30, 6e11, samples_ / 4), ball);
    const glm::dvec3 far(1e7, -1e7, 1e7);
    add("coordinates at 1e7 m", around(20, far, 0.5, 30, samples_ / 4), model_of(method_, {sphere(20, 1, far)}));
    std::vector<TestFragment> centre;
    for (const glm::vec3 n : stability_directions(4))
      for (const float d : {0.0f, 1e-44f, 1e-38f, 1e-20f, 1e-12f})
        for (const glm::vec3 u : stability_directions(0)) centre.push_back(at(d * u, n));
    add("at the centre, denormal distances", centre, ball);
  }

  /// One unit in the last place either side of the surface, of the ends of the fits and of the lists, and of where the
  /// plane begins to cut the sphere.
  void add_branches() {
    std::vector<TestFragment> fragments;
    std::vector<std::pair<std::size_t, std::size_t>> neighbours;
    const auto pair = [&](glm::vec3 p, int axis, glm::vec3 n) {
      glm::vec3 beyond = p;
      beyond[axis] = std::nextafter(p[axis], std::copysign(1e30f, p[axis]));
      neighbours.push_back({fragments.size(), fragments.size() + 1});
      fragments.push_back(at(p, n));
      fragments.push_back(at(beyond, n));
    };
    for (const float d : {1.0f, 1.5f, 4.0f})
      for (const glm::vec3 n : stability_directions(6))
        for (const float inside : {d, std::nextafter(d, 0.0f)}) pair({0, inside, 0}, 1, n);
    for (const float s : {-1.0f, 0.0f, 1.0f})
      for (const float off : {0.0f, 0.3f, 1.0f, 1.2f, 1.5f, 3.0f, 4.0f, 40.0f})
        for (const float inside : {s, std::nextafter(s, 0.0f)}) pair({off, 0, inside}, 2, {0, 0, 1});
    add("surface, ends of fits and lists, horizon of the plane", fragments, model_of(method_, {sphere(1)}), own_tile)
        .neighbours = neighbours;
  }

  void add_many() {
    std::vector<ShadingSphere> few, many;
    for (std::size_t i = 0; i < 10000; ++i) {
      Random random = case_random("sphere", i);
      const glm::dvec3 c(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-2, 6));
      if (i < 20) few.push_back(sphere(random.uniform(0.3, 1.5), random.uniform(), c));
      many.push_back(sphere(random.uniform(0.3, 1.5), random.uniform(0, 0.02), 0.1 * c));
    }
    StabilityCase& twenty =
        add("20 spheres of any opacity", around(8, glm::dvec3(0), 0.05, 3, samples_ / 20), model_of(method_, few));
    twenty.extreme = false;
    twenty.stated_error *= 3;
    StabilityCase& folded = add("20 spheres, far ones folded", around(8, glm::dvec3(0), 0.05, 30, samples_ / 20),
                                model_of(method_, few, true, FarFieldError{}), own_tile);
    folded.stated_error += double(FarFieldError{}.total);
    folded.note = "folded far field, 1/64 of V (host/passes/solid_angle.hpp)";
    add("10,000 overlapping spheres", around(1, glm::dvec3(0), 0.01, 30, samples_ / 20), model_of(method_, many));
    for (ShadingSphere& s : many) s.opacity = 1;
    add("10,000 overlapping opaque spheres", around(1, glm::dvec3(0), 0.01, 30, samples_ / 20),
        model_of(method_, many));
    for (const double opacity : {0.0, 1e-44, 1e-7, 2.0})
      add("opacity " + text(opacity), around(1.5, glm::dvec3(0), 0.5, 30, samples_ / 20),
          model_of(method_, {sphere(1.5, opacity)}));
  }

  void add_garbage_and_orders() {
    std::vector<ShadingSphere> broken(6, sphere(1));
    broken[0].radius = NAN;
    broken[1].x = INFINITY;
    broken[2].opacity = NAN;
    broken[3].radius = -1;
    broken[4].radius = 3e38f;
    broken[5].opacity = -INFINITY;
    add("zero, NaN and infinite numbers", garbage(1), model_of(method_, {sphere(1)}, false));
    add("spheres of no or infinite size", garbage(1), model_of(method_, broken, false));
    std::vector<TestFragment> fragments;
    std::vector<std::size_t> order;
    for (int step = 0; step < 400; ++step) {
      order.push_back(fragments.size());
      fragments.push_back(at({0, 0, -0.02f * static_cast<float>(step)}, {0, 0, 1}));
    }
    add("rising away from the sphere", fragments, model_of(method_, {sphere(1)}), own_tile).rising = {order};
  }

  std::vector<StabilityCase> all;

 private:
  static std::string text(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%g", value);
    return buffer;
  }

  std::string method_;
  std::size_t samples_;
};

}  // namespace

std::vector<StabilityCase> sphere_stability(std::size_t samples) {
  std::vector<StabilityCase> all;
  for (const char* method : {"solid-angle", "solid-angle-exact", "solid-angle-cosine"}) {
    SphereCases cases(method, samples);
    cases.add_sizes_and_places();
    cases.add_branches();
    cases.add_many();
    cases.add_garbage_and_orders();
    std::move(cases.all.begin(), cases.all.end(), std::back_inserter(all));
  }
  SphereCases shells("crown-shells", samples);  // the same kernel with clustered spheres
  shells.add_many();
  std::move(shells.all.begin(), shells.all.end(), std::back_inserter(all));
  return all;
}

}  // namespace understory
