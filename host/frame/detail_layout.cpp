#include "host/frame/detail_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "host/frame/geometry.hpp"
#include "host/frame/spread_order.hpp"
#include "sim/plants/pieces.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr std::uint32_t leaf_blocks = 2, unit_vertices = leaf_blocks * vertex_block;  // of whole leaves
constexpr std::size_t most_of_a_leaf = 4;   // triangles: one of more would be too unlike its leaf
constexpr double widest_twig = 0.03;        // m at scale 1: thicker wood keeps its shape
constexpr std::size_t least_triangles = 9;  // of a twig that is worth it

/// Consecutive triangles of a run that are one leaf, one twig, or any other connected surface.
struct Piece {
  std::vector<std::uint32_t> triangles;  // in Prototype::triangles / 3
  std::vector<std::uint32_t> vertices;   // in order of first use
};

/// The one triangle that stands for a leaf or a twig far away.
struct FarPiece {
  std::array<std::uint32_t, 3> vertices;  // of the prototype, as which its corners move
  std::array<glm::vec3, 3> places;        // at rest, m
  std::uint32_t source = no_source;
};

std::vector<glm::vec3> rest_positions(const VertexBlocks& v) {
  std::vector<glm::vec3> positions(v.x.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = {v.x[i], v.y[i], v.z[i]};
  return positions;
}

glm::vec3 middle_of(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& vertices) {
  glm::vec3 sum(0);
  for (const std::uint32_t vertex : vertices) sum += positions[vertex];
  return sum / static_cast<float>(vertices.size());
}

/// One prototype on its way into the layout.
class PrototypeLayout {
 public:
  PrototypeLayout(const Prototype& prototype, const std::uint32_t* run_starts, bool thinned, DetailLayout& layout)
      : thinned_(thinned),
        prototype_(prototype),
        run_starts_(run_starts),
        layout_(layout),
        sections_(layout.sections.emplace_back()),
        positions_(rest_positions(prototype.vertices)) {}

  void add_runs() {
    for (std::uint32_t run = 0; run < prototype_.runs.size(); ++run)
      for (auto& [limb, pieces] : pieces_by_limb(prototype_.runs[run])) {
        const SurfaceClass surface = prototype_.runs[run].surface;
        if (surface == SurfaceClass::leaf)
          add_leaves(run, limb, pieces);
        else if (surface == SurfaceClass::wood)
          add_wood(run, limb, pieces);
        else
          add_section(run, limb, pieces);
      }
  }

 private:
  std::map<std::uint32_t, std::vector<Piece>> pieces_by_limb(const TriangleRun& run) const {
    const std::vector<std::uint32_t> corners(prototype_.triangles.begin() + 3 * std::ptrdiff_t{run.first},
                                             prototype_.triangles.begin() + 3 * std::ptrdiff_t{run.first + run.count});
    // Surfaces that are neither leaves nor wood are not taken apart.
    const bool whole = run.surface != SurfaceClass::leaf && run.surface != SurfaceClass::wood;
    const Pieces connected = whole ? Pieces{} : connected_pieces(positions_, corners);
    std::map<std::uint32_t, std::vector<Piece>> limbs;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> place;  // (limb, piece) -> in limbs[limb]
    std::vector<char> seen(positions_.size(), 0);
    for (std::uint32_t t = 0; t < run.count; ++t) {
      const std::uint32_t* corner = &corners[3 * std::size_t{t}];
      const std::uint32_t limb = prototype_.vertices.block_limb[corner[0] / vertex_block];
      std::vector<Piece>& pieces = limbs[limb];
      const auto key = std::make_pair(limb, whole ? 0u : connected.of_vertex[corner[0]]);
      const auto [found, is_new] = place.try_emplace(key, pieces.size());
      if (is_new) pieces.emplace_back();
      Piece& piece = pieces[found->second];
      piece.triangles.push_back(run.first + t);
      for (int k = 0; k < 3; ++k)
        if (!seen[corner[k]]) seen[corner[k]] = 1, piece.vertices.push_back(corner[k]);
    }
    return limbs;
  }

  void add_leaves(std::uint32_t run, std::uint32_t limb, std::vector<Piece>& pieces) {
    const auto large = std::stable_partition(pieces.begin(), pieces.end(), [](const Piece& piece) {
      return piece.triangles.size() <= unit_triangles && piece.vertices.size() <= unit_vertices;
    });
    std::vector<Piece> leaves(pieces.begin(), large), others(large, pieces.end());
    // The order in which leaves go: fixed, and independent of where a plant stands.
    std::vector<glm::vec3> middles;
    for (const Piece& leaf : leaves) middles.push_back(middle_of(positions_, leaf.vertices));
    std::vector<const Piece*> ordered;
    for (const std::size_t i : spread_order(middles, limb)) ordered.push_back(&leaves[i]);
    if (!leaves.empty()) {
      const std::size_t whole = add_whole_leaves(run, limb, ordered);
      const bool simple = std::all_of(leaves.begin(), leaves.end(),
                                      [](const Piece& leaf) { return leaf.triangles.size() <= most_of_a_leaf; });
      if (thinned_ && simple) {
        sections_[whole].far = static_cast<std::int32_t>(sections_.size());
        DetailSection far = begin_section(run, limb);
        far.thins = true;
        far.size = sections_[whole].size;
        std::vector<FarPiece> triangles;
        for (const Piece* leaf : ordered) triangles.push_back(far_leaf(run, *leaf));
        add_far_pieces(far, triangles);
      }
    }
    if (!others.empty()) add_section(run, limb, others);
  }

  /// The number of its section.
  std::size_t add_whole_leaves(std::uint32_t run, std::uint32_t limb, const std::vector<const Piece*>& leaves) {
    DetailSection section = begin_section(run, limb);
    section.thins = true;
    section.unit_blocks = leaf_blocks;
    double area = 0;
    for (const Piece* leaf : leaves) {
      if (layout_.a.size() % unit_triangles + leaf->triangles.size() > unit_triangles ||
          unit_vertices_used(section) + leaf->vertices.size() > unit_vertices)
        fill_unit(section);
      const glm::vec3 middle = middle_of(positions_, leaf->vertices);
      add_piece(section, *leaf, &middle);
      area += area_of(*leaf);
      for (const std::uint32_t v : leaf->vertices)
        section.piece_radius = std::max(section.piece_radius, glm::distance(positions_[v], middle));
      if (layout_.a.size() % unit_triangles == 0) fill_unit(section);
    }
    fill_unit(section);
    section.size = static_cast<float>(std::sqrt(area / static_cast<double>(leaves.size())));
    end_section(section);
    return sections_.size() - 1;
  }

  /// A triangle for a leaf, with the area of the whole leaf: a quarter of the vertices and half of the triangles are
  /// saved. Large triangles of a leaf are taken more often, so that as much area faces every way as before.
  FarPiece far_leaf(std::uint32_t run, const Piece& leaf) const {
    const std::uint32_t triangle = triangle_by_area(leaf);
    const std::uint32_t* corner = &prototype_.triangles[3 * std::size_t{triangle}];
    const glm::vec3 middle = (positions_[corner[0]] + positions_[corner[1]] + positions_[corner[2]]) / 3.0f;
    const auto growth = static_cast<float>(std::sqrt(area_of(leaf) / area_of(triangle)));
    FarPiece far;
    for (std::size_t k = 0; k < 3; ++k) {
      far.vertices[k] = corner[k];
      far.places[k] = middle + growth * (positions_[corner[k]] - middle);
    }
    far.source = source_of(run, triangle);
    return far;
  }

  /// 16 pieces after 16, in units whose corners a, b and c stand in a block each.
  void add_far_pieces(DetailSection section, const std::vector<FarPiece>& pieces) {
    section.is_far = true;
    section.unit_blocks = 3;
    for (std::size_t first = 0; first < pieces.size(); first += unit_triangles) {
      const std::uint32_t vertex = next_vertex(section);
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = first; l < first + unit_triangles; ++l) {
          const FarPiece& piece = pieces[std::min(l, pieces.size() - 1)];
          const glm::vec3 middle = (piece.places[0] + piece.places[1] + piece.places[2]) / 3.0f;
          const glm::vec3 place = l < pieces.size() ? piece.places[k] : middle;  // the unit's other triangles: no area
          add_vertex(piece.vertices[l < pieces.size() ? k : 0], place, middle);
          section.piece_radius = std::max(section.piece_radius, glm::distance(place, middle));
        }
      for (std::uint32_t l = 0; l < unit_triangles; ++l)
        add_triangle(vertex + l, vertex + unit_triangles + l, vertex + 2 * unit_triangles + l,
                     first + l < pieces.size() ? pieces[first + l].source : no_source);
    }
    end_section(section);
  }

  /// Drawn by chance, with the share that each has of the leaf's area.
  std::uint32_t triangle_by_area(const Piece& leaf) const {
    double left = static_cast<double>(mix_bits(~std::uint64_t{leaf.triangles.front()}) >> 11) * 0x1p-53 * area_of(leaf);
    for (const std::uint32_t t : leaf.triangles)
      if ((left -= area_of(t)) < 0) return t;
    return leaf.triangles.back();
  }

  void add_wood(std::uint32_t run, std::uint32_t limb, std::vector<Piece>& pieces) {
    const Pieces connected = [&] {
      Pieces all;
      all.first.push_back(0);
      for (const Piece& piece : pieces) {
        all.vertices.insert(all.vertices.end(), piece.vertices.begin(), piece.vertices.end());
        all.first.push_back(static_cast<std::uint32_t>(all.vertices.size()));
      }
      return all;
    }();
    std::vector<Piece> boughs, twigs;
    std::vector<FarPiece> far_twigs;
    double diameters = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const StemPiece stem = measure_stem(positions_, connected, i);
      const double diameter = 2 * double(std::max(stem.ends[0].radius, stem.ends[1].radius));
      if (pieces[i].triangles.size() < least_triangles || diameter > widest_twig ||
          double(stem.extent) < 4 * diameter) {
        boughs.push_back(std::move(pieces[i]));
        continue;
      }
      diameters += diameter;
      far_twigs.push_back(far_twig(run, pieces[i], stem));
      twigs.push_back(std::move(pieces[i]));
    }
    if (!boughs.empty()) add_section(run, limb, boughs);
    if (twigs.empty()) return;
    add_section(run, limb, twigs);
    if (!thinned_) return;
    DetailSection& full = sections_.back();
    full.size = static_cast<float>(diameters / static_cast<double>(twigs.size()));
    full.far = static_cast<std::int32_t>(sections_.size());
    add_far_pieces(begin_section(run, limb), far_twigs);
  }

  /// A triangle for a twig, from two places about its thick end to the vertex farthest from them, so wide that it has
  /// half of the twig's surface. A flat face turned at random about the twig shows as much of itself, and turned the
  /// same ways, as what is seen of the twig: the mean over all directions of a convex body's projection is a quarter of
  /// its surface (Cauchy), that of a flat piece half of its area.
  FarPiece far_twig(std::uint32_t run, const Piece& twig, const StemPiece& stem) const {
    const int thick = stem.ends[0].radius >= stem.ends[1].radius ? 0 : 1;
    const glm::vec3 foot = stem.ends[thick].middle, tip = stem.ends[1 - thick].middle;
    const float reach = 1.5f * stem.ends[thick].radius;
    std::vector<std::uint32_t> ring;
    for (const std::uint32_t v : twig.vertices)
      if (glm::distance(positions_[v], foot) <= reach) ring.push_back(v);
    if (ring.size() < 3) ring.assign(twig.vertices.begin(), twig.vertices.begin() + 3);
    const std::size_t chosen = mix_bits(~std::uint64_t{twig.triangles.front()}) % ring.size();
    const std::uint32_t a = ring[chosen], b = ring[(chosen + ring.size() / 3) % ring.size()];
    const std::uint32_t last = *std::min_element(twig.vertices.begin(), twig.vertices.end(), [&](auto p, auto q) {
      return glm::distance(positions_[p], tip) < glm::distance(positions_[q], tip);
    });
    const glm::vec3 base = 0.5f * (positions_[a] + positions_[b]), along = positions_[last] - base;
    const float length = glm::length(along);
    glm::vec3 across = glm::cross(along, glm::cross(positions_[a] - positions_[b], along));
    if (glm::length(across) < 1e-3f * length * length * stem.ends[thick].radius)  // a and b lie along the twig
      across = glm::cross(along, std::abs(along.z) < 0.9f * length ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0));
    const glm::vec3 half =
        length > 0 ? static_cast<float>(0.5 * area_of(twig)) / length * glm::normalize(across) : glm::vec3(0);
    FarPiece far;
    far.vertices = {a, b, last};
    far.places = {base + half, base - half, positions_[last]};
    far.source = source_of(run, twig.triangles.front());
    return far;
  }

  void add_section(std::uint32_t run, std::uint32_t limb, const std::vector<Piece>& pieces) {
    DetailSection section = begin_section(run, limb);
    for (const Piece& piece : pieces) add_piece(section, piece, nullptr);
    fill_up(section);
    end_section(section);
  }

  DetailSection begin_section(std::uint32_t run, std::uint32_t limb) const {
    DetailSection section;
    section.run = run;
    section.limb = limb;
    section.first_block = static_cast<std::uint32_t>(layout_.vertices.x.size() / vertex_block);
    section.first_triangle = static_cast<std::uint32_t>(layout_.a.size());
    return section;
  }

  void end_section(DetailSection& section) {
    const VertexBlocks& v = layout_.vertices;
    section.blocks = static_cast<std::uint32_t>(v.x.size() / vertex_block) - section.first_block;
    section.triangles = static_cast<std::uint32_t>(layout_.a.size()) - section.first_triangle;
    layout_.vertices.block_limb.resize(v.x.size() / vertex_block, section.limb);
    const std::size_t first = std::size_t{section.first_block} * vertex_block;
    glm::vec3 low(v.x[first], v.y[first], v.z[first]), high = low;
    for (std::size_t i = first; i < v.x.size(); ++i) {
      low = glm::min(low, glm::vec3(v.x[i], v.y[i], v.z[i]));
      high = glm::max(high, glm::vec3(v.x[i], v.y[i], v.z[i]));
    }
    section.centre = 0.5f * (low + high);
    for (std::size_t i = first; i < v.x.size(); ++i)
      section.radius = std::max(section.radius, glm::distance(section.centre, glm::vec3(v.x[i], v.y[i], v.z[i])));
    section.radius += std::sqrt(3.0f) * prototype_.flutter_scale;
    sections_.push_back(section);
  }

  void add_piece(const DetailSection& section, const Piece& piece, const glm::vec3* pivot) {
    const std::uint32_t first = next_vertex(section);
    for (std::uint32_t i = 0; i < piece.vertices.size(); ++i) {
      new_index_[piece.vertices[i]] = first + i;
      const glm::vec3 place = positions_[piece.vertices[i]];
      add_vertex(piece.vertices[i], place, pivot ? *pivot : place);
    }
    for (const std::uint32_t t : piece.triangles) {
      const std::uint32_t* corner = &prototype_.triangles[3 * std::size_t{t}];
      add_triangle(new_index_[corner[0]], new_index_[corner[1]], new_index_[corner[2]], source_of(section.run, t));
    }
  }

  std::uint32_t next_vertex(const DetailSection& section) const {
    return static_cast<std::uint32_t>(layout_.vertices.x.size()) - section.first_block * vertex_block;
  }
  std::uint32_t unit_vertices_used(const DetailSection& section) const { return next_vertex(section) % unit_vertices; }
  std::uint32_t source_of(std::uint32_t run, std::uint32_t triangle) const {
    return run_starts_[run] + triangle - prototype_.runs[run].first;
  }

  double area_of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::dvec3 from(positions_[a]), u = glm::dvec3(positions_[b]) - from, v = glm::dvec3(positions_[c]) - from;
    return 0.5 * glm::length(glm::cross(u, v));
  }
  double area_of(std::uint32_t triangle) const {
    const std::uint32_t* corner = &prototype_.triangles[3 * std::size_t{triangle}];
    return area_of(corner[0], corner[1], corner[2]);
  }

  double area_of(const Piece& piece) const {
    double area = 0;
    for (const std::uint32_t t : piece.triangles) area += area_of(t);
    return area;
  }

  /// A vertex that flutters as `vertex` of the prototype, at `place`.
  void add_vertex(std::uint32_t vertex, glm::vec3 place, glm::vec3 pivot) {
    const VertexBlocks& from = prototype_.vertices;
    VertexBlocks& to = layout_.vertices;
    to.x.push_back(place.x);
    to.y.push_back(place.y);
    to.z.push_back(place.z);
    to.flutter_x.push_back(from.flutter_x[vertex]);
    to.flutter_y.push_back(from.flutter_y[vertex]);
    to.flutter_z.push_back(from.flutter_z[vertex]);
    to.flutter_phase.push_back(from.flutter_phase[vertex]);
    layout_.pivot_x.push_back(pivot.x);
    layout_.pivot_y.push_back(pivot.y);
    layout_.pivot_z.push_back(pivot.z);
    last_vertex_ = vertex;
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t source) {
    layout_.a.push_back(a);
    layout_.b.push_back(b);
    layout_.c.push_back(c);
    layout_.source.push_back(source);
  }

  /// The unit's remaining triangles get no area, its remaining vertices repeat the last one.
  void fill_unit(const DetailSection& section) {
    fill_up(section);
    while (unit_vertices_used(section) != 0)
      add_vertex(last_vertex_, positions_[last_vertex_], positions_[last_vertex_]);
  }

  void fill_up(const DetailSection& section) {
    const std::uint32_t corner = next_vertex(section) - 1;
    while (layout_.a.size() % unit_triangles != 0) add_triangle(corner, corner, corner, no_source);
    while (layout_.vertices.x.size() % vertex_block != 0)
      add_vertex(last_vertex_, positions_[last_vertex_], positions_[last_vertex_]);
  }

  bool thinned_;
  const Prototype& prototype_;
  const std::uint32_t* run_starts_;
  DetailLayout& layout_;
  std::vector<DetailSection>& sections_;
  std::vector<glm::vec3> positions_;
  std::vector<std::uint32_t> new_index_ = std::vector<std::uint32_t>(positions_.size());
  std::uint32_t last_vertex_ = 0;
};

}  // namespace

DetailLayout lay_out_detail(const World& world, bool thinned) {
  DetailLayout layout;
  const std::vector<std::uint32_t> run_starts = first_triangles(world);
  std::size_t first_run = 0;
  layout.sections.reserve(world.prototypes.size());
  for (const Prototype& prototype : world.prototypes) {
    PrototypeLayout(prototype, run_starts.data() + first_run, thinned, layout).add_runs();
    first_run += prototype.runs.size();
  }
  return layout;
}

}  // namespace understory
