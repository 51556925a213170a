#include "sim/plants/limbs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/error.hpp"
#include "sim/plants/nearest_points.hpp"
#include "sim/plants/pieces.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr std::uint32_t most_limbs = 384;
constexpr float shortest_limb = 0.05f;       // share of the mesh's height
constexpr float shortest_trunk = 0.3f;       // below this the wood is in pieces that tell nothing of its growth
constexpr float ground_layer = 0.05f;        // share of the height: what starts here may stand on its own
constexpr float joint = 0.02f;               // share of the height: wood this near touches
constexpr float sample_spacing = 0.01f;      // share of the height
constexpr float largest_flutter_arm = 0.5f;  // m: a canopy in one piece does not flap as one leaf
constexpr double largest_delay = 1.2;        // s, about a period of branch sway
constexpr float leafy_mat_flexibility = 0.3f;

/// All parts as one: wood and foliage triangles over one list of positions.
struct FlatMesh {
  std::vector<glm::vec3> positions;
  std::map<SurfaceClass, std::vector<std::uint32_t>> triangles;
  std::vector<std::uint32_t> wood, foliage;  // triangles again, by kind
  glm::vec3 low{0}, high{0};
  float height() const { return std::max(high.z - low.z, 1e-6f); }
};

bool is_foliage(SurfaceClass surface) { return surface == SurfaceClass::leaf || surface == SurfaceClass::blade; }

FlatMesh flatten(const RawMesh& plant) {
  FlatMesh flat;
  for (const RawMesh::Part& part : plant.parts) {
    const std::uint32_t offset = static_cast<std::uint32_t>(flat.positions.size());
    flat.positions.insert(flat.positions.end(), part.positions.begin(), part.positions.end());
    for (std::uint32_t index : part.triangles) {
      flat.triangles[part.surface].push_back(offset + index);
      (is_foliage(part.surface) ? flat.foliage : flat.wood).push_back(offset + index);
    }
  }
  if (flat.wood.empty() && flat.foliage.empty()) {
    throw Error(ErrorKind::invalid_input, "plant mesh: no triangle; a plant needs at least one");
  }
  flat.low = flat.high = flat.positions[(flat.wood.empty() ? flat.foliage : flat.wood).front()];
  for (const std::vector<std::uint32_t>* list : {&flat.wood, &flat.foliage}) {
    for (std::uint32_t i : *list) {
      flat.low = glm::min(flat.low, flat.positions[i]);
      flat.high = glm::max(flat.high, flat.positions[i]);
    }
  }
  return flat;
}

/// A connected piece of wood in the order of growth: larger pieces come first and carry smaller ones.
struct Wood {
  Pieces pieces;
  std::vector<StemPiece> stems;          // per piece
  std::vector<std::uint32_t> by_extent;  // rank -> piece, largest first
  std::vector<std::uint32_t> rank;       // piece -> rank
};

Wood find_wood(const FlatMesh& flat) {
  Wood wood;
  wood.pieces = connected_pieces(flat.positions, flat.wood);
  for (std::size_t piece = 0; piece < wood.pieces.size(); ++piece) {
    wood.stems.push_back(measure_stem(flat.positions, wood.pieces, piece));
  }
  wood.by_extent.resize(wood.stems.size());
  std::iota(wood.by_extent.begin(), wood.by_extent.end(), 0u);
  std::stable_sort(wood.by_extent.begin(), wood.by_extent.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return wood.stems[a].extent > wood.stems[b].extent; });
  wood.rank.resize(wood.stems.size());
  for (std::uint32_t r = 0; r < wood.by_extent.size(); ++r) wood.rank[wood.by_extent[r]] = r;
  return wood;
}

/// Points all over the wood of ranks below `rank_limit`, labelled with their piece's rank: long thin triangles have no
/// vertex where a twig leaves them.
NearestPoints sample_wood(const FlatMesh& flat, const Wood& wood, std::uint32_t rank_limit) {
  const float spacing = sample_spacing * flat.height();
  std::vector<NearestPoints::Point> samples;
  for (std::size_t i = 0; i + 2 < flat.wood.size(); i += 3) {
    const glm::vec3 a = flat.positions[flat.wood[i]], b = flat.positions[flat.wood[i + 1]],
                    c = flat.positions[flat.wood[i + 2]];
    const std::uint32_t label = wood.rank[wood.pieces.of_vertex[flat.wood[i]]];
    if (label >= rank_limit) continue;
    const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const int steps = std::clamp(static_cast<int>(longest / spacing), 1, 64);
    for (int u = 0; u < steps; ++u) {
      for (int v = 0; u + v < steps; ++v) {
        const float s = static_cast<float>(u) / static_cast<float>(steps);
        const float t = static_cast<float>(v) / static_cast<float>(steps);
        samples.push_back({a + s * (b - a) + t * (c - a), label});
      }
    }
  }
  return NearestPoints(std::move(samples));
}

