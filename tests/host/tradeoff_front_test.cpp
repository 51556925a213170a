// Which rows of a tradeoff are on the front, and what its files hold: synthetic tables, no device.
#include <gmock/gmock.h>

#include <random>

#include "bench/tradeoff.hpp"
#include "bench/tradeoff_times.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Values with the same half-width on both sides.
TradeoffRow row(const std::string& name, double ms, double ms_reach, double rmse, double rmse_reach) {
  TradeoffRow row;
  row.name = name;
  row.verified = true;
  row.ms = {ms, ms - ms_reach, ms + ms_reach};
  row.error.pixels = 100;
  row.error.rmse = rmse;
  row.error.low = rmse - rmse_reach;
  row.error.high = rmse + rmse_reach;
  return row;
}

std::vector<std::string> front_of(std::vector<TradeoffRow>& rows) {
  mark_front(rows);
  std::vector<std::string> names;
  for (const TradeoffRow& one : rows)
    if (one.pareto) names.push_back(one.name);
  return names;
}

bool clearly_less(double a_high, double b_low) { return a_high < b_low; }

bool clearly_wins(const TradeoffRow& a, const TradeoffRow& b) {
  const bool faster = clearly_less(a.ms.high, b.ms.low), better = clearly_less(a.error.high, b.error.low);
  const bool slower = clearly_less(b.ms.high, a.ms.low), worse = clearly_less(b.error.high, a.error.low);
  return (faster && !worse) || (better && !slower);
}

TEST(Front, HoldsTheFastestTheBestAndNobodyWhoIsBeaten) {
  std::vector<TradeoffRow> rows = {row("fast", 1, 0.1, 0.3, 0.01), row("good", 9, 0.1, 0.1, 0.01),
                                   row("beaten", 9.5, 0.1, 0.3, 0.01), row("between", 4, 0.1, 0.2, 0.01)};
  EXPECT_THAT(front_of(rows), ElementsAre("fast", "good", "between"));
}

TEST(Front, HasNoWinnerBetweenOverlappingIntervals) {
  std::vector<TradeoffRow> rows = {row("a", 5, 1, 0.2, 0.02), row("b", 5.5, 1, 0.19, 0.02), row("c", 20, 1, 0.4, 0.02)};
  EXPECT_THAT(front_of(rows), ElementsAre("a", "b"));
  EXPECT_THAT(rows[0].ties, ElementsAre("b"));
  EXPECT_THAT(rows[1].ties, ElementsAre("a"));
  EXPECT_THAT(rows[2].ties, IsEmpty());
}

TEST(Front, DoesNotKeepWhatIsSlowerForNoClearGain) {
  std::vector<TradeoffRow> rows = {row("quick", 1, 0.1, 0.200, 0.01), row("slow", 30, 1, 0.199, 0.01)};
  EXPECT_THAT(front_of(rows), ElementsAre("quick"));
}

TEST(Front, HasRowsThatWereVerifiedOnly) {
  std::vector<TradeoffRow> rows = {row("right", 5, 1, 0.2, 0.02), row("wrong", 0, 0, 0, 0)};
  rows[1].verified = false;
  EXPECT_THAT(front_of(rows), ElementsAre("right"));
  EXPECT_THAT(rows[0].ties, IsEmpty());
}

TEST(Front, IsNeverEmptyEvenWhenWideIntervalsBeatEachOtherInACircle) {
  std::vector<TradeoffRow> rows(4);
  const double ms[4][2] = {{2, 3}, {4, 5}, {6, 7}, {1, 8}},
               rmse[4][2] = {{0.7, 0.8}, {0.1, 0.9}, {0.2, 0.3}, {0.5, 0.6}};
  for (std::size_t i = 0; i < 4; ++i) {
    rows[i] = row(std::to_string(i), 0, 0, 0, 0);
    rows[i].ms = {(ms[i][0] + ms[i][1]) / 2, ms[i][0], ms[i][1]};
    rows[i].error.rmse = (rmse[i][0] + rmse[i][1]) / 2;
    rows[i].error.low = rmse[i][0];
    rows[i].error.high = rmse[i][1];
  }
  EXPECT_FALSE(front_of(rows).empty());
}

TEST(Front, LeavesOutExactlyTheRowsThatOneOfItClearlyBeats) {
  std::mt19937 chance(5);
  for (const double widest : {0.05, 0.2}) {
    std::uniform_real_distribution<double> value(0.3, 1), reach(0, widest);
    for (int round = 0; round < 200; ++round) {
      std::vector<TradeoffRow> rows;
      for (int i = 0; i < 12; ++i)
        rows.push_back(row(std::to_string(i), value(chance), reach(chance), value(chance), reach(chance)));
      ASSERT_FALSE(front_of(rows).empty());
      for (const TradeoffRow& one : rows) {
        const bool beaten = std::any_of(rows.begin(), rows.end(),
                                        [&](const auto& other) { return other.pareto && clearly_wins(other, one); });
        EXPECT_NE(one.pareto, beaten) << widest << " " << round << " " << one.name;
      }
    }
  }
}

TEST(Front, KeepsWhatOnlyABeatenRowBeats) {
  // `wide` is more accurate than `quick` and maybe as fast, but `best` is more accurate still: against that one,
  // `quick` is the faster.
  std::vector<TradeoffRow> rows = {row("quick", 10, 0.5, 0.3, 0.01), row("wide", 13, 4, 0.2, 0.01),
                                   row("best", 16, 0.5, 0.1, 0.01)};
  EXPECT_THAT(front_of(rows), ElementsAre("quick", "best"));
}

