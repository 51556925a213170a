// What one item of each benchmarked kernel costs at least: the one description that `understory bench` judges speeds by
// and that tests/program/kernel_costs_test.cpp compares with the instructions that oclgrind counts.
#pragma once
#include <span>
#include <string_view>

namespace understory {

/// Per item, as the bench's own data (bench/fragments.hpp, bench/geometry_cases.cpp, bench/foliage_cases.cpp,
/// bench/image_cases.cpp) ask for it.
struct KernelCost {
  std::string_view kernel;  // as in the bench's rows, without kernel/
  std::string_view item;    // fragment, vertex, blade, triangle
  double read = 0;          // bytes that have to come from memory however well caches work; tables stay in caches
  double written = 0;       // the same to memory
  double operations = 0;    // of float: add, multiply, divide, root 1, fma 2; comparisons and selections none
  double exponentials = 0;  // exp_minus, whose arithmetic is in `operations` too
  double gathers = 0;       // loads at computed places, most of them per lane
  double atomics = 0;
  bool streams = false;   // held to 0.8 of its memory roof at 4 Mi items and more
  std::string_view rest;  // why it stays below its nearest roof; empty for those that reach it
};

std::span<const KernelCost> kernel_costs();

/// Throws Error(unexpected) naming a kernel that is not in the table.
const KernelCost& cost_of(std::string_view kernel);

}  // namespace understory
