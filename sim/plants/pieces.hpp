// The connected pieces of a mesh, and what a piece of wood tells about its growth: two ends, one of them thicker.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace understory {

/// Vertices grouped by piece: piece p has vertices[first[p]] .. vertices[first[p + 1] - 1], in rising order.
struct Pieces {
  std::vector<std::uint32_t> of_vertex;  // piece of each vertex; `no_piece` for vertices without triangle
  std::vector<std::uint32_t> vertices, first;
  std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
};
/// Tolerance as a share of a plant's height: files that write triangles one by one round their corners apart.
inline constexpr float same_corner = 1e-5f;
inline constexpr std::uint32_t no_piece = 0xffffffffu;

/// Triangles belong to one piece that share a vertex or a position, or have corners that differ by `tolerance` (m) at
/// most in each coordinate. Numbered by their lowest vertex. Positions must be finite.
Pieces connected_pieces(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& triangles,
                        float tolerance = 0);

/// An end of a stem: the middle of its outermost vertices and their mean distance from it, m.
struct StemEnd {
  glm::vec3 middle{0};
  float radius = 0;
};

struct StemPiece {
  StemEnd ends[2];
  glm::vec3 foot{0};  // middle of its lowest vertices, m
  float extent = 0;   // m, between the ends
};

/// The ends of a piece: its vertices near the two points that lie farthest apart (found in two sweeps).
StemPiece measure_stem(const std::vector<glm::vec3>& positions, const Pieces& pieces, std::size_t piece);

}  // namespace understory
