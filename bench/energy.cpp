#include "bench/energy.hpp"

#include <algorithm>
#include <fstream>
#include <optional>

namespace understory {
namespace fs = std::filesystem;
namespace {

std::optional<std::uint64_t> number_in(const fs::path& file) {
  std::ifstream stream(file);
  std::uint64_t value = 0;
  return stream >> value ? std::optional(value) : std::nullopt;
}

/// intel-rapl:0 is a package; intel-rapl:0:1 is part of one.
bool is_package(const std::string& name) {
  return name.starts_with("intel-rapl:") && std::count(name.begin(), name.end(), ':') == 1;
}

}  // namespace

EnergyMeter::EnergyMeter(const fs::path& powercap) {
  std::error_code error;
  std::string refused;
  for (const fs::directory_entry& entry : fs::directory_iterator(powercap, error)) {
    if (!is_package(entry.path().filename())) continue;
    const fs::path file = entry.path() / "energy_uj";
    const auto range = number_in(entry.path() / "max_energy_range_uj");
    if (range && number_in(file))
      counters_.push_back({file, *range, 0});
    else
      refused = file.string();
  }
  std::sort(counters_.begin(), counters_.end(), [](const Counter& a, const Counter& b) { return a.file < b.file; });
  if (!counters_.empty())
    description_ = "RAPL, " + std::to_string(counters_.size()) + " package" + (counters_.size() > 1 ? "s" : "");
  else if (!refused.empty())
    description_ = "not readable here: " + refused + " is for root alone";
  else
    description_ = "not readable here: no RAPL counters in " + powercap.string();
}

void EnergyMeter::start() {
  for (Counter& counter : counters_) counter.before = number_in(counter.file).value_or(counter.before);
}

double EnergyMeter::joules() const {
  double sum = 0;
  for (const Counter& counter : counters_) {
    const std::uint64_t now = number_in(counter.file).value_or(counter.before);
    const std::uint64_t used = now >= counter.before ? now - counter.before : now + counter.range - counter.before;
    sum += 1e-6 * static_cast<double>(used);
  }
  return sum;
}

}  // namespace understory
