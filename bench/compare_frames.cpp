#include "bench/compare_frames.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/ssim.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

/// The compared pixels of one class, or of all.
struct Selection {
  std::vector<float> value, reference, halfwidth;
  std::vector<std::uint32_t> rays;

  void add(const Frame& a, const Frame& b, std::size_t i) {
    value.push_back(a.visibility[i]);
    reference.push_back(b.visibility[i]);
    if (b.halfwidth.empty() || b.rays.empty()) return;
    halfwidth.push_back(b.halfwidth[i]);
    rays.push_back(b.rays[i]);
  }
  ErrorStatistics statistics() const { return error_statistics(value, reference, halfwidth, rays); }
};

bool same_owners(const std::vector<Owner>& a, const std::vector<Owner>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Owner& left, const Owner& right) {
    return left.surface == right.surface && left.species == right.species && left.instance == right.instance;
  });
}

void require_comparable(const Frame& value, const Frame& reference) {
  if (value.width != reference.width || value.height != reference.height)
    throw Error(ErrorKind::invalid_input, fmt::format("{} x {} and {} x {} pixels; allowed: images of one size",
                                                      value.width, value.height, reference.width, reference.height));
  if (!same_owners(value.owners, reference.owners))
    throw Error(ErrorKind::invalid_input,
                fmt::format("their owner tables of {} and {} rows differ; allowed: frames of one scene",
                            value.owners.size(), reference.owners.size()));
}

bool is_background(const Frame& frame, std::size_t i) { return (frame.validity[i] & validity::background) != 0; }

}  // namespace

FrameComparison compare_frames(const Frame& value, const Frame& reference) {
  require_comparable(value, reference);
  FrameComparison result;
  result.difference.assign(value.pixels(), 0);
  result.validity.assign(value.pixels(), validity::background);
  Selection all;
  std::map<std::string, Selection> classes;
  for (std::size_t i = 0; i < value.pixels(); ++i) {
    if (value.owner[i] != reference.owner[i] || is_background(value, i) != is_background(reference, i)) {
      ++result.mismatched;
      continue;
    }
    if (is_background(value, i)) continue;
    result.validity[i] = 0;
    result.difference[i] = value.visibility[i] - reference.visibility[i];
    all.add(value, reference, i);
    if (value.owner[i] < value.owners.size() && value.owner[i] > 0)
      classes[surface_class_name(value.owners[value.owner[i]].surface)].add(value, reference, i);
  }
  if (result.mismatched * 100 > value.pixels())
    throw Error(ErrorKind::invalid_input,
                fmt::format("{} of {} pixels show different things; allowed: frames of one scene, camera and time",
                            result.mismatched, value.pixels()));
  result.all = all.statistics();
  for (const auto& [name, selection] : classes) result.classes[name] = selection.statistics();
  if (result.all.pixels == 0) return result;
  const std::vector<float> similarity = ssim_map(value.width, value.height, value.visibility, reference.visibility);
  result.ssim = 0;
  for (std::size_t i = 0; i < similarity.size(); ++i)
    if (result.validity[i] == 0) result.ssim += similarity[i] / static_cast<double>(result.all.pixels);
  return result;
}

}  // namespace understory
