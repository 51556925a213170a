#include "bench/stability_crowns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understory {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A ball of radius R at `centre`; `optical`: alpha rho R^3, and k R.
TestCrown ball(double radius, double optical, glm::dvec3 centre = glm::dvec3(0)) {
  TestCrown crown;
  crown.centre = centre;
  crown.radius = as_float(radius);
  crown.radii = glm::dvec3(crown.radius);
  crown.alpha_rho = as_float(std::min(optical / (radius * radius * radius), 1e38));
  crown.ambient = 0.875;
  crown.extinction = as_float(std::min(optical / radius, 1e38));
  return crown;
}

TestFragment fragment(glm::vec3 position, glm::vec3 normal, std::uint32_t owner = 1) {
  TestFragment f;
  f.position = position;
  f.normal = normal;
  f.owner = owner;
  return f;
}

/// Places from the centre to a little outside, of any direction, for each normal.
std::vector<TestFragment> places(const std::vector<TestCrown>& crowns, std::size_t count) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random = case_random("place", i);
    const std::size_t crown = i % crowns.size();
    const double distance = crowns[crown].radius * 1.1 * std::cbrt(random.uniform());
    const glm::dvec3 p = crowns[crown].centre + distance * glm::dvec3(random_direction(random));
    all.push_back(fragment(glm::vec3(p), random_direction(random), static_cast<std::uint32_t>(crown + 1)));
  }
  return all;
}

std::vector<TestCrown> ordinary_crowns() {
  std::vector<TestCrown> crowns;
  for (std::size_t i = 0; i < 8; ++i) {
    Random random = case_random("crown", i);
    crowns.push_back(random_crown(random));
    crowns.back().alpha_rho = as_float(random.uniform(0, 3) / std::pow(crowns.back().radius, 3));
  }
  return crowns;
}

/// From a few units in the last place within the shell to a few beyond where rounding no longer counts as within
/// (sphere_cap.h, crown_transmittance.cl), along every axis, for each normal.
void add_shell(StabilityCase& one, std::vector<TestFragment>& all, float radius) {
  for (const glm::vec3 n : stability_directions(8))
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-1.0f, 1.0f})
        for (const float middle : {radius, radius * std::sqrt(1.00001f)}) {
          float distance = middle;
          for (int step = 0; step < 6; ++step) distance = std::nextafter(distance, 0.0f);
          for (int step = 0; step < 12; ++step, distance = std::nextafter(distance, infinity)) {
            glm::vec3 p(0);
            p[axis] = side * distance;
            if (step > 0) one.neighbours.push_back({all.size() - 1, all.size()});
            all.push_back(fragment(p, n));
          }
        }
}

class CrownCases {
 public:
  CrownCases(const CrownMethod& method, std::size_t samples) : method_(method), samples_(samples) {}

  StabilityCase& add(const std::string& name, const std::vector<TestCrown>& crowns,
                     const std::vector<TestFragment>& fragments, bool comparable = true) {
    FragmentModel model;
    model.shade = [crowns, shade = method_.shade](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
      shade(device, crowns, planes, out);
    };
    if (comparable)
      model.exact = [exact = method_.exact(crowns)](const ExactFragment& f) {
        return exact(f.owner - 1, f.position, f.normal);
      };
    all.push_back(fragment_case(method_.name, name, fragments, model));
    all.back().stated_error = method_.stated_error;
    all.back().note = method_.note;
    return all.back();
  }

  void add_sizes_and_densities() {
    add("ordinary crowns", ordinary_crowns(), places(ordinary_crowns(), samples_)).extreme = false;
    for (const double radius : {1e-6, 1e-3, 1e3, 1e6}) {
      const std::vector<TestCrown> crowns{ball(radius, 1), ball(radius, 30)};
      add("radius " + number(radius) + " m", crowns, places(crowns, samples_ / 4));
    }
    for (const double density : {0.0, 1e-30, 1e3, 1e6, 1e30}) {
      const std::vector<TestCrown> crowns{ball(2, density)};
      add("density " + number(density) + " / R^3", crowns, places(crowns, samples_ / 4));
    }
  }

