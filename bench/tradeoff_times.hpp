// Device times of variants in which the same work counts the same: the resolve, most of the time of a small scene, does
// not depend on the methods but for the planes it writes. Timed apart for each variant, its scatter would hide what the
// methods cost; so the median over all variants that resolve alike stands for each of them.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "bench/tradeoff_store.hpp"

namespace understory {

class SharedResolve {
 public:
  /// `records`: by name; those that are not verified do not count. `world`: the scene's.
  SharedResolve(const World& world, const std::map<std::string, VariantRecord>& records);

  /// The variant's samples of device time, ms, with that median in the place of what its own resolve took.
  std::vector<double> device_ms(const VariantRecord& record) const;
  /// Of that, with its interval; the variant must be one of the records.
  Spread95 resolve_ms(const Variant& variant) const { return spreads_.at(kind_of(variant)); }

 private:
  std::string kind_of(const Variant& variant) const;

  const World& world_;
  std::map<std::string, Spread95> spreads_;  // ms, by kind_of
};

}  // namespace understory
