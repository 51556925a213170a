// In stages: every term alone; the terms of the predicted front at half the size; the combinations on the front, whole,
// in turn so that drift of the machine meets all alike; the best of those with relaxed maths.
#include "bench/tradeoff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/accuracy_pictures.hpp"
#include "bench/tradeoff_judge.hpp"
#include "bench/tradeoff_model.hpp"
#include "bench/tradeoff_records.hpp"
#include "bench/tradeoff_times.hpp"

namespace understory {
namespace {

constexpr int half_size = 2;
constexpr int term_sweeps = 2;    // forwards and backwards: a machine that gets slower meanwhile slows all alike
constexpr int picture_rays = 64;  // of the truth in pictures of errors, per pixel
constexpr std::size_t relaxed_variants = 4;

class Measuring {
 public:
  Measuring(Device& device, World& world, const TradeoffOptions& options)
      : device_(device),
        world_(world),
        options_(options),
        image_(world.scene.image),
        judge_(device, world, judge_options(world, options)),
        records_(device, judge_, options, image_) {}

  TradeoffTable table();

 private:
  static JudgeOptions judge_options(const World& world, const TradeoffOptions& options) {
    return {spread_frames(world.scene.time.frames, options.frames), options.pixels, options.rays,
            !options.runnable_only};
  }
  bool stopped() const { return options_.stopped && options_.stopped(); }
  void done(const std::string& what);
  std::optional<TradeoffModel> model(int shrink, const std::vector<Term>& terms);
  std::vector<Term> terms_on_front(const TradeoffModel& model) const;
  void add_relaxed(std::vector<Variant>& whole) const;
  void measure_in_turn(const std::vector<Variant>& variants, int sweeps);
  void add_front(const TradeoffModel& model, std::vector<Variant>& whole);
  std::vector<TradeoffRow> rows() const;
  void write_pictures(const std::vector<TradeoffRow>& rows);
  void describe(TradeoffTable& table) const;

  Device& device_;
  World& world_;
  const TradeoffOptions& options_;
  const ImageSize image_;  // the scene's; the judge changes the world's
  TradeoffJudge judge_;
  VariantRecords records_;
  std::map<std::string, Combination> predicted_;  // by name of the variant
  PredictionQuality prediction_;
  int steps_ = 0;  // in all, as far as is known
};

void Measuring::done(const std::string& what) {
  if (options_.progress) options_.progress(steps_, what);
}

std::optional<TradeoffModel> Measuring::model(int shrink, const std::vector<Term>& terms) {
  const auto with_size = [&](Variant variant) {
    variant.shrink = shrink;
    return variant;
  };
  std::vector<Variant> alone{with_size(bare_variant(world_.scene))};
  for (const Term& term : terms) alone.push_back(with_size(term.variant));
  measure_in_turn(alone, term_sweeps);
  if (stopped()) return std::nullopt;
  const SharedResolve times(world_, records_.all());
  const auto term_of = [&](Axis axis, const Variant& variant) -> std::optional<MeasuredTerm> {
    const VariantRecord& record = records_.measured(variant);
    if (!record.row.verified) return std::nullopt;
    return MeasuredTerm{axis, variant, record.values, spread_of(times.device_ms(record)).median};
  };
  std::vector<float> truth;
  double variance = 0;
  for (const JudgedView& view : judge_.views()) {
    truth.insert(truth.end(), view.truth.visibility.begin(), view.truth.visibility.end());
    for (std::size_t i = 0; i < view.pixels.size(); ++i)
      variance += truth_variance(view.truth.halfwidth[i], view.truth.rays[i]);
  }
  if (!truth.empty()) variance /= static_cast<double>(truth.size());
  std::optional<MeasuredTerm> bare = term_of(Axis::tree, alone.front());
  if (!bare) return std::nullopt;
  std::vector<MeasuredTerm> usable;
  for (std::size_t i = 0; i < terms.size(); ++i)
    if (std::optional<MeasuredTerm> one = term_of(terms[i].axis, alone[i + 1])) usable.push_back(std::move(*one));
  return TradeoffModel(std::move(truth), variance, std::move(*bare), std::move(usable));
}

/// The terms that occur on the predicted front of the scene's own size, and of the scene's own methods.
std::vector<Term> Measuring::terms_on_front(const TradeoffModel& model) const {
  std::vector<Methods> chosen{own_variant(world_).methods};
  for (const Combination& one : predicted_front(model.predict(), options_.combinations))
    chosen.push_back(model.variant_of(one).methods);
  std::vector<Term> terms = terms_of(world_);
  std::erase_if(terms, [&](const Term& term) {
    return std::none_of(chosen.begin(), chosen.end(), [&](const Methods& methods) {
      Variant alone{with_term(bare_variant(world_.scene).methods, term.axis, methods)};
      alone.methods.near_field.combine = term.variant.methods.near_field.combine;
      return alone.name() == term.variant.name();
    });
  });
  return terms;
}

/// Notes what the model predicts of its front, and adds it to what is to be measured whole.
void Measuring::add_front(const TradeoffModel& model, std::vector<Variant>& whole) {
  const std::vector<Combination> all = model.predict();
  prediction_.combinations += all.size();
  for (const Combination& one : predicted_front(all, options_.combinations)) {
    const Variant variant = model.variant_of(one);
    predicted_[variant.name()] = one;
    if (std::none_of(whole.begin(), whole.end(), [&](const Variant& other) { return other.name() == variant.name(); }))
      whole.push_back(variant);
  }
  const std::string own = own_variant(world_).name();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Combination& one) { return model.variant_of(one).name() == own; });
  if (found != all.end()) predicted_[own] = *found;
}

