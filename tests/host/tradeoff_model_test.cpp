// Combinations predicted from terms, against the rule of combining written out here, on made-up planes.
#include "bench/tradeoff_model.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace understory {
namespace {

using Values = std::vector<float>;

// Pixels: two of a tree, one of grass, one of the ground, one of the background.
const std::vector<JudgedClass> classes = {JudgedClass::tree, JudgedClass::tree, JudgedClass::grass, JudgedClass::ground,
                                          JudgedClass::background};
const Values truth = {0.30f, 0.50f, 0.40f, 0.70f, 1.00f};
const Values dome = {0.90f, 0.80f, 0.95f, 1.00f, 1.00f};

MeasuredTerm term(Axis axis, double ms, const std::string& method, const Values& visibility, const Values& plane) {
  MeasuredTerm term;
  term.axis = axis;
  Methods& methods = term.variant.methods;
  methods.tree = methods.grass = methods.crowns = methods.occluders = methods.near = "none";
  if (axis == Axis::tree) methods.tree = method;
  if (axis == Axis::grass) methods.grass = method;
  if (axis == Axis::crowns || axis == Axis::crowns_occluders) methods.crowns = method;
  if (axis == Axis::occluders || axis == Axis::crowns_occluders) methods.occluders = method;
  if (axis == Axis::near) methods.near = method;
  term.ms = ms;
  term.values.visibility = visibility;
  term.values.classes = classes;
  if (!plane.empty()) term.values.terms[method] = plane;
  return term;
}

Values product(const Values& a, const Values& b) {
  Values result = a;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] *= b[i];
  return result;
}

const Values cap = {0.5f, 0.6f, 1, 1, 1};          // own term of a crown
const Values layer = {0.7f, 0.9f, 0.5f, 0.6f, 1};  // grass and all that stands in it
const Values crowns = {0.8f, 1, 0.9f, 0.7f, 0.2f};
const Values bodies = {1, 0.9f, 0.6f, 0.5f, 0.2f};
const Values near_plane = {0.4f, 0.3f, 0.9f, 0.2f, 0.1f};

TradeoffModel small_model() {
  MeasuredTerm bare = term(Axis::tree, 1, "none", dome, {});
  std::vector<MeasuredTerm> terms;
  terms.push_back(term(Axis::tree, 1.5, "sphere-cap", product(dome, cap), cap));
  terms.push_back(term(Axis::grass, 1.25, "grass-transmittance", product(dome, layer), layer));
  terms.push_back(term(Axis::crowns, 3, "solid-angle", product(dome, crowns), crowns));
  terms.push_back(term(Axis::occluders, 4, "solid-angle", product(dome, bodies), bodies));
  terms.push_back(term(Axis::crowns_occluders, 4.5, "solid-angle", product(dome, product(crowns, bodies)),
                       product(crowns, bodies)));
  terms.push_back(term(Axis::near, 6, "obscurance-line", product(dome, near_plane), near_plane));
  return {truth, 0.0004, bare, terms};
}

const Combination& find(const std::vector<Combination>& all, const TradeoffModel& model, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return model.variant_of(one).name() == name; });
  if (found == all.end()) throw std::runtime_error("not predicted: " + name);
  return *found;
}

double rmse_of(const Values& values) {
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) squares += std::pow(double(values[i]) - double(truth[i]), 2);
  return std::sqrt(std::max(0.0, squares / static_cast<double>(values.size()) - 0.0004));
}

TEST(TradeoffModel, PredictsEveryCombinationOnce) {
  const TradeoffModel model = small_model();
  const std::vector<Combination> all = model.predict();
  std::set<std::string> names;
  for (const Combination& one : all) names.insert(model.variant_of(one).name());
  EXPECT_EQ(all.size(), 2u * 2 * 2 * 2 * 3);  // the near field in two ways
  EXPECT_EQ(names.size(), all.size());
}

TEST(TradeoffModel, MultipliesTermsAndAddsTimes) {
  const TradeoffModel model = small_model();
  const std::vector<Combination> all = model.predict();
  const Combination& bare = find(all, model, "open sky only");
  EXPECT_DOUBLE_EQ(bare.ms, 1);
  EXPECT_NEAR(bare.rmse, rmse_of(dome), 1e-6);

  const Combination& own = find(all, model, "tree sphere-cap, grass-transmittance");
  EXPECT_DOUBLE_EQ(own.ms, 1 + 0.5 + 0.25);
  EXPECT_NEAR(own.rmse, rmse_of(product(product(dome, cap), layer)), 1e-6);
}

TEST(TradeoffModel, CountsTheSharedPassOfCrownsAndOccludersOnceAndKeepsTheBackgroundOpen) {
  const TradeoffModel model = small_model();
  const std::vector<Combination> all = model.predict();
  Values expected = product(dome, product(crowns, bodies));
  expected[4] = 1;
  const Combination& shaded = find(all, model, "crowns and occluders solid-angle");
  EXPECT_DOUBLE_EQ(shaded.ms, 4.5);
  EXPECT_NEAR(shaded.rmse, rmse_of(expected), 1e-6);
  EXPECT_DOUBLE_EQ(find(all, model, "crowns solid-angle").ms, 3);
}

TEST(TradeoffModel, TakesTheNearFieldAsFactorAndAsLimit) {
  const TradeoffModel model = small_model();
  const std::vector<Combination> all = model.predict();
  Values factor = product(dome, near_plane), limit = dome;
  for (std::size_t i = 0; i < 4; ++i) limit[i] = std::min(limit[i], near_plane[i]);
  factor[4] = 1;
  EXPECT_NEAR(find(all, model, "obscurance-line 5 product").rmse, rmse_of(factor), 1e-6);
  EXPECT_NEAR(find(all, model, "obscurance-line 5 minimum").rmse, rmse_of(limit), 1e-6);
}

TEST(PredictedFront, IsShortAndNobodyOnItIsBeaten) {
  const std::vector<Combination> all = small_model().predict();
  const std::vector<Combination> whole = predicted_front(all, 1000), few = predicted_front(all, 3);
  for (const Combination& one : whole)
    for (const Combination& other : all)
      EXPECT_FALSE(other.ms <= one.ms && other.rmse <= one.rmse && (other.ms < one.ms || other.rmse < one.rmse));
  EXPECT_LE(few.size(), 3u);
  EXPECT_EQ(few.front().ms, whole.front().ms);
  EXPECT_EQ(few.back().rmse, whole.back().rmse);
}

}  // namespace
}  // namespace understory
