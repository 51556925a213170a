// The judge of a tradeoff on a small meadow: its pixels, its errors without the truth's noise, its times and planes.
#include "bench/tradeoff_judge.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "bench/tradeoff_variants.hpp"
#include "host/trace/calibrated_world.hpp"
#include "tests/support/frames.hpp"

namespace understory {
namespace {

/// A small meadow with everything that can be judged, and the judge of two of its frames.
struct Judged {
  explicit Judged(int rays, bool following = false)
      : world(build_world(meadow_view())), judge(device, world, {{0, 3}, 400, rays, following}) {}
  Device device;
  World world;
  TradeoffJudge judge;
};

std::vector<float> truths(const TradeoffJudge& judge) {
  std::vector<float> all;
  for (const JudgedView& view : judge.views())
    all.insert(all.end(), view.truth.visibility.begin(), view.truth.visibility.end());
  return all;
}

TEST(TradeoffJudge, SeesEveryFrameWithBothCameras) {
  Judged judged(16);
  ASSERT_EQ(judged.judge.views().size(), 4u);
  for (const JudgedView& view : judged.judge.views()) {
    EXPECT_GT(view.pixels.size(), 100u);
    EXPECT_LE(view.pixels.size(), 400u);
    EXPECT_TRUE(std::is_sorted(view.pixels.begin(), view.pixels.end()));
    EXPECT_EQ(view.truth.visibility.size(), view.pixels.size());
    for (const JudgedClass one : view.classes) EXPECT_NE(one, JudgedClass::background);
  }
}

TEST(TradeoffJudge, GoesOnWithOtherFramesAndComesBack) {
  Judged judged(16);
  const std::vector<float> first = truths(judged.judge);
  judged.judge.choose({judged.world.scene.methods});
  const RmseInterval error = judged.judge.error(judged.judge.values().visibility);
  judged.judge.look_at({1});
  ASSERT_EQ(judged.judge.views().size(), 2u);
  for (const JudgedView& view : judged.judge.views()) EXPECT_EQ(view.frame, 1);
  Judged fresh(16);
  fresh.judge.look_at({1});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(judged.judge.views()[i].eye.position, fresh.judge.views()[i].eye.position) << i;
    EXPECT_EQ(judged.judge.views()[i].pixels, fresh.judge.views()[i].pixels) << i;
  }
  EXPECT_NE(truths(judged.judge), first);
  judged.judge.look_at({0, 3});
  EXPECT_EQ(truths(judged.judge), first);
  judged.judge.choose({judged.world.scene.methods});
  EXPECT_EQ(judged.judge.error(judged.judge.values().visibility).rmse, error.rmse);
}

TEST(TradeoffJudge, TakesTheNoiseOfTheTruthOutOfErrors) {
  Judged noisy(16), exact(2048);
  ASSERT_EQ(noisy.judge.views()[1].pixels, exact.judge.views()[1].pixels);
  std::vector<float> values = truths(exact.judge);
  const RmseInterval none = noisy.judge.error(values);
  EXPECT_GT(none.truth_noise, 0.03);
  EXPECT_LT(none.low, 0.012);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += i % 2 ? 0.1f : -0.1f;
  const RmseInterval known = noisy.judge.error(values);
  EXPECT_LT(known.low, 0.1);
  EXPECT_GT(known.high, 0.1);
  EXPECT_LT(known.high - known.low, 0.02);
}

TEST(TradeoffJudge, AddsClassesAndViewsUpToTheWhole) {
  Judged judged(32);
  const JudgedValues values = judged.judge.values();
  const RmseInterval all = judged.judge.error(values.visibility);
  double squares = 0, view_squares = 0;
  std::size_t pixels = 0;
  for (const auto& [name, error] : judged.judge.class_errors(values.visibility)) {
    squares += static_cast<double>(error.pixels) * error.rmse * error.rmse;
    pixels += error.pixels;
  }
  for (const ViewError& view : judged.judge.view_errors(values.visibility))
    view_squares += static_cast<double>(view.all.pixels) * view.all.rmse * view.all.rmse;
  EXPECT_EQ(pixels, all.pixels);
  EXPECT_NEAR(squares / static_cast<double>(pixels), all.rmse * all.rmse, 1e-9);
  EXPECT_NEAR(view_squares / static_cast<double>(pixels), all.rmse * all.rmse, 1e-9);
}

TEST(TradeoffJudge, SeesChangesInTimeThatTheTruthDoesNotHave) {
  Judged judged(256, true);
  const std::vector<float> visibility = truths(judged.judge);
  EXPECT_EQ(judged.judge.following().size(), visibility.size());
  std::vector<float> following;
  for (const JudgedView& view : judged.judge.views())
    following.insert(following.end(), view.following.visibility.begin(), view.following.visibility.end());
  const TemporalError none = judged.judge.temporal_error(visibility, following);
  EXPECT_EQ(none.rmse_dvdt, 0);
  EXPECT_LE(none.flicker, 0);
  EXPECT_GT(none.truth_dvdt, 0);
  for (float& v : following) v += 0.5f;
  const double per_second = meadow_view().time.frames_per_second;
  EXPECT_NEAR(judged.judge.temporal_error(visibility, following).rmse_dvdt, 0.5 * per_second, 0.02 * per_second);
}

TEST(TradeoffJudge, TimesTheResolveAndWhatFollowsIt) {
  Judged judged(16);
  Variant variant = bare_variant(judged.world.scene);
  variant.methods.tree = "sphere-cap";
  judged.judge.choose(variant);
  const ShadingSamples samples = judged.judge.time(3);
  EXPECT_GT(samples.draw_ms, 0);
  ASSERT_EQ(samples.device_ms.size(), 3u);
  for (const char* pass : {"resolve", "sphere-cap", "combine"}) EXPECT_TRUE(samples.pass_ms.contains(pass)) << pass;
  for (const auto& [pass, milliseconds] : samples.pass_ms)
    EXPECT_FALSE(pass.starts_with("pose_") || pass.starts_with("draw_") || pass.starts_with("rasterise")) << pass;
  for (std::size_t round = 0; round < 3; ++round) {
    double sum = 0;
    for (const auto& [pass, milliseconds] : samples.pass_ms) sum += milliseconds[round];
    EXPECT_NEAR(samples.device_ms[round], sum, 1e-9);
    EXPECT_GE(samples.wall_ms[round], samples.device_ms[round]);
  }
}

TEST(TradeoffJudge, FindsTheScenesPixelsInASmallerImage) {
  Judged judged(16);
  Variant variant = bare_variant(judged.world.scene);
  const std::vector<JudgedClass> full = judged.judge.values().classes;
  variant.shrink = 2;
  judged.judge.choose(variant);
  const std::vector<JudgedClass> half = judged.judge.values().classes;
  ASSERT_EQ(full.size(), half.size());
  const auto same = std::inner_product(full.begin(), full.end(), half.begin(), 0, std::plus(), std::equal_to());
  EXPECT_GT(same, static_cast<int>(full.size()) * 8 / 10);
}

TEST(TradeoffJudge, LeavesTheWorldAsItWas) {
  World world = build_world(meadow_view());
  const Camera camera = world.scene.camera;
  {
    Device device;
    TradeoffJudge judge(device, world, {{0}, 100, 16, false});
    Variant variant = bare_variant(world.scene);
    variant.shrink = 2;
    judge.choose(variant);
    judge.values();
  }
  EXPECT_EQ(world.scene.camera.position, camera.position);
  EXPECT_EQ(world.scene.image.width, meadow_view().image.width);
}

TEST(Terms, AreThoseThatTheSceneHasSomethingFor) {
  Scene scene = meadow_view();
  const auto axes = [](const Scene& of) {
    std::set<Axis> found;
    for (const Term& term : terms_of(build_world(of))) found.insert(term.axis);
    return found;
  };
  EXPECT_EQ(axes(scene).size(), 6u);
  scene.occluders.clear();
  EXPECT_EQ(axes(scene), (std::set{Axis::tree, Axis::grass, Axis::crowns, Axis::near}));
  scene.grass.clear();
  scene.plants.clear();
  EXPECT_EQ(axes(scene), (std::set{Axis::near}));
  EXPECT_EQ(own_variant(build_world(scene)).name(), "open sky only");
}

TEST(Terms, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  const std::vector<Term> terms = terms_of(build_world(meadow_view()));
  for (const Term& term : terms) names.insert(term.variant.name());
  EXPECT_EQ(names.size(), terms.size());
}

}  // namespace
}  // namespace understory