/// Where a stem starts and what it starts on.
struct Growth {
  bool from_second_end = false;
  bool on_ground = false;
  std::uint32_t parent_rank = 0;
};

/// Of a stem that may be a limb: it grows from a larger one.
Growth find_growth(const FlatMesh& flat, const StemPiece& stem, std::uint32_t rank, const NearestPoints& carriers) {
  const NearestPoints::Hit hits[2] = {carriers.nearest(stem.ends[0].middle, rank),
                                      carriers.nearest(stem.ends[1].middle, rank)};
  const float thickness[2] = {stem.ends[0].radius, stem.ends[1].radius};
  const int lower = stem.ends[1].middle.z < stem.ends[0].middle.z ? 1 : 0;
  const int thicker = thickness[1] > thickness[0] ? 1 : 0;
  const int nearer = hits[1].squared_distance < hits[0].squared_distance ? 1 : 0;
  const float gap = joint * flat.height();
  // Stems thin out; but a cylinder's ends tell nothing, nor does a thick end that touches no other stem.
  const bool tells = thickness[thicker] > 1.2f * thickness[1 - thicker];
  const bool thicker_touches = hits[thicker].squared_distance <= gap * gap;
  Growth growth;
  growth.on_ground = rank == 0 || (stem.ends[lower].middle.z < flat.low.z + ground_layer * flat.height() &&
                                   hits[lower].squared_distance > gap * gap && !(tells && thicker != lower));
  growth.from_second_end = (growth.on_ground ? lower : tells && thicker_touches ? thicker : nearer) == 1;
  growth.parent_rank = hits[growth.from_second_end ? 1 : 0].point.label;
  return growth;
}

/// The rank that carries a piece too small for a limb.
std::uint32_t nearest_carrier(const StemPiece& stem, const NearestPoints& carriers) {
  const NearestPoints::Hit one = carriers.nearest(stem.ends[0].middle), other = carriers.nearest(stem.ends[1].middle);
  return one.squared_distance <= other.squared_distance ? one.point.label : other.point.label;
}

float slenderness(const StemPiece& stem) {
  return stem.extent / std::max({stem.ends[0].radius, stem.ends[1].radius, 1e-4f * stem.extent});
}

Limb limb_of_stem(const StemPiece& stem, const Growth& growth, float flexibility, Random random) {
  const glm::vec3 base = growth.on_ground ? stem.foot : stem.ends[growth.from_second_end ? 1 : 0].middle;
  const glm::vec3 tip = stem.ends[growth.from_second_end ? 0 : 1].middle;
  Limb limb;
  limb.kind = growth.on_ground ? SwayKind::trunk : SwayKind::branch;
  limb.base = base;
  limb.length = glm::distance(base, tip);
  limb.axis = limb.length > 0 ? (tip - base) / limb.length : glm::vec3(0, 0, 1);
  limb.flexibility = growth.on_ground ? 1 : std::clamp(flexibility, 0.5f, 2.0f);
  limb.delay = growth.on_ground ? 0 : static_cast<float>(random.uniform(0, largest_delay));
  return limb;
}

/// Limbs from the larger stems; returns the limb of every rank.
std::vector<std::uint32_t> limbs_of_wood(LimbMesh& mesh, const FlatMesh& flat, const Wood& wood, std::uint64_t seed) {
  const auto stem_of_rank = [&](std::size_t r) -> const StemPiece& { return wood.stems[wood.by_extent[r]]; };
  std::uint32_t carrier_count = 0;
  while (carrier_count < wood.stems.size() && stem_of_rank(carrier_count).extent > shortest_limb * flat.height()) {
    ++carrier_count;
  }
  const NearestPoints carriers = sample_wood(flat, wood, carrier_count);
  const std::uint32_t limb_count = std::min(carrier_count, most_limbs);
  float mean_slenderness = 0;
  for (std::uint32_t r = 0; r < limb_count; ++r) {
    mean_slenderness += slenderness(stem_of_rank(r)) / static_cast<float>(limb_count);
  }

  std::vector<std::uint32_t> limb_of_rank(wood.stems.size());
  for (std::uint32_t r = 0; r < wood.stems.size(); ++r) {
    if (r >= carrier_count) {
      limb_of_rank[r] = limb_of_rank[nearest_carrier(stem_of_rank(r), carriers)];
      continue;
    }
    const Growth growth = find_growth(flat, stem_of_rank(r), r, carriers);
    const std::int32_t parent = growth.on_ground ? -1 : static_cast<std::int32_t>(limb_of_rank[growth.parent_rank]);
    if (r >= limb_count && parent >= 0) {
      limb_of_rank[r] = static_cast<std::uint32_t>(parent);
      continue;
    }
    limb_of_rank[r] = static_cast<std::uint32_t>(mesh.limbs.size());
    const float flexibility = slenderness(stem_of_rank(r)) / mean_slenderness;
    mesh.limbs.push_back(limb_of_stem(stem_of_rank(r), growth, flexibility, Random(seed, stream_of("limb"), r)));
    mesh.limbs.back().parent = parent;
  }
  return limb_of_rank;
}

