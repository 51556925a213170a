// The table of what kernels cost (bench/kernel_costs.hpp) against the loads, stores and float instructions that
// oclgrind counts while `understory bench --builds` runs each kernel once.
#include <map>
#include <regex>
#include <sstream>

#include "bench/kernel_costs.hpp"
#include "tests/program/program.hpp"

namespace understory {
namespace {

/// Of one kernel case, all its launches together.
struct Counted {
  double loads = 0, bytes_loaded = 0, bytes_stored = 0, operations = 0, atomics = 0;
};

/// An instruction's weight as a float operation. Vectors do not occur: oclgrind's device has one lane.
double operations_of(const std::string& instruction) {
  static const std::regex one("f(add|sub|mul|div)|call _Z\\d+(native_)?r?sqrt.*");
  if (std::regex_match(instruction, one)) return 1;
  return instruction.starts_with("call _Z3fma") ? 2 : 0;
}

void count(const std::string& line, Counted& counted) {
  static const std::regex row(" *(\\d+) - ([^(]*)(\\((\\d+) bytes\\))?.*");
  std::smatch match;
  if (!std::regex_match(line, match, row)) return;
  const double times = std::stod(match[1]), bytes = match[4].matched ? std::stod(match[4]) : 0;
  const std::string instruction = match[2].str().substr(0, match[2].str().find_last_not_of(' ') + 1);
  if (instruction == "load global") {
    counted.loads += times;
    counted.bytes_loaded += bytes;
  }
  if (instruction == "store global") counted.bytes_stored += bytes;
  if (instruction.starts_with("call _Z8atom_min") || instruction.starts_with("call _Z10atomic_min"))
    counted.atomics += times;
  counted.operations += times * operations_of(instruction);
}

/// By kernel; what was printed since the kernel before, whose row ends its counts.
std::map<std::string, std::pair<Counted, double>> counts_of(const std::string& out) {
  std::map<std::string, std::pair<Counted, double>> all;
  Counted counted;
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("{")) {
      count(line, counted);
      continue;
    }
    const auto row = nlohmann::json::parse(line);
    if (row.contains("items")) all[row.at("name")] = {counted, row.at("items")};
    counted = {};  // what ran before the row that says "built" only prepared the kernel's data
  }
  return all;
}

/// What oclgrind takes minutes for, and grass, whose blades come in groups that a small picture does not fill. Their
/// operations, which depend on what shades what, were counted by the same command.
bool is_too_slow(std::string_view kernel) {
  return kernel.starts_with("solid-angle") || kernel.starts_with("grid") || kernel == "obscurance-area" ||
         kernel == "obscurance-point" || kernel == "rasterise-grass";
}

TEST(KernelCosts, AreWhatOclgrindCounts) {
  for (const KernelCost& cost : kernel_costs()) {
    if (is_too_slow(cost.kernel)) continue;
    const std::string name = "kernel/" + std::string(cost.kernel);
    const FinishedProcess bench = run_process(
        {"oclgrind", "--inst-counts", "--build-options", "-O0", program_path, "bench", "--builds", "--filter", name},
        {"UNDERSTORY_TUNING=none"});
    ASSERT_EQ(bench.exit_code, 0) << name << bench.err;
    const auto all = counts_of(bench.out);
    ASSERT_TRUE(all.contains(name)) << bench.out;
    const auto& [counted, items] = all.at(name);
    // What shades what, and how many pixels are drawn, differs a little with the size of the picture.
    EXPECT_NEAR(counted.operations / items, cost.operations, 0.1 * cost.operations + 0.01) << name;
    EXPECT_NEAR(counted.atomics / items, cost.atomics, 0.1 * cost.atomics) << name;
    // Validity codes are written where there are any: more often at the borders of a small picture.
    EXPECT_GE(counted.bytes_stored / items, 0.95 * cost.written) << name;
    EXPECT_LE(counted.bytes_stored / items, 1.05 * cost.written + 4) << name;
    // The rest of what is loaded comes from tables and neighbours, that is out of caches.
    EXPECT_LE(cost.read, 1.05 * counted.bytes_loaded / items) << name;
    EXPECT_LE(cost.gathers, 1.05 * counted.loads / items) << name;
  }
}

}  // namespace
}  // namespace understory