  void add_places() {
    for (const double optical : {1.0, 1e4}) {
      const std::vector<TestCrown> crowns{ball(2, optical)};
      std::vector<TestFragment> on_shell, centre, outside;
      StabilityCase rims;
      add_shell(rims, on_shell, 2);
      for (const glm::vec3 n : stability_directions(8))
        for (const float d : {0.0f, 1e-44f, 1e-38f, 1e-30f, 1e-12f, 1e-6f})
          for (const glm::vec3 u : stability_directions(0)) centre.push_back(fragment(d * u, n));
      for (const glm::vec3 n : stability_directions(8))
        for (const float d : {2.1f, 4.0f, 1e3f, 1e7f, 1e12f, 1e19f, 3e38f})
          for (const glm::vec3 u : stability_directions(0)) outside.push_back(fragment(d * u, n));
      const std::string density = optical > 1 ? ", dense" : "";
      StabilityCase& shell = add("on the shell, one unit in the last place in and out" + density, crowns, on_shell);
      shell.neighbours = rims.neighbours;
      shell.stated_jump = method_.stated_jump;
      add("at the centre, denormal distances" + density, crowns, centre);
      StabilityCase& beyond = add("far outside" + density, crowns, outside);
      if (method_.name.find("-cap") != std::string::npos)
        beyond.conditioning =
            "behind the centre on the cap's axis d of eq. 5 is rounded by more than h from 1e7 m on; code 8 is set";
    }
    const glm::dvec3 far(1e7, -1e7, 1e7);
    const std::vector<TestCrown> crowns{ball(5, 1, far)};
    add("coordinates at 1e7 m", crowns, places(crowns, samples_ / 4));
  }

  /// What is not a unit normal or a number at all: bounds only.
  void add_garbage() {
    const std::vector<TestCrown> crowns{ball(2, 1), ball(2, 1e30)};
    add("zero, NaN and infinite numbers", crowns, garbage(static_cast<std::uint32_t>(crowns.size())), false);
    std::vector<TestFragment> lengths = places(crowns, 500);
    for (std::size_t i = 0; i < lengths.size(); ++i)
      lengths[i].normal *= std::pow(10.0f, static_cast<float>(i % 61) - 30.0f);
    add("normals of length 1e-30 to 1e30", crowns, lengths, false);
    TestCrown bad = ball(2, 1);
    std::vector<TestCrown> broken(5, bad);
    broken[0].radius = NAN;
    broken[1].alpha_rho = INFINITY;
    broken[2].centre.x = INFINITY;
    broken[3].radius = 0;
    broken[3].radii = glm::dvec3(0);
    broken[4].alpha_rho = broken[4].extinction = -1;
    add("crowns of no or infinite size and density", broken, garbage(5), false);
  }

  /// V rises where foliage gets thinner, and by the caps' models along the normal out of the crown.
  void add_orders() {
    std::vector<TestCrown> crowns;
    std::vector<TestFragment> fragments;
    std::vector<std::vector<std::size_t>> orders;
    for (int power = 30; power >= -30; --power) crowns.push_back(ball(2, std::pow(10.0, power * 0.25)));
    for (std::size_t i = 0; i < 40; ++i) {
      Random random = case_random("order", i);
      const glm::vec3 p = 2.0f * static_cast<float>(std::cbrt(random.uniform())) * random_direction(random);
      const glm::vec3 n = random_direction(random);
      orders.emplace_back();
      for (std::uint32_t crown = 0; crown < crowns.size(); ++crown) {
        orders.back().push_back(fragments.size());
        fragments.push_back(fragment(p, n, crown + 1));
      }
    }
    for (std::size_t i = 0; i < 40 && method_.rises_along_normal; ++i) {
      Random random = case_random("line", i);
      const float off = static_cast<float>(random.uniform(0, 2));
      orders.emplace_back();
      for (int step = -40; step <= 40; ++step) {
        orders.back().push_back(fragments.size());
        fragments.push_back(
            fragment({off, 0, 0.05f * static_cast<float>(step)}, {0, 0, 1}, static_cast<std::uint32_t>(20 + i)));
      }
    }
    // Densities up to 3e7 / R^3: no longer the normal domain.
    add("rising with thinner foliage, caps along the normal too", crowns, fragments).rising = orders;
  }

  std::vector<StabilityCase> all;

 private:
  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
  }

  CrownMethod method_;
  std::size_t samples_;
};

}  // namespace

std::vector<StabilityCase> crown_cases(const CrownMethod& method, std::size_t samples) {
  CrownCases cases(method, samples);
  cases.add_sizes_and_densities();
  cases.add_places();
  cases.add_garbage();
  if (method.rises_as_foliage_thins) cases.add_orders();
  return std::move(cases.all);
}

}  // namespace understory