/// One upright trunk that carries everything.
Limb single_trunk(const FlatMesh& flat) {
  Limb limb;
  limb.kind = SwayKind::trunk;
  const glm::vec3 middle = 0.5f * (flat.low + flat.high);
  limb.base = {middle.x, middle.y, flat.low.z};
  limb.length = flat.height();
  if (flat.wood.empty()) {
    // A mat of blades: stiff as a whole, for its width would lift at the edges; the blades flutter on their own.
    limb.flexibility = leafy_mat_flexibility;
    limb.reach = 0.5f * std::max(flat.high.x - flat.low.x, flat.high.y - flat.low.y);
  }
  return limb;
}

/// Sum of the piece's triangle normals, all turned to the side of the first, so that closed leaves do not cancel out.
std::vector<glm::vec3> piece_normals(const FlatMesh& flat, const Pieces& pieces) {
  std::vector<glm::vec3> normals(pieces.size(), glm::vec3(0));
  for (std::size_t i = 0; i + 2 < flat.foliage.size(); i += 3) {
    const glm::vec3 a = flat.positions[flat.foliage[i]], b = flat.positions[flat.foliage[i + 1]],
                    c = flat.positions[flat.foliage[i + 2]];
    const glm::vec3 normal = glm::cross(b - a, c - a);
    glm::vec3& sum = normals[pieces.of_vertex[flat.foliage[i]]];
    sum += glm::dot(normal, sum) < 0 ? -normal : normal;
  }
  for (glm::vec3& normal : normals) {
    const float length = glm::length(normal);
    normal = length > 0 ? normal / length : glm::vec3(0);
  }
  return normals;
}

/// Hangs every leaf on the nearest wood and lets it turn about its point next to it (its lowest without wood).
void attach_foliage(LimbMesh& mesh, const FlatMesh& flat, const NearestPoints* samples,
                    const std::vector<std::uint32_t>& limb_of_rank, std::uint64_t seed) {
  const Pieces pieces = connected_pieces(flat.positions, flat.foliage, same_corner * flat.height());
  const std::vector<glm::vec3> normals = piece_normals(flat, pieces);
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    const std::uint32_t* first = pieces.vertices.data() + pieces.first[piece];
    const std::uint32_t* last = pieces.vertices.data() + pieces.first[piece + 1];
    glm::vec3 middle(0), below(0);
    for (const std::uint32_t* i = first; i < last; ++i) middle += flat.positions[*i] / static_cast<float>(last - first);
    const NearestPoints::Hit wood = samples != nullptr ? samples->nearest(middle) : NearestPoints::Hit{};
    below = wood.found ? wood.point.position : middle - glm::vec3(0, 0, 1e3f * flat.height());
    const glm::vec3 base = flat.positions[*std::min_element(first, last, [&](std::uint32_t a, std::uint32_t b) {
      return glm::distance(flat.positions[a], below) < glm::distance(flat.positions[b], below);
    })];
    Random random(seed, stream_of("leaf"), piece);
    const std::uint8_t phase = static_cast<std::uint8_t>(random.below(256));
    for (const std::uint32_t* i = first; i < last; ++i) {
      const float arm = std::min(glm::distance(flat.positions[*i], base), largest_flutter_arm);
      mesh.limb[*i] = wood.found ? limb_of_rank[wood.point.label] : 0;
      mesh.flutter[*i] = full_flutter * arm * normals[piece];
      mesh.flutter_phase[*i] = phase;
    }
  }
}

}  // namespace

LimbMesh limbs_from_mesh(const RawMesh& plant, std::uint64_t seed) {
  const FlatMesh flat = flatten(plant);
  LimbMesh mesh;
  for (glm::vec3 position : flat.positions) mesh.add_vertex(position, 0);
  mesh.triangles = flat.triangles;
  if (flat.wood.empty()) {
    mesh.limbs.push_back(single_trunk(flat));
    attach_foliage(mesh, flat, nullptr, {}, seed);
    return mesh;
  }

  const Wood wood = find_wood(flat);
  std::vector<std::uint32_t> limb_of_rank(wood.stems.size(), 0);
  if (wood.stems[wood.by_extent[0]].extent > shortest_trunk * flat.height()) {
    limb_of_rank = limbs_of_wood(mesh, flat, wood, seed);
  } else {
    mesh.limbs.push_back(single_trunk(flat));
  }
  for (std::uint32_t vertex : wood.pieces.vertices) {
    mesh.limb[vertex] = limb_of_rank[wood.rank[wood.pieces.of_vertex[vertex]]];
  }
  if (!flat.foliage.empty()) {
    const NearestPoints all_wood = sample_wood(flat, wood, no_piece);
    attach_foliage(mesh, flat, &all_wood, limb_of_rank, seed);
  }
  return mesh;
}

}  // namespace understory
