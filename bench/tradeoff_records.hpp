// The records of the variants that have been measured: each is measured once, kept at once, and timed again on demand.
#pragma once
#include <map>
#include <set>
#include <string>

#include "bench/tradeoff_judge.hpp"
#include "bench/tradeoff_store.hpp"

namespace understory {

class VariantRecords {
 public:
  /// `image`: the scene's size. All of these must outlive the records.
  VariantRecords(Device& device, TradeoffJudge& judge, const TradeoffOptions& options, const ImageSize& image);

  /// The variant's record: from before, from the store, or measured now; verified before it is timed.
  VariantRecord& measured(const Variant& variant);
  /// Adds its error in time, if that is not known yet and wanted: not with runnable_only, whose judge lacks the truth.
  void judge_in_time(VariantRecord& record);
  /// Times it so often once more.
  void time_once_more(VariantRecord& record);

  /// By name.
  const std::map<std::string, VariantRecord>& all() const { return records_; }
  VariantRecord& at(const std::string& name) { return records_.at(name); }

 private:
  void measure(VariantRecord& record);

  Device& device_;
  TradeoffJudge& judge_;
  const TradeoffOptions& options_;
  const ImageSize image_;
  TradeoffStore store_;
  std::map<std::string, VariantRecord> records_;
  std::set<std::string> baked_;  // what bakes have been timed for
};

}  // namespace understory
