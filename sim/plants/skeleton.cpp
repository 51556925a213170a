#include "sim/plants/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/random.hpp"

namespace understory {
namespace {

constexpr double buried = 0.012;    // share of the height that a trunk reaches below ground, so that slopes show no gap
constexpr double clearance = 0.04;  // share of the height: twigs stay about that far above ground
constexpr glm::dvec3 up{0, 0, 1};

struct Segment {
  std::size_t index;
  double share;  // within the segment
};

Segment segment_at(const Stem& stem, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(stem.points.size() - 1);
  const std::size_t index = std::min(static_cast<std::size_t>(at), stem.points.size() - 2);
  return {index, at - static_cast<double>(index)};
}

/// Value of the crown's outline, `share` running from its base (0) to its top (1).
double outline_at(const GrowthTraits& traits, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(traits.outline.size() - 1);
  const std::size_t index = std::min(static_cast<std::size_t>(at), traits.outline.size() - 2);
  return std::lerp(traits.outline[index], traits.outline[index + 1], at - static_cast<double>(index));
}

/// The stem's axis as a chain of equal segments, bent by tropism and by chance.
/// Branches turn up before they come below `ground_clearance`, m.
void grow_axis(Stem& stem, const StemTraits& traits, glm::dvec3 base, glm::dvec3 direction, double ground_clearance,
               Random& random) {
  const double step = stem.length / traits.segments;
  stem.points.push_back(base);
  for (int i = 0; i < traits.segments; ++i) {
    if (i > 0) {
      const double share = static_cast<double>(i) / traits.segments;
      const double tropism = std::lerp(traits.tropism_base, traits.tropism_tip, share) / traits.segments;
      const auto [side, other] = across(direction);
      const double wander = traits.wander / std::sqrt(traits.segments);
      const double sideways = random.normal(0, wander), upright = random.normal(0, wander);
      direction += tropism * (up - glm::dot(up, direction) * direction) + sideways * side + upright * other;
      direction = glm::normalize(direction);
    }
    if (stem.level > 0 && base.z + step * direction.z < ground_clearance) {
      direction = glm::normalize(glm::dvec3(direction.x, direction.y, 0.3 * std::abs(direction.z)));
    }
    base += step * direction;
    stem.points.push_back(base);
  }
}

void set_radii(Stem& stem, const StemTraits& traits, double base_radius) {
  for (std::size_t i = 0; i < stem.points.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(stem.points.size() - 1);
    stem.radii.push_back(base_radius * std::pow(1 - share, traits.taper));
  }
}

Stem grow_trunk(const GrowthTraits& traits, int ordinal, Random& random) {
  const StemTraits& level = traits.levels[0];
  Stem stem;
  stem.length = traits.height * level.length * (1 + random.uniform(-1, 1) * level.length_spread);
  const bool single = level.per_node == 1;
  const double turn = ordinal * level.turn + random.uniform(-1, 1) * level.turn_spread;
  // Several trunks leave a small rootstock, the outer ones more aslant.
  const double outward = single ? 0 : std::sqrt((ordinal + 0.5) / level.per_node);
  const glm::dvec3 direction = single ? up : tilted(up, level.angle_base * outward, turn);
  const glm::dvec3 root = single ? glm::dvec3(0) : 0.035 * traits.height * tilted(up, std::numbers::pi / 2, turn);
  grow_axis(stem, level, outward * root - buried * traits.height * up, direction, 0, random);
  set_radii(stem, level, stem.length * level.slenderness);
  return stem;
}

/// One child at `share` of stem `parent`, `bearing` running from 0 to 1 over the part that carries stems.
Stem grow_child(const GrowthTraits& traits, const std::vector<Stem>& stems, std::size_t parent, double share,
                double bearing, double turn, Random& random) {
  const Stem& carrier = stems[parent];
  Stem stem;
  stem.level = carrier.level + 1;
  stem.parent = static_cast<std::int32_t>(parent);
  const StemTraits& level = traits.levels[static_cast<std::size_t>(stem.level)];
  const double spread = 1 + random.uniform(-1, 1) * level.length_spread;
  stem.length = level.length * spread *
                (stem.level == 1 ? traits.height * outline_at(traits, bearing)
                                 : carrier.length * (1 - 0.6 * share));  // Weber & Penn 1995, section 4.3
  const double angle =
      std::lerp(level.angle_base, level.angle_tip, bearing) + random.uniform(-1, 1) * level.angle_spread;
  const double ground_clearance = clearance * traits.height * random.uniform(0.3, 1.7);
  grow_axis(stem, level, carrier.position(share), tilted(carrier.tangent(share), angle, turn), ground_clearance,
            random);
  set_radii(stem, level, std::min(stem.length * level.slenderness, 0.8 * carrier.radius(share)));
  return stem;
}

void grow_children(const GrowthTraits& traits, std::vector<Stem>& stems, std::size_t parent, std::uint64_t seed) {
  const std::size_t child_level = static_cast<std::size_t>(stems[parent].level) + 1;
  if (child_level >= traits.levels.size()) return;
  const StemTraits& level = traits.levels[child_level];
  Random random(seed, stream_of("stem"), parent);
  const double bearing_length = stems[parent].length * (1 - level.bare);
  const int nodes = std::max(1, static_cast<int>(std::lround(bearing_length / (level.spacing * traits.height))));
  double turn = random.uniform(0, 2 * std::numbers::pi);
  if (level.turn > 3) turn = 0;  // flat sprays lie in the plane of the branch and the horizontal
  for (int node = 0; node < nodes; ++node) {
    // The last node stays short of the tip: a leader continues beyond its topmost branches.
    const double bearing = (node + random.uniform(0.3, 0.7)) / nodes;
    const double share = level.bare + (0.97 - level.bare) * bearing;
    for (int of_node = 0; of_node < level.per_node; ++of_node) {
      const double even = turn + of_node * 2 * std::numbers::pi / level.per_node;
      const double chance = random.uniform(-1, 1) * level.turn_spread;
      // Stems of one whorl stand at nearly one height, not at one point.
      const double height = share + random.uniform(-0.12, 0.12) * (0.97 - level.bare) / nodes;
      stems.push_back(grow_child(traits, stems, parent, height, bearing, even + chance, random));
    }
    turn += level.turn;
  }
}

}  // namespace

glm::dvec3 Stem::position(double share) const {
  const Segment at = segment_at(*this, share);
  return glm::mix(points[at.index], points[at.index + 1], at.share);
}

glm::dvec3 Stem::tangent(double share) const {
  const Segment at = segment_at(*this, share);
  return glm::normalize(points[at.index + 1] - points[at.index]);
}

double Stem::radius(double share) const {
  const Segment at = segment_at(*this, share);
  return std::lerp(radii[at.index], radii[at.index + 1], at.share);
}

std::array<glm::dvec3, 2> across(const glm::dvec3& tangent) {
  const glm::dvec3 reference = std::abs(tangent.z) > 0.95 ? glm::dvec3(0, 1, 0) : up;
  const glm::dvec3 side = glm::normalize(glm::cross(reference, tangent));
  return {side, glm::cross(tangent, side)};
}

glm::dvec3 tilted(const glm::dvec3& tangent, double angle, double turn) {
  const auto [side, other] = across(tangent);
  return std::cos(angle) * tangent + std::sin(angle) * (std::cos(turn) * side + std::sin(turn) * other);
}

std::vector<Stem> grow_skeleton(const GrowthTraits& traits, std::uint64_t seed) {
  std::vector<Stem> stems;
  for (int trunk = 0; trunk < traits.levels[0].per_node; ++trunk) {
    Random random(seed, stream_of("trunk"), static_cast<std::uint64_t>(trunk));
    stems.push_back(grow_trunk(traits, trunk, random));
  }
  for (std::size_t parent = 0; parent < stems.size(); ++parent) grow_children(traits, stems, parent, seed);
  return stems;
}

}  // namespace understory
