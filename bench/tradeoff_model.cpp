#include "bench/tradeoff_model.hpp"

#include <algorithm>
#include <cmath>

#include "sim/error.hpp"

namespace understory {
namespace {

/// Both axes shade by the spheres of one pass when their methods are the same.
bool shares_pass(const Methods& crowns, const Methods& occluders) { return crowns.crowns == occluders.occluders; }

}  // namespace

TradeoffModel::TradeoffModel(std::vector<float> truth, double truth_variance, MeasuredTerm bare,
                             std::vector<MeasuredTerm> terms)
    : truth_(std::move(truth)), truth_variance_(truth_variance), bare_(std::move(bare)), terms_(std::move(terms)) {
  for (const MeasuredTerm& term : terms_)
    if (term.values.visibility.size() != truth_.size() || bare_.values.classes.size() != truth_.size())
      throw Error(ErrorKind::unexpected, "a tradeoff's terms are judged at different pixels");
}

std::vector<int> TradeoffModel::choices(Axis axis) const {
  std::vector<int> indices{-1};
  for (std::size_t i = 0; i < terms_.size(); ++i)
    if (terms_[i].axis == axis) indices.push_back(static_cast<int>(i));
  return indices;
}

double TradeoffModel::milliseconds(int term) const {
  return term < 0 ? 0 : terms_[static_cast<std::size_t>(term)].ms - bare_.ms;
}

const TradeoffModel::Values* TradeoffModel::term_plane(int term, const std::string& method) const {
  if (term < 0) return nullptr;
  const auto& planes = terms_[static_cast<std::size_t>(term)].values.terms;
  const auto found = planes.find(method);
  return found == planes.end() ? nullptr : &found->second;
}

/// What a fragment sees before others shade it: the tree's own term on crowns, the grass's on all else, which lights
/// what stands in it too when it is grass-transmittance; the dome factor is in both.
TradeoffModel::Values TradeoffModel::own(int tree, int grass) const {
  const auto& plain = bare_.values.visibility;
  const Values& of_trees = tree < 0 ? plain : terms_[static_cast<std::size_t>(tree)].values.visibility;
  const Values& of_others = grass < 0 ? plain : terms_[static_cast<std::size_t>(grass)].values.visibility;
  const Values* layer = term_plane(grass, "grass-transmittance");
  Values values(truth_.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_tree = bare_.values.classes[i] == JudgedClass::tree;
    values[i] = is_tree ? of_trees[i] * (layer ? (*layer)[i] : 1.0f) : of_others[i];
  }
  return values;
}

TradeoffModel::Values TradeoffModel::shading(int crowns, int occluders) const {
  Values values(truth_.size(), 1);
  for (const int term : {crowns, occluders}) {
    if (term < 0) continue;
    const Methods& methods = terms_[static_cast<std::size_t>(term)].variant.methods;
    const Values* plane = term_plane(term, term == crowns ? methods.crowns : methods.occluders);
    if (!plane) continue;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= (*plane)[i];
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    if (bare_.values.classes[i] == JudgedClass::background) values[i] = 1;
  return values;
}

void TradeoffModel::add_near(Combination combination, const Values& far, std::vector<Combination>& all) const {
  const auto add = [&](const auto& value_at) {
    double squares = 0;
    for (std::size_t i = 0; i < far.size(); ++i) {
      const double error = double(value_at(i)) - double(truth_[i]);
      squares += error * error;
    }
    const double mean = far.empty() ? 0 : squares / static_cast<double>(far.size());
    combination.rmse = std::sqrt(std::max(0.0, mean - truth_variance_));
    all.push_back(combination);
  };
  const double far_ms = combination.ms;
  for (const int near : choices(Axis::near)) {
    combination.near = near;
    combination.ms = far_ms + milliseconds(near);
    combination.near_is_limit = false;
    if (near < 0) {
      add([&](std::size_t i) { return far[i]; });
      continue;
    }
    const Values& plane = *term_plane(near, terms_[static_cast<std::size_t>(near)].variant.methods.near);
    const auto is_open = [&](std::size_t i) { return bare_.values.classes[i] == JudgedClass::background; };
    add([&](std::size_t i) { return is_open(i) ? far[i] : far[i] * plane[i]; });
    combination.near_is_limit = true;
    add([&](std::size_t i) { return is_open(i) ? far[i] : std::min(far[i], plane[i]); });
  }
}

std::vector<Combination> TradeoffModel::predict() const {
  std::vector<Combination> all;
  const std::vector<int> pairs = choices(Axis::crowns_occluders);
  for (const int crowns : choices(Axis::crowns))
    for (const int occluders : choices(Axis::occluders)) {
      double shading_ms = milliseconds(crowns) + milliseconds(occluders);
      if (crowns >= 0 && occluders >= 0) {
        const Methods& of_crowns = terms_[static_cast<std::size_t>(crowns)].variant.methods;
        const Methods& of_occluders = terms_[static_cast<std::size_t>(occluders)].variant.methods;
        if (shares_pass(of_crowns, of_occluders))
          for (const int pair : pairs)
            if (pair >= 0 && terms_[static_cast<std::size_t>(pair)].variant.methods.crowns == of_crowns.crowns)
              shading_ms = milliseconds(pair);
      }
      const Values shade = shading(crowns, occluders);
      for (const int tree : choices(Axis::tree))
        for (const int grass : choices(Axis::grass)) {
          Values far = own(tree, grass);
          for (std::size_t i = 0; i < far.size(); ++i) far[i] *= shade[i];
          Combination combination{tree, grass, crowns, occluders};
          combination.ms = bare_.ms + shading_ms + milliseconds(tree) + milliseconds(grass);
          add_near(combination, far, all);
        }
    }
  return all;
}

Variant TradeoffModel::variant_of(const Combination& combination) const {
  Variant variant = bare_.variant;
  for (const int term :
       {combination.tree, combination.grass, combination.crowns, combination.occluders, combination.near}) {
    if (term < 0) continue;
    const MeasuredTerm& chosen = terms_[static_cast<std::size_t>(term)];
    variant.methods = with_term(variant.methods, chosen.axis, chosen.variant.methods);
  }
  if (variant.methods.near != "none")
    variant.methods.near_field.combine = combination.near_is_limit ? "minimum" : "product";
  return variant;
}

std::vector<Combination> predicted_front(std::vector<Combination> all, int count) {
  std::sort(all.begin(), all.end(),
            [](const Combination& a, const Combination& b) { return a.ms != b.ms ? a.ms < b.ms : a.rmse < b.rmse; });
  std::vector<Combination> front;
  for (const Combination& one : all)
    if (front.empty() || one.rmse < front.back().rmse) front.push_back(one);
  if (front.size() <= static_cast<std::size_t>(std::max(count, 2))) return front;
  // The smallest step in error that leaves few enough.
  for (double step = 0.005;; step *= 1.1) {
    std::vector<Combination> few;
    for (const Combination& one : front)
      if (few.empty() || one.rmse < (1 - step) * few.back().rmse) few.push_back(one);
    if (few.back().rmse > front.back().rmse) few.push_back(front.back());
    if (few.size() <= static_cast<std::size_t>(std::max(count, 2))) return few;
  }
}

}  // namespace understory
