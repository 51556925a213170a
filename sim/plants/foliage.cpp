#include "sim/plants/foliage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "sim/random.hpp"

namespace understory {
namespace {

constexpr std::size_t most_limbs = 320;  // poses cost per limb, stretching falls with their number
constexpr double shortest_limb = 0.045;  // share of the plant's height; level 2 only
constexpr double largest_delay = 1.2;    // s, about a period of branch sway
constexpr glm::dvec3 up{0, 0, 1};

/// Which stems are limbs: levels 0 and 1, then the longest of level 2 as far as the number allows.
std::vector<bool> choose_limbs(const GrowthTraits& traits, const std::vector<Stem>& stems) {
  std::vector<bool> chosen(stems.size(), false);
  std::vector<std::size_t> candidates;
  std::size_t count = 0;
  for (std::size_t i = 0; i < stems.size(); ++i) {
    if (stems[i].level <= 1) chosen[i] = true, ++count;
    if (stems[i].level == 2 && stems[i].length > shortest_limb * traits.height) candidates.push_back(i);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](std::size_t a, std::size_t b) { return stems[a].length > stems[b].length; });
  for (std::size_t candidate : candidates) {
    if (count++ < most_limbs) chosen[candidate] = true;
  }
  return chosen;
}

/// Length over base radius: what makes a twig bend more than a bough.
double slenderness(const Stem& stem) { return stem.length / std::max(stem.radii.front(), 1e-6); }

Limb limb_of_stem(const Stem& stem, double mean_slenderness, Random random) {
  Limb limb;
  const glm::dvec3 chord = stem.points.back() - stem.points.front();
  limb.kind = stem.level == 0 ? SwayKind::trunk : SwayKind::branch;
  limb.base = glm::vec3(stem.points.front());
  limb.axis = glm::vec3(glm::normalize(chord));
  limb.length = static_cast<float>(glm::length(chord));
  if (stem.level > 0) {
    limb.flexibility = static_cast<float>(std::clamp(slenderness(stem) / mean_slenderness, 0.5, 2.0));
    limb.delay = static_cast<float>(random.uniform(0, largest_delay));
  }
  return limb;
}

/// Where rings stand along a stem, as shares of its length: at its points, and closer at a flared foot.
std::vector<double> ring_shares(const Stem& stem, double flare) {
  std::vector<double> shares{0};
  if (flare > 0) shares.insert(shares.end(), {0.012, 0.025, 0.05});
  const std::size_t segments = stem.points.size() - 1;
  for (std::size_t i = 1; i < segments; ++i) shares.push_back(static_cast<double>(i) / static_cast<double>(segments));
  return shares;
}

/// Rings of `sides` vertices along the stem, carried along without twist, closed by a point at the tip.
/// `flare`: share by which the foot is thicker; it fades over 2 % of the length.
void add_tube(LimbMesh& mesh, const Stem& stem, int sides, double flare, std::uint32_t limb) {
  std::vector<std::uint32_t>& triangles = mesh.triangles[SurfaceClass::wood];
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size()), n = static_cast<std::uint32_t>(sides);
  const std::vector<double> shares = ring_shares(stem, flare);
  const double step = 0.25 / static_cast<double>(stem.points.size() - 1);  // rings at kinks halve the angle
  glm::dvec3 side = across(stem.tangent(0))[0];
  for (double share : shares) {
    const glm::dvec3 tangent = glm::normalize(stem.tangent(share - step) + stem.tangent(share + step));
    side = glm::normalize(side - glm::dot(side, tangent) * tangent);
    const glm::dvec3 other = glm::cross(tangent, side);
    const double radius = stem.radius(share) * (1 + flare * std::exp(-share / 0.02));
    for (int corner = 0; corner < sides; ++corner) {
      const double turn = 2 * std::numbers::pi * corner / sides;
      const glm::dvec3 out = std::cos(turn) * side + std::sin(turn) * other;
      mesh.add_vertex(glm::vec3(stem.position(share) + radius * out), limb);
    }
  }
  const std::uint32_t tip = mesh.add_vertex(glm::vec3(stem.points.back()), limb);
  for (std::uint32_t ring = 0; ring < shares.size(); ++ring) {
    for (std::uint32_t corner = 0; corner < n; ++corner) {
      const std::uint32_t a = first + ring * n + corner, b = first + ring * n + (corner + 1) % n;
      if (ring + 1 == shares.size()) {
        triangles.insert(triangles.end(), {a, b, tip});
      } else {
        triangles.insert(triangles.end(), {a, b, b + n, a, b + n, a + n});
      }
    }
  }
}

/// Where one leaf stands: base, direction of the midrib, direction that the upper face looks to.
struct LeafFrame {
  glm::dvec3 base, along, face;
};

LeafFrame leaf_frame(const LeafTraits& leaf, const Stem& stem, double share, double turn, double length,
                     Random& random) {
  const glm::dvec3 twig = stem.tangent(share);
  glm::dvec3 along = tilted(twig, leaf.angle + random.normal(0, 0.15), turn + random.normal(0, 0.25));
  along = glm::normalize(along - leaf.droop * random.uniform(0.5, 1.5) * up);
  const glm::dvec3 towards_tip = twig - glm::dot(twig, along) * along;
  const double upward = std::clamp(leaf.upward + random.normal(0, 0.2), 0.0, 1.0);
  const auto [side, other] = across(along);
  glm::dvec3 face = glm::mix(towards_tip, up, upward) + random.normal(0, 0.2) * side + random.normal(0, 0.05) * other;
  face -= glm::dot(face, along) * along;
  if (glm::length(face) < 1e-3) face = side;
  const glm::dvec3 base = stem.position(share) + (stem.radius(share) + leaf.petiole * length) * along;
  return {base, along, glm::normalize(face)};
}