/// Each so many times in all, forwards and backwards by turns.
void Measuring::measure_in_turn(const std::vector<Variant>& variants, int sweeps) {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t turn = 0; turn < variants.size() && !stopped(); ++turn) {
      const Variant& variant = variants[sweep % 2 == 0 ? turn : variants.size() - 1 - turn];
      VariantRecord& record = records_.measured(variant);
      if (record.row.verified && record.sweeps <= sweep) records_.time_once_more(record);
      done(record.row.name);
    }
  }
}

/// Some of them once more with relaxed maths: never the default, but what it would change is part of the table.
void Measuring::add_relaxed(std::vector<Variant>& whole) const {
  std::vector<Variant> full;
  for (const Variant& variant : whole)
    if (variant.shrink == 1) full.push_back(variant);
  const std::size_t count = std::min(full.size(), relaxed_variants);
  for (std::size_t i = 0; i < count; ++i) {
    Variant variant = full[count == 1 ? 0 : i * (full.size() - 1) / (count - 1)];
    variant.relaxed_maths = true;
    whole.push_back(variant);
  }
}

std::vector<TradeoffRow> Measuring::rows() const {
  std::map<int, std::vector<double>> drawing;
  for (const auto& [name, record] : records_.all())
    if (record.row.verified) drawing[record.row.variant.shrink].push_back(record.samples.draw_ms);
  const SharedResolve times(world_, records_.all());
  std::vector<TradeoffRow> rows;
  for (const auto& [name, record] : records_.all()) {
    TradeoffRow row = record.row;
    if (row.verified) {
      row.ms = spread_of(times.device_ms(record));
      row.wall_ms = spread_of(record.samples.wall_ms);
      for (const auto& [pass, milliseconds] : record.samples.pass_ms)
        row.pass_ms[pass] = pass == "resolve" ? times.resolve_ms(row.variant) : spread_of(milliseconds);
      for (const auto& [pass, milliseconds] : record.samples.pass_wall_ms)
        row.pass_wall_ms[pass] = spread_of(milliseconds);
      row.frame_ms = row.ms.median + spread_of(drawing[row.variant.shrink]).median;
    }
    if (const auto found = predicted_.find(name); found != predicted_.end()) {
      row.predicted_ms = found->second.ms;
      row.predicted_rmse = found->second.rmse;
    }
    rows.push_back(std::move(row));
  }
  std::sort(rows.begin(), rows.end(), [](const TradeoffRow& a, const TradeoffRow& b) {
    return a.ms.median != b.ms.median ? a.ms.median < b.ms.median : a.name < b.name;
  });
  mark_front(rows);
  return rows;
}

