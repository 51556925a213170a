// Where the wood of a generated plant runs: stems as curved axes with a radius, and what decides their growth.
// After Weber & Penn, "Creation and rendering of realistic trees", SIGGRAPH 1995, with these departures: stems stand at
// nodes of even spacing (whorls included), the crown's outline is a table instead of named shapes, and tropism may
// change along a stem, so that a spruce's branches sag first and lift their tips.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace understory {

/// Growth of all stems of one level: 0 trunks, 1 branches on trunks, and so on. Angles in radians.
struct StemTraits {
  double spacing = 0.05;       // between nodes on the parent, as a share of the plant's height; level 0: unused
  int per_node = 1;            // stems at one node; level 0: number of trunks
  double bare = 0.1;           // share of the parent, from its base, without such stems
  double length = 1;           // level 0, 1: share of the height; others: of the parent's length beyond the node
  double length_spread = 0.1;  // +- share
  double angle_base = 1, angle_tip = 0.7, angle_spread = 0.1;  // away from the parent, near its base and near its tip
  double turn = 2.39996;  // from node to node about the parent: golden angle, or pi for flat sprays
  double turn_spread = 0.3;
  double tropism_base = 0, tropism_tip = 0;  // radians of bending upward (negative: down) per length, at right angles
  double wander = 0.1;                       // radians of random bending over the length
  double slenderness = 0.01;                 // base radius / length; never thicker than what carries it
  double taper = 0.9;                        // radius ~ (1 - u)^taper
  int segments = 4, sides = 4;
};

struct LeafTraits {
  int count = 50'000;
  double length = 0.1;    // m, at the preset's own height
  double width = 0.5;     // share of the length
  double widest = 0.45;   // where, as a share of the length from the base
  double fold = 0.25;     // radians that each half rises from the flat
  double petiole = 0.2;   // share of the length
  double angle = 0.9;     // away from the twig, radians
  double turn = 2.39996;  // phyllotaxis, radians
  double upward = 0.5;    // 0 .. 1: how far the upper face turns to the sky
  double droop = 0;       // 0 .. 1: how far the leaf hangs
  int first_level = 2;    // leaves stand on stems of this level and above
  double start = 0.2;     // share of the stem without leaves, from its base
};

struct GrowthTraits {
  double height = 14;                               // m
  std::vector<StemTraits> levels;                   // at least one
  std::array<double, 6> outline{1, 1, 1, 1, 1, 1};  // length of branches, from the crown's base to its top
  double root_flare = 0.4;                          // the trunk's foot is thicker by this share
  LeafTraits leaf;
};

struct Stem {
  int level = 0;
  std::int32_t parent = -1;        // index of an earlier stem
  std::vector<glm::dvec3> points;  // m; the first lies on the parent's axis
  std::vector<double> radii;       // m, one per point; 0 at the tip
  double length = 0;               // m, along the points

  /// At `share` of the length: position, unit tangent, radius.
  glm::dvec3 position(double share) const;
  glm::dvec3 tangent(double share) const;
  double radius(double share) const;
};

/// Two unit vectors across a unit `tangent`, the first horizontal (or along x on a nearly vertical stem).
std::array<glm::dvec3, 2> across(const glm::dvec3& tangent);

/// Unit vector at `angle` from `tangent`, turned by `turn` about it from the first of `across(tangent)`.
glm::dvec3 tilted(const glm::dvec3& tangent, double angle, double turn);

/// Grows all stems, parents before children. A function of the arguments alone.
std::vector<Stem> grow_skeleton(const GrowthTraits& traits, std::uint64_t seed);

}  // namespace understory
