#include "bench/place_regression.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/error.hpp"

namespace understory {
namespace {

constexpr std::size_t neighbours = 32;

}  // namespace

std::vector<float> best_of_place(std::span<const glm::dvec2> places, std::span<const float> truth) {
  if (places.size() != truth.size()) throw Error(ErrorKind::unexpected, "best of place: one truth value a place");
  std::vector<float> best(truth.begin(), truth.end());
  if (places.size() <= neighbours) return best;
  tbb::parallel_for(std::size_t(0), places.size(), [&](std::size_t i) {
    std::vector<std::size_t> order(places.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::swap(order.front(), order[i]);
    const auto distance = [&](std::size_t k) { return glm::dot(places[k] - places[i], places[k] - places[i]); };
    std::nth_element(order.begin() + 1, order.begin() + neighbours, order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(distance(a), a) < std::pair(distance(b), b);
    });
    glm::dmat3 square(1e-12);  // neighbours may lie in one line
    glm::dvec3 product(0);
    for (std::size_t k = 1; k <= neighbours; ++k) {
      const glm::dvec3 terms(1, places[order[k]] - places[i]);
      square += glm::outerProduct(terms, terms);
      product += double(truth[order[k]]) * terms;
    }
    const glm::dvec3 weights = glm::inverse(square)[0];
    const double leverage = std::max(weights[0], 0.0), residual = glm::dot(weights, product) - double(truth[i]);
    best[i] = static_cast<float>(double(truth[i]) + residual / std::sqrt(1 + leverage));
  });
  return best;
}

}  // namespace understory
