// Energy of the processor package from RAPL's counters, as Linux shows them below /sys/class/powercap.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace understory {

class EnergyMeter {
 public:
  /// Looks for package counters (intel-rapl:N, which AMD processors have too) in `powercap`.
  explicit EnergyMeter(const std::filesystem::path& powercap);

  bool readable() const { return !counters_.empty(); }
  /// Which counters are read, or why there are none.
  const std::string& description() const { return description_; }
  void start();
  /// Joules of all packages since start(), one wrap of a counter allowed; 0 when not readable.
  double joules() const;

 private:
  struct Counter {
    std::filesystem::path file;  // microjoules
    std::uint64_t range = 0;     // where it wraps
    std::uint64_t before = 0;
  };
  std::vector<Counter> counters_;
  std::string description_;
};

}  // namespace understory
