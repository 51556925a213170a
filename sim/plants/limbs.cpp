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

constexpr std::size_t most_limbs = 384;
constexpr float shortest_limb = 0.05f;       // share of the mesh's height
constexpr float shortest_trunk = 0.3f;       // below this the wood is in pieces that tell nothing of its growth
constexpr float ground_layer = 0.05f;        // share of the height: what starts here may stand on its own
constexpr float joint = 0.02f;               // share of the height: wood this near touches
constexpr float sample_spacing = 0.006f;     // share of the height
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

/// Points all over the wood, labelled with the rank of their piece: long thin triangles have no vertex where a twig
/// leaves them.
NearestPoints sample_wood(const FlatMesh& flat, const Wood& wood) {
  const float spacing = sample_spacing * flat.height();
  std::vector<NearestPoints::Point> samples;
  for (std::size_t i = 0; i + 2 < flat.wood.size(); i += 3) {
    const glm::vec3 a = flat.positions[flat.wood[i]], b = flat.positions[flat.wood[i + 1]],
                    c = flat.positions[flat.wood[i + 2]];
    const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const int steps = std::clamp(static_cast<int>(longest / spacing), 1, 64);
    const std::uint32_t label = wood.rank[wood.pieces.of_vertex[flat.wood[i]]];
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

Growth find_growth(const FlatMesh& flat, const StemPiece& stem, std::uint32_t rank, const NearestPoints& samples) {
  const NearestPoints::Hit hits[2] = {samples.nearest(stem.ends[0].middle, rank),
                                      samples.nearest(stem.ends[1].middle, rank)};
  const float thickness[2] = {stem.ends[0].radius, stem.ends[1].radius};
  const bool second_is_lower = stem.ends[1].middle.z < stem.ends[0].middle.z;
  const int lower = second_is_lower ? 1 : 0;
  const float gap = joint * flat.height();
  Growth growth;
  growth.on_ground = rank == 0 || (stem.ends[lower].middle.z < flat.low.z + ground_layer * flat.height() &&
                                   hits[lower].squared_distance > gap * gap);
  if (growth.on_ground) {
    growth.from_second_end = second_is_lower;
    return growth;
  }
  // Stems thin out; only cylinders leave it to what their ends touch.
  const bool tells = std::max(thickness[0], thickness[1]) > 1.2f * std::min(thickness[0], thickness[1]);
  growth.from_second_end = tells ? thickness[1] > thickness[0] : hits[1].squared_distance < hits[0].squared_distance;
  growth.parent_rank = hits[growth.from_second_end ? 1 : 0].point.label;
  return growth;
}

float slenderness(const StemPiece& stem) {
  return stem.extent / std::max({stem.ends[0].radius, stem.ends[1].radius, 1e-4f * stem.extent});
}

Limb limb_of_stem(const StemPiece& stem, const Growth& growth, float flexibility, Random random) {
  const glm::vec3 base = stem.ends[growth.from_second_end ? 1 : 0].middle;
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

/// Limbs from the larger stems; returns the limb of every piece of wood.
std::vector<std::uint32_t> limbs_of_wood(LimbMesh& mesh, const FlatMesh& flat, const Wood& wood,
                                         const NearestPoints& samples, std::uint64_t seed) {
  const std::size_t count = wood.stems.size();
  std::size_t limbs = 0;
  while (limbs < std::min(count, most_limbs) &&
         wood.stems[wood.by_extent[limbs]].extent > shortest_limb * flat.height()) {
    ++limbs;
  }
  float mean_slenderness = 0;
  for (std::size_t r = 0; r < limbs; ++r) {
    mean_slenderness += slenderness(wood.stems[wood.by_extent[r]]) / static_cast<float>(limbs);
  }
  std::vector<std::uint32_t> limb_of_rank(count), limb_of_piece(count);
  for (std::uint32_t r = 0; r < count; ++r) {
    const StemPiece& stem = wood.stems[wood.by_extent[r]];
    const Growth growth = find_growth(flat, stem, r, samples);
    if (r < limbs) {
      limb_of_rank[r] = r;
      mesh.limbs.push_back(
          limb_of_stem(stem, growth, slenderness(stem) / mean_slenderness, Random(seed, stream_of("limb"), r)));
      if (!growth.on_ground) mesh.limbs.back().parent = static_cast<std::int32_t>(limb_of_rank[growth.parent_rank]);
    } else {
      limb_of_rank[r] = limb_of_rank[growth.parent_rank];
    }
    limb_of_piece[wood.by_extent[r]] = limb_of_rank[r];
  }
  return limb_of_piece;
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
  const Pieces pieces = connected_pieces(flat.positions, flat.foliage);
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
  const NearestPoints samples = sample_wood(flat, wood);
  std::vector<std::uint32_t> limb_of_piece(wood.stems.size(), 0);
  if (wood.stems[wood.by_extent[0]].extent > shortest_trunk * flat.height()) {
    limb_of_piece = limbs_of_wood(mesh, flat, wood, samples, seed);
  } else {
    mesh.limbs.push_back(single_trunk(flat));
  }
  for (std::size_t i = 0; i < wood.pieces.vertices.size(); ++i) {
    const std::uint32_t vertex = wood.pieces.vertices[i];
    mesh.limb[vertex] = limb_of_piece[wood.pieces.of_vertex[vertex]];
  }
  std::vector<std::uint32_t> limb_of_rank(wood.stems.size());
  for (std::size_t r = 0; r < limb_of_rank.size(); ++r) limb_of_rank[r] = limb_of_piece[wood.by_extent[r]];
  attach_foliage(mesh, flat, &samples, limb_of_rank, seed);
  return mesh;
}

}  // namespace understory
