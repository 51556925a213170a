#include "host/app/bench_print.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace understory {
namespace {

/// "12.3 M", for rates.
std::string rate_text(double per_second) {
  if (per_second <= 0) return "";
  if (per_second >= 1e9) return fmt::format("{:.2f} G", per_second * 1e-9);
  if (per_second >= 1e6) return fmt::format("{:.1f} M", per_second * 1e-6);
  return fmt::format("{:.1f}  ", per_second);
}

/// A column that may be unknown.
std::string known(double value, int digits) { return value > 0 ? fmt::format("{:.{}f}", value, digits) : ""; }

std::string interval_text(double low, double high) { return high > 0 ? fmt::format("{:.3f}-{:.3f}", low, high) : ""; }

std::string result_text(const BenchResult& result) {
  if (!result.verified) return fmt::format("{:46} WRONG: deviates by {:.3g}\n", result.name, result.max_error);
  const double share = result.roof_share;
  return fmt::format("{:46}{:9.3f}{}{:>16}{:>9}{:>11}/s{:>8}{:>9}{:>8}{:>6} {:10}{:>5}\n", result.name,
                     result.median_ms, result.noisy ? '~' : ' ', interval_text(result.low_ms, result.high_ms),
                     known(result.wall_ms, 3), rate_text(result.items_per_s), known(result.bytes_per_s * 1e-9, 1),
                     known(result.flop_per_s * 1e-9, 1), known(result.operations_per_byte, 2), known(share, 2),
                     result.bound_by, result.runs > 0 ? std::to_string(result.runs) : "");
}

std::string builds_text(const BenchReport& report) {
  std::string text =
      fmt::format("\n{:46}{:>12}{:>12}{:>12}{:>12}\n", "ms", "cold build", "+ 1st run", "warm build", "+ 1st run");
  bool any = false;
  for (const BenchResult& result : report.results) {
    if (!result.cold && !result.warm) continue;
    any = true;
    const BuildTimes cold = result.cold.value_or(BuildTimes{}), warm = result.warm.value_or(BuildTimes{});
    text += fmt::format("{:46}{:12.1f}{:12.1f}{:12.1f}{:12.1f}\n", result.name, cold.build_ms, cold.first_launch_ms,
                        warm.build_ms, warm.first_launch_ms);
  }
  return any ? text : "";
}

std::string reasons_text(const BenchReport& report) {
  std::string text;
  for (const BenchResult& result : report.results) {
    if (!result.streams || result.roof_share <= 0) continue;
    if (text.empty()) text = "\nkernels that stream, beside a kernel that only moves as many planes (bar: 0.80)\n";
    const double share = result.shares.contains("memory") ? result.shares.at("memory") : 0;
    text += fmt::format("  {:44}{:6.2f}{}\n", result.name, share, share < 0.8 ? "  below the bar" : "");
  }
  bool first = true;
  for (const BenchResult& result : report.results) {
    if (result.roof_share <= 0 || result.rest.empty()) continue;
    if (first) text += "\nwhat keeps the others from their roofs\n";
    first = false;
    std::string shares;
    for (const auto& [roof, share] : result.shares) shares += fmt::format("{} {:.2f}, ", roof, share);
    text += fmt::format("  {}: {}{}\n", result.name, shares, result.rest);
  }
  return text;
}

}  // namespace

std::string bench_text(const BenchReport& report, double precision) {
  const DeviceInfo& device = report.device;
  std::string text = fmt::format(
      "{} ({}, {})\n  {} compute units, {} MiB, largest buffer {} MiB, largest group {}, {} float lanes{}\n",
      device.name, device.platform, device.version, device.compute_units, device.memory_mib, device.max_allocation_mib,
      device.max_group, device.vector_width, device.atomic64 ? "" : ", no 64-bit atomics");
  if (!report.energy.empty()) text += fmt::format("  energy: {}\n", report.energy);
  for (const auto& [roof, value] : report.roofs) text += fmt::format("  {:28}{:9.2f}\n", roof, value);
  text += fmt::format("{:46}{:>9} {:>16}{:>9}{:>13}{:>8}{:>9}{:>8}{:>6} {:10}{:>5}\n", "", "median ms", "95 %",
                      "wall ms", "items", "GB/s", "GFLOP/s", "flop/B", "roof", "bound by", "runs");
  for (const BenchResult& result : report.results) text += result_text(result);
  const auto has_energy = [](const BenchResult& r) { return r.joules_per_item > 0; };
  if (std::any_of(report.results.begin(), report.results.end(), has_energy)) {
    text += "\nnanojoules per item, whole package\n";
    for (const BenchResult& result : report.results)
      if (has_energy(result)) text += fmt::format("  {:44}{:9.2f}\n", result.name, 1e9 * result.joules_per_item);
  }
  text += builds_text(report) + reasons_text(report);
  const auto noisy = std::count_if(report.results.begin(), report.results.end(), [](const auto& r) { return r.noisy; });
  if (noisy > 0)
    text += fmt::format("\n~ {} of {} intervals stayed wider than +-{:.1f} %: the machine was too noisy for them\n",
                        noisy, report.results.size(), 100 * precision);
  return text;
}

