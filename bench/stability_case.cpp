#include "bench/stability_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace understory {
namespace {

/// One unit in the last place of a float as large as `value`.
double unit_of(double value) {
  const auto size = static_cast<float>(std::abs(value));
  return std::min(static_cast<double>(std::nextafter(size, std::numeric_limits<float>::infinity())),
                  static_cast<double>(std::numeric_limits<float>::max())) -
         static_cast<double>(size);
}

/// The larger change of V when `number` of the fragment moves by `step` up and down.
double effect_of(const FragmentModel& model, const ExactFragment& at, double& (*number)(ExactFragment&, int), int axis,
                 double step) {
  double largest = 0;
  for (const double side : {-1.0, 1.0}) {
    ExactFragment moved = at;
    number(moved, axis) += side * step;
    largest = std::max(largest, std::abs(model.exact(moved) - model.exact(at)));
  }
  return largest;
}

/// Components move by one unit in the last place of the largest: sums and rotations round to that.
double last_place_of(const FragmentModel& model, const ExactFragment& at) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto largest = [](glm::dvec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    sum += effect_of(
        model, at, [](ExactFragment& f, int k) -> double& { return f.position[k]; }, axis,
        unit_of(largest(at.position)));
    sum += effect_of(
        model, at, [](ExactFragment& f, int k) -> double& { return f.normal[k]; }, axis, unit_of(largest(at.normal)));
  }
  sum += effect_of(
      model, at, [](ExactFragment& f, int) -> double& { return f.height; }, 0, unit_of(at.height));
  sum += effect_of(
      model, at, [](ExactFragment& f, int) -> double& { return f.blade_length; }, 0, unit_of(at.blade_length));
  return std::min(sum, 1.0);
}

}  // namespace

ExactFragment::ExactFragment(const TestFragment& f)
    : position(f.position),
      normal(f.normal),
      height(static_cast<double>(f.height)),
      blade_length(static_cast<double>(f.blade_length)),
      owner(f.owner) {}

StabilityCase fragment_case(const std::string& kernel, const std::string& name, std::vector<TestFragment> fragments,
                            const FragmentModel& model, std::size_t apart) {
  StabilityCase one;
  one.kernel = kernel;
  one.name = name;
  const auto all = std::make_shared<const std::vector<TestFragment>>(std::move(fragments));
  one.shade = [all, model, apart](Device& device) {
    TestFragment background;
    background.validity = validity::background;
    std::vector<TestFragment> spread(apart * all->size(), background);
    for (std::size_t i = 0; i < all->size(); ++i) spread[apart * i] = (*all)[i];
    FragmentPlanes planes = upload_fragments(device, spread);
    Buffer<float> visibility(device, planes.padded_fragments, "visibility");
    model.shade(device, planes, visibility);
    const std::vector<float> v = visibility.read();
    const std::vector<std::uint32_t> codes = planes.validity.read();
    Shaded shaded;
    for (std::size_t i = 0; i < all->size(); ++i) {
      shaded.visibility.push_back(v[apart * i]);
      shaded.validity.push_back(codes[apart * i]);
    }
    return shaded;
  };
  if (!model.exact) return one;
  one.exact = [all, model](std::size_t i) { return model.exact(ExactFragment((*all)[i])); };
  one.last_place = [all, model](std::size_t i) { return last_place_of(model, ExactFragment((*all)[i])); };
  return one;
}

std::vector<glm::vec3> stability_directions(std::size_t by_chance) {
  std::vector<glm::vec3> all;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) all.push_back(glm::vec3(glm::normalize(glm::dvec3(x, y, z))));
  for (std::size_t i = 0; i < by_chance; ++i) {
    Random random = case_random("direction", i);
    all.push_back(random_direction(random));
  }
  return all;
}

}  // namespace understory
