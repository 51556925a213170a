// Nodes and weights of Gauss-Legendre quadrature on an interval.
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

namespace understory {

struct GaussNode {
  double at = 0, weight = 0;
};

/// `count` nodes on [low, high]: exact for polynomials of degree 2 count - 1. Newton's method on the Legendre
/// polynomial (Press et al., Numerical Recipes, section 4.6).
inline std::vector<GaussNode> gauss_nodes(int count, double low, double high) {
  std::vector<GaussNode> nodes;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double value = 1, below = 0;
      for (int j = 0; j < count; ++j) {
        const double before = below;
        below = value;
        value = ((2 * j + 1) * x * below - j * before) / (j + 1);
      }
      slope = count * (x * value - below) / (x * x - 1);
      const double move = value / slope;
      x -= move;
      if (std::abs(move) < 1e-15) break;
    }
    nodes.push_back({0.5 * (low + high) + 0.5 * (high - low) * x, (high - low) / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

}  // namespace understory
