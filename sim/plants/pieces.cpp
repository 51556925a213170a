#include "sim/plants/pieces.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace understory {
namespace {

/// Disjoint sets with the lowest member as the root.
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
    return member;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Joins vertices no further apart than `tolerance`, m, in any coordinate.
void join_near_positions(const std::vector<glm::vec3>& positions, const std::vector<bool>& used, float tolerance,
                         Sets& sets) {
  // Along an axis that meshes hardly ever lie square to, so that few vertices are level with one another.
  const glm::vec3 sweep(0.267f, 0.535f, 0.802f);
  struct Vertex {
    float along;
    glm::vec3 position;
    std::uint32_t number;
  };
  std::vector<Vertex> order;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (used[i]) order.push_back({glm::dot(sweep, positions[i]), positions[i], i});
  }
  std::sort(order.begin(), order.end(), [](const Vertex& a, const Vertex& b) {
    return std::tie(a.along, a.position.x, a.position.y, a.position.z, a.number) <
           std::tie(b.along, b.position.x, b.position.y, b.position.z, b.number);
  });
  // Many vertices at one position count once.
  std::size_t places = 0;
  for (const Vertex& vertex : order) {
    if (places > 0 && order[places - 1].position == vertex.position) {
      sets.join(order[places - 1].number, vertex.number);
    } else {
      order[places++] = vertex;
    }
  }
  const float window = tolerance * (sweep.x + sweep.y + sweep.z);
  for (std::size_t i = 0; i < places; ++i) {
    for (std::size_t k = i + 1; k < places && order[k].along - order[i].along <= window; ++k) {
      const glm::vec3 apart = glm::abs(order[k].position - order[i].position);
      if (std::max({apart.x, apart.y, apart.z}) <= tolerance) sets.join(order[i].number, order[k].number);
    }
  }
}

template <typename Distance>
std::uint32_t farthest(const std::uint32_t* first, const std::uint32_t* last, Distance distance) {
  return *std::max_element(first, last, [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
}

}  // namespace

Pieces connected_pieces(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& triangles,
                        float tolerance) {
  Sets sets(positions.size());
  std::vector<bool> used(positions.size(), false);
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    sets.join(triangles[i], triangles[i + 1]);
    sets.join(triangles[i], triangles[i + 2]);
    for (std::size_t k = 0; k < 3; ++k) used[triangles[i + k]] = true;
  }
  join_near_positions(positions, used, tolerance, sets);

  Pieces pieces;
  pieces.of_vertex.assign(positions.size(), no_piece);
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (!used[i]) continue;
    const std::uint32_t root = sets.root(i);  // root <= i, so it has its number already
    if (root == i) pieces.of_vertex[i] = static_cast<std::uint32_t>(sizes.size()), sizes.push_back(0);
    pieces.of_vertex[i] = pieces.of_vertex[root];
    ++sizes[pieces.of_vertex[i]];
  }
  pieces.first.assign(1, 0);
  for (std::uint32_t size : sizes) pieces.first.push_back(pieces.first.back() + size);
  pieces.vertices.resize(pieces.first.back());
  std::vector<std::uint32_t> next(pieces.first.begin(), pieces.first.end() - 1);
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (pieces.of_vertex[i] != no_piece) pieces.vertices[next[pieces.of_vertex[i]]++] = i;
  }
  return pieces;
}

StemPiece measure_stem(const std::vector<glm::vec3>& positions, const Pieces& pieces, std::size_t piece) {
  const std::uint32_t* first = pieces.vertices.data() + pieces.first[piece];
  const std::uint32_t* last = pieces.vertices.data() + pieces.first[piece + 1];
  const auto from = [&](glm::vec3 p) {
    return [&positions, p](std::uint32_t i) { return glm::distance(positions[i], p); };
  };
  const glm::vec3 one = positions[farthest(first, last, from(positions[*first]))];
  const glm::vec3 other = positions[farthest(first, last, from(one))];
  StemPiece stem;
  stem.extent = glm::distance(one, other);
  const float near = 0.04f * stem.extent;  // along the stem: the outermost ring of a tube, and no second one
  const glm::vec3 axis = stem.extent > 0 ? (other - one) / stem.extent : glm::vec3(0, 0, 1);
  for (int e = 0; e < 2; ++e) {
    const glm::vec3 end = e == 0 ? one : other;
    std::vector<glm::vec3> ring;
    for (const std::uint32_t* i = first; i < last; ++i) {
      if (std::abs(glm::dot(positions[*i] - end, axis)) <= near) ring.push_back(positions[*i]);
    }
    for (glm::vec3 position : ring) stem.ends[e].middle += position / static_cast<float>(ring.size());
    for (glm::vec3 position : ring) {
      stem.ends[e].radius += glm::distance(position, stem.ends[e].middle) / static_cast<float>(ring.size());
    }
  }
  const float lowest = positions[*std::min_element(first, last, [&](std::uint32_t a, std::uint32_t b) {
                         return positions[a].z < positions[b].z;
                       })].z;
  float count = 0;
  for (const std::uint32_t* i = first; i < last; ++i) {
    if (positions[*i].z <= lowest + 0.01f * stem.extent) stem.foot += positions[*i], ++count;
  }
  stem.foot /= count;
  return stem;
}

}  // namespace understory