std::string side_by_side_text(const std::vector<BenchReport>& reports) {
  std::string text = fmt::format("\n{:46}", "median ms");
  for (const BenchReport& report : reports) text += fmt::format("{:>28}", report.device.platform.substr(0, 26));
  text += "   first/last\n";
  const auto ms_of = [](const BenchReport& report, const std::string& name) {
    for (const BenchResult& result : report.results)
      if (result.name == name && result.verified) return result.median_ms;
    return 0.0;
  };
  for (const BenchResult& result : reports.front().results) {
    text += fmt::format("{:46}", result.name);
    for (const BenchReport& report : reports) text += fmt::format("{:>28}", known(ms_of(report, result.name), 3));
    const double last = ms_of(reports.back(), result.name);
    text += fmt::format("{:>13}\n", last > 0 ? known(ms_of(reports.front(), result.name) / last, 2) : "");
  }
  return text;
}

std::string changes_text(const std::vector<BenchChange>& changes) {
  std::string text = fmt::format("\n{:46}{:>9}{:>9}{:>8}{:>16}\n", "", "then ms", "now ms", "ratio", "95 %");
  std::map<std::string, int> counts;
  for (const BenchChange& change : changes) {
    text +=
        fmt::format("{:46}{:9.3f}{:9.3f}{:8.2f}{:>16} {}\n", change.name, change.old_ms, change.new_ms, change.ratio,
                    fmt::format("{:.2f}-{:.2f}", change.low, change.high), verdict_name(change.verdict));
    ++counts[verdict_name(change.verdict)];
  }
  for (const char* verdict : {"faster", "slower", "same", "undecided"})
    text += fmt::format("{}{} {}", verdict == std::string("faster") ? "" : ", ", counts[verdict], verdict);
  return text + "\n";
}

std::string bench_csv(const std::vector<BenchReport>& reports) {
  std::string text =
      "device,name,item,items,median_ms,low_ms,high_ms,wall_ms,wall_low_ms,wall_high_ms,runs,noisy,cold_ms,"
      "cold_build_ms,cold_first_launch_ms,warm_build_ms,warm_first_launch_ms,items_per_s,bytes_per_s,flop_per_s,"
      "operations_per_byte,roof_share,bound_by,memory_share,joules_per_item,max_error,verified\n";
  const auto number = [](double value) { return value > 0 ? fmt::format("{:.6g}", value) : std::string(); };
  for (const BenchReport& report : reports)
    for (const BenchResult& r : report.results) {
      const auto build = [&](const std::optional<BuildTimes>& times) {
        return times ? fmt::format("{:.6g},{:.6g}", times->build_ms, times->first_launch_ms) : std::string(",");
      };
      const double memory = r.shares.contains("memory") ? r.shares.at("memory") : 0;
      text +=
          fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                      report.device.name, r.name, r.item, number(r.items), number(r.median_ms), number(r.low_ms),
                      number(r.high_ms), number(r.wall_ms), number(r.wall_low_ms), number(r.wall_high_ms), r.runs,
                      r.noisy, number(r.cold_ms), build(r.cold), build(r.warm), number(r.items_per_s),
                      number(r.bytes_per_s), number(r.flop_per_s), number(r.operations_per_byte), number(r.roof_share),
                      r.bound_by, number(memory), number(r.joules_per_item), r.max_error, r.verified);
    }
  return text;
}

}  // namespace understory
