// What a combination of terms will cost and err, from its terms measured one by one: times of passes add up, and V is
// the product of its terms (kernels/combine.cl), so that the errors of thousands of combinations follow from the planes
// of a few dozen terms at the judged pixels.
#pragma once
#include <vector>

#include "bench/tradeoff_judge.hpp"
#include "bench/tradeoff_variants.hpp"

namespace understory {

/// A term, or the bare variant that all terms are added to, as measured alone.
struct MeasuredTerm {
  Axis axis = Axis::tree;
  Variant variant;
  JudgedValues values;
  double ms = 0;  // of the resolve and all visibility passes
};

/// One choice on each axis; -1: none. Indices are positions in the model's terms.
struct Combination {
  int tree = -1, grass = -1, crowns = -1, occluders = -1, near = -1;
  bool near_is_limit = false;  // combine: minimum
  double ms = 0, rmse = 0;     // predicted; the truth's noise taken out
};

class TradeoffModel {
 public:
  /// `truth`, one entry a judged pixel, and its mean variance. All terms are of one image size, `bare`'s.
  TradeoffModel(std::vector<float> truth, double truth_variance, MeasuredTerm bare, std::vector<MeasuredTerm> terms);

  /// Every combination.
  std::vector<Combination> predict() const;
  Variant variant_of(const Combination& combination) const;

 private:
  using Values = std::vector<float>;
  std::vector<int> choices(Axis axis) const;
  Values own(int tree, int grass) const;
  Values shading(int crowns, int occluders) const;
  const Values* term_plane(int term, const std::string& method) const;
  double milliseconds(int term) const;
  void add_near(Combination combination, const Values& far, std::vector<Combination>& all) const;

  Values truth_;
  double truth_variance_;
  MeasuredTerm bare_;
  std::vector<MeasuredTerm> terms_;
};

/// The fastest, the most accurate, and at most `count` in all of those that no other beats in both; of ones that differ
/// little in error the fastest. In order of time.
std::vector<Combination> predicted_front(std::vector<Combination> all, int count);

}  // namespace understory
