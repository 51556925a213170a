#include "bench/tradeoff_times.hpp"

#include <fmt/format.h>

#include "host/frame/resolved_planes.hpp"

namespace understory {
namespace {

constexpr const char* resolve = "resolve";  // as the plan names it

}  // namespace

SharedResolve::SharedResolve(const World& world, const std::map<std::string, VariantRecord>& records) : world_(world) {
  std::map<std::string, std::vector<double>> samples;
  for (const auto& [name, record] : records) {
    const auto found = record.samples.pass_ms.find(resolve);
    if (!record.row.verified || found == record.samples.pass_ms.end()) continue;
    std::vector<double>& all = samples[kind_of(record.row.variant)];
    all.insert(all.end(), found->second.begin(), found->second.end());
  }
  for (const auto& [kind, all] : samples) spreads_[kind] = spread_of(all);
}

std::string SharedResolve::kind_of(const Variant& variant) const {
  const ResolvedPlanes planes = resolved_planes(make_plan(world_, variant.methods));
  return fmt::format("{} {} {} {} {} {}", variant.shrink, variant.relaxed_maths, guard_band(variant.methods),
                     planes.grass_height, planes.rest_point, planes.texel);
}

std::vector<double> SharedResolve::device_ms(const VariantRecord& record) const {
  std::vector<double> samples = record.samples.device_ms;
  const auto own = record.samples.pass_ms.find(resolve);
  if (own == record.samples.pass_ms.end()) return samples;
  const double shared = resolve_ms(record.row.variant).median;
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += shared - own->second.at(i);
  return samples;
}

}  // namespace understory
