// What has been measured of each variant, a file a variant in a folder, so that a tradeoff that was stopped or killed
// goes on where it was.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "bench/tradeoff_judge.hpp"

namespace understory {

/// All that one variant's measuring leaves.
struct VariantRecord {
  TradeoffRow row;         // times not yet in it; no prediction, front, ties
  ShadingSamples samples;  // of all sweeps together
  int sweeps = 0;
  JudgedValues values;
};

class TradeoffStore {
 public:
  /// Keeps files in `folder` (made when the first is written); empty: keeps nothing. `identity` is written into each.
  TradeoffStore(std::filesystem::path folder, std::string identity);

  /// Nothing when there is no whole file of that variant and identity.
  std::optional<VariantRecord> load(const std::string& variant_name) const;
  /// Whole or not at all. Throws Error(input_output).
  void save(const VariantRecord& record) const;

 private:
  std::filesystem::path file_of(const std::string& variant_name) const;
  std::filesystem::path folder_;
  std::string identity_;
};

/// The name with what file systems dislike as underscores; names of other variants give other file names.
std::string variant_file_name(const std::string& variant_name, const std::string& extension);

}  // namespace understory