void add_leaf(LimbMesh& mesh, const LeafTraits& leaf, const LeafFrame& frame, double length, std::uint32_t limb,
              std::uint8_t phase) {
  const glm::dvec3 across_midrib = glm::cross(frame.face, frame.along);
  const double half_width = 0.5 * leaf.width * length, petiole = leaf.petiole * length;
  const glm::dvec3 middle = frame.base + leaf.widest * length * frame.along;
  const glm::dvec3 outward = half_width * std::cos(leaf.fold) * across_midrib;
  const glm::dvec3 raised = half_width * std::sin(leaf.fold) * frame.face;
  const auto vertex = [&](glm::dvec3 position, double from_twig) {
    return mesh.add_vertex(glm::vec3(position), limb, glm::vec3(full_flutter * from_twig * frame.face), phase);
  };
  const double widest = petiole + leaf.widest * length;
  const std::uint32_t base = vertex(frame.base, petiole), left = vertex(middle + outward + raised, widest),
                      tip = vertex(frame.base + length * frame.along, petiole + length),
                      right = vertex(middle - outward + raised, widest);
  std::vector<std::uint32_t>& triangles = mesh.triangles[SurfaceClass::leaf];
  triangles.insert(triangles.end(), {base, tip, left, base, right, tip});
}

/// Length of each stem that bears leaves, 0 for the others.
std::vector<double> bearing_lengths(const LeafTraits& leaf, const std::vector<Stem>& stems) {
  std::vector<double> lengths;
  for (const Stem& stem : stems) {
    lengths.push_back(stem.level >= leaf.first_level ? stem.length * (1 - leaf.start) : 0.0);
  }
  return lengths;
}

}  // namespace

std::vector<std::uint32_t> make_limbs(LimbMesh& mesh, const GrowthTraits& traits, const std::vector<Stem>& stems,
                                      std::uint64_t seed) {
  const std::vector<bool> chosen = choose_limbs(traits, stems);
  double mean_slenderness = 0, branches = 0;
  for (std::size_t i = 0; i < stems.size(); ++i) {
    if (chosen[i] && stems[i].level > 0) mean_slenderness += slenderness(stems[i]), ++branches;
  }
  mean_slenderness /= std::max(branches, 1.0);

  std::vector<std::uint32_t> limb(stems.size());
  for (std::size_t i = 0; i < stems.size(); ++i) {
    const std::int32_t parent = stems[i].parent;
    if (!chosen[i]) {
      limb[i] = limb[static_cast<std::size_t>(parent)];
      continue;
    }
    limb[i] = static_cast<std::uint32_t>(mesh.limbs.size());
    mesh.limbs.push_back(limb_of_stem(stems[i], mean_slenderness, Random(seed, stream_of("limb"), i)));
    if (parent >= 0) mesh.limbs.back().parent = static_cast<std::int32_t>(limb[static_cast<std::size_t>(parent)]);
  }
  return limb;
}

void add_wood(LimbMesh& mesh, const GrowthTraits& traits, const std::vector<Stem>& stems,
              const std::vector<std::uint32_t>& limb) {
  for (std::size_t i = 0; i < stems.size(); ++i) {
    const StemTraits& level = traits.levels[static_cast<std::size_t>(stems[i].level)];
    add_tube(mesh, stems[i], level.sides, stems[i].level == 0 ? traits.root_flare : 0, limb[i]);
  }
}

void add_leaves(LimbMesh& mesh, const GrowthTraits& traits, const std::vector<Stem>& stems,
                const std::vector<std::uint32_t>& limb, int count, double size, std::uint64_t seed) {
  const LeafTraits& leaf = traits.leaf;
  const std::vector<double> lengths = bearing_lengths(leaf, stems);
  const double whole = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  double before = 0;
  long done = 0;
  for (std::size_t i = 0; i < stems.size(); ++i) {
    before += lengths[i];
    // Rounding the running share instead of each stem's own keeps the total exact.
    const long until = lengths[i] > 0 ? std::lround(count * std::min(before / whole, 1.0)) : done;
    Random random(seed, stream_of("leaf"), i);
    double turn = random.uniform(0, 2 * std::numbers::pi);
    if (leaf.turn > 3) turn = 0;  // two rows, left and right of the twig
    const long here = until - done;
    for (long of_stem = 0; of_stem < here; ++of_stem, turn += leaf.turn) {
      const double along = (static_cast<double>(of_stem) + random.uniform()) / static_cast<double>(here);
      const double length = leaf.length * size * random.uniform(0.75, 1.25);
      const LeafFrame frame = leaf_frame(leaf, stems[i], std::lerp(leaf.start, 1.0, along), turn, length, random);
      add_leaf(mesh, leaf, frame, length, limb[i], static_cast<std::uint8_t>(random.below(256)));
    }
    done = until;
  }
}

}  // namespace understory