/// Truth, what the variant makes of it, and the difference, in the first frame that each camera sees.
void Measuring::write_pictures(const std::vector<TradeoffRow>& rows) {
  for (const JudgedView& view : judge_.views()) {
    if (view.frame != judge_.views().front().frame) continue;
    std::optional<Frame> truth;
    for (const TradeoffRow& row : rows) {
      if (!row.pareto || stopped()) continue;
      if (!truth) truth = judge_.truth_frame(view, picture_rays);
      judge_.choose(row.variant);
      const std::string camera = view.camera == 0 ? "" : " opposite";
      write_accuracy_picture(options_.folder / "errors", variant_file_name(row.name, "") + camera,
                             fmt::format("RMSE {:.3f}, {:.2f} ms", row.error.rmse, row.ms.median), *truth,
                             judge_.frame(view));
      done("pictures of errors");
    }
  }
}

void Measuring::describe(TradeoffTable& table) const {
  table.scene = world_.scene.name;
  table.device = device_.info().name;
  table.identity = options_.identity;
  for (const JudgedView& view : judge_.views()) {
    if (view.camera == 0) table.frames.push_back(view.frame);
    table.cameras = std::max(table.cameras, view.camera + 1);
    table.pixels += view.pixels.size();
  }
  table.rays = options_.rays;
  for (const TradeoffRow& row : table.rows)
    if (row.verified) table.draw_ms[row.variant.shrink] = row.frame_ms - row.ms.median;
  table.prediction = prediction_;
  PredictionQuality& quality = table.prediction;
  for (const TradeoffRow& row : table.rows) {
    if (!row.predicted_ms || !row.verified) continue;
    const double time = *row.predicted_ms / row.ms.median - 1, error = *row.predicted_rmse - row.error.rmse;
    ++quality.measured;
    quality.ms_bias += time;
    quality.ms_worst = std::max(quality.ms_worst, std::abs(time));
    quality.rmse_bias += error;
    quality.rmse_worst = std::max(quality.rmse_worst, std::abs(error));
  }
  if (quality.measured == 0) return;
  quality.ms_bias /= static_cast<double>(quality.measured);
  quality.rmse_bias /= static_cast<double>(quality.measured);
}

TradeoffTable Measuring::table() {
  const std::vector<Term> terms = terms_of(world_);
  // Guesses, until each stage says what comes after it.
  const int alone = term_sweeps * (static_cast<int>(terms.size()) + 1);
  steps_ = alone + options_.combinations * (1 + 2 * options_.sweeps);
  std::vector<Variant> whole{own_variant(world_)};
  if (const std::optional<TradeoffModel> full = model(1, terms)) {
    steps_ = alone;
    add_front(*full, whole);
    if (!options_.runnable_only) {
      const std::vector<Term> half_terms = terms_on_front(*full);
      if (const std::optional<TradeoffModel> half = model(half_size, half_terms)) add_front(*half, whole);
      steps_ += term_sweeps * (static_cast<int>(half_terms.size()) + 1);
      add_relaxed(whole);
    }
  }
  const int cameras = judge_.views().empty() ? 0 : judge_.views().back().camera + 1;
  const int measured = steps_ + options_.sweeps * static_cast<int>(whole.size());
  steps_ = measured + cameras * options_.combinations;  // pictures: a guess
  measure_in_turn(whole, options_.sweeps);
  for (const Variant& variant : whole)
    if (!stopped()) records_.judge_in_time(records_.measured(variant));
  TradeoffTable table;
  table.rows = rows();
  for (const TradeoffRow& row : table.rows)
    if (row.pareto && !stopped()) records_.judge_in_time(records_.at(row.name));
  table.rows = rows();
  const auto front = std::count_if(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.pareto; });
  steps_ = measured + cameras * static_cast<int>(front);
  if (!options_.folder.empty() && !options_.runnable_only) write_pictures(table.rows);
  describe(table);
  return table;
}

}  // namespace

TradeoffTable measure_tradeoff(Device& device, World& world, const TradeoffOptions& options) {
  return Measuring(device, world, options).table();
}

}  // namespace understory