TEST(SharedResolve, CountsTheSameWorkTheSame) {
  World world;
  std::map<std::string, VariantRecord> records;
  const auto add = [&](const std::string& name, std::vector<double> resolve, double rest, int shrink = 1) {
    VariantRecord& record = records[name];
    record.row.verified = true;
    record.row.variant.shrink = shrink;
    Methods& methods = record.row.variant.methods;
    methods.tree = methods.grass = methods.crowns = methods.occluders = methods.near = "none";
    for (const double ms : resolve) record.samples.device_ms.push_back(ms + rest);
    record.samples.pass_ms["resolve"] = std::move(resolve);
  };
  add("slow hour", {6, 7, 8}, 1);
  add("quick hour", {2, 3, 4, 5, 5}, 2);
  add("small", {0.5, 0.5}, 1, 2);
  const SharedResolve times(world, records);
  EXPECT_EQ(times.resolve_ms(records.at("slow hour").row.variant).median, 5);
  EXPECT_THAT(times.device_ms(records.at("slow hour")), ElementsAre(6, 6, 6));
  EXPECT_THAT(times.device_ms(records.at("quick hour")), ElementsAre(7, 7, 7, 7, 7));
  EXPECT_THAT(times.device_ms(records.at("small")), ElementsAre(1.5, 1.5)) << "draws fewer pixels";
}

TradeoffTable small_table() {
  TradeoffTable table;
  table.scene = "a \"small\" one";
  table.device = "some device";
  table.identity = "0123";
  table.frames = {1, 5};
  table.cameras = 2;
  table.rays = 64;
  table.pixels = 100;
  table.draw_ms = {{1, 12.5}, {2, 11}};
  table.rows = {row("fast, simple", 1, 0.1, 0.3, 0.01), row("good", 9, 0.1, 0.1, 0.01)};
  table.rows[0].variant.methods.tree = "crown-field";
  table.rows[0].variant.methods.near_field.radius = 0.75;
  table.rows[0].variant.methods.grid.size = 16;
  table.rows[0].variant.shrink = 2;
  table.rows[0].variant.relaxed_maths = true;
  table.rows[0].bake_s = 2.5;
  table.rows[0].pass_ms = {{"combine", {0.25, 0.2, 0.3}}};
  table.rows[0].classes["tree"] = table.rows[0].error;
  table.rows[0].views = {{1, 5, table.rows[0].error, {{"tree", table.rows[0].error}}}};
  table.rows[0].temporal = TemporalError{0.5, 0.75, 0.125};
  table.rows[0].predicted_ms = 1.25;
  table.rows[0].predicted_rmse = 0.25;
  table.rows[0].settings = {"methods.tree=crown-field"};
  mark_front(table.rows);
  table.prediction = {1000, 2, 0.01, 0.02, 0.001, 0.002};
  return table;
}

TEST(TradeoffJson, ReadsBackWhatItWrote) {
  const std::string text = tradeoff_json(small_table());
  const TradeoffTable back = read_tradeoff(text, "table");
  EXPECT_EQ(tradeoff_json(back), text);
  ASSERT_EQ(back.rows.size(), 2u);
  EXPECT_EQ(back.rows[0].variant.methods.tree, "crown-field");
  EXPECT_EQ(back.rows[0].variant.methods.near_field.radius, 0.75);
  EXPECT_EQ(back.rows[0].variant.methods.grid.size, 16);
  EXPECT_TRUE(back.rows[0].variant.relaxed_maths);
  EXPECT_EQ(back.rows[0].temporal->flicker, 0.125);
  EXPECT_EQ(back.rows[0].pass_ms.at("combine").high, 0.3);
  EXPECT_FALSE(back.rows[1].temporal);
  EXPECT_LT(back.rows[1].bake_s, 0);
}

TEST(TradeoffJson, HoldsTheKeysThatScriptsRelyOn) {
  const std::string text = tradeoff_json(small_table());
  for (const char* key : {"methods", "ms", "ms_low", "ms_high", "rmse", "rmse_low", "rmse_high", "mib", "pareto"})
    EXPECT_THAT(text, HasSubstr('"' + std::string(key) + '"'));
}

TEST(TradeoffJson, RefusesWhatIsNoTable) {
  for (const char* text : {"", "[]", "{\"rows\": 3}", "{"}) {
    try {
      read_tradeoff(text, "here.json");
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
      EXPECT_THAT(error.what(), HasSubstr("here.json: not a table of `understory tradeoff`"));
    }
  }
}

TEST(TradeoffText, QuotesNamesAndHasAColumnForEachHeading) {
  const std::string csv = tradeoff_csv(small_table());
  const std::string head = csv.substr(0, csv.find('\n'));
  const std::string second = csv.substr(csv.rfind("\"good\""));
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(second.begin(), second.end(), ','));
  EXPECT_THAT(csv, HasSubstr("\n\"fast, simple\",1.0000"));
  EXPECT_THAT(tradeoff_markdown(small_table()), HasSubstr("| 2 | good | 9.00 (8.90 to 9.10) |"));
}

}  // namespace
}  // namespace understory
