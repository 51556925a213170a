#include "sim/plants/limb_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/error.hpp"

namespace understory {
namespace {

constexpr std::uint32_t unused = 0xffffffffu;

bool has_area(const LimbMesh& mesh, const std::uint32_t* corner) {
  const glm::vec3 a = mesh.positions[corner[0]], b = mesh.positions[corner[1]], c = mesh.positions[corner[2]];
  const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  return glm::dot(normal, normal) > 0;
}

/// Triangles of one class that have an area, ordered by limb; the order within a limb is kept.
std::vector<std::uint32_t> ordered_by_limb(const LimbMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t first = 0; first + 2 < triangles.size(); first += 3) {
    if (has_area(mesh, &triangles[first])) order.push_back(first);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return mesh.limb[triangles[a]] < mesh.limb[triangles[b]]; });
  std::vector<std::uint32_t> sorted;
  sorted.reserve(3 * order.size());
  for (std::uint32_t first : order) sorted.insert(sorted.end(), &triangles[first], &triangles[first] + 3);
  return sorted;
}

/// Used vertices ordered by limb, and within a limb by first use, so that neighbours in a run are neighbours in memory.
std::vector<std::uint32_t> vertex_order(const LimbMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  std::vector<bool> seen(mesh.positions.size(), false);
  std::vector<std::uint32_t> order;
  for (std::uint32_t vertex : triangles) {
    if (!seen[vertex]) order.push_back(vertex);
    seen[vertex] = true;
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return mesh.limb[a] < mesh.limb[b]; });
  return order;
}

float largest_component(const std::vector<glm::vec3>& vectors) {
  float largest = 0;
  for (glm::vec3 v : vectors) largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest;
}

/// Appends a vertex to the blocks. `inverse_step`: 127 / flutter_scale, or 0.
void push_vertex(VertexBlocks& blocks, const LimbMesh& mesh, std::uint32_t vertex, float inverse_step) {
  const glm::vec3 p = mesh.positions[vertex], flutter = glm::round(mesh.flutter[vertex] * inverse_step);
  if (blocks.x.size() % vertex_block == 0) blocks.block_limb.push_back(mesh.limb[vertex]);
  blocks.x.push_back(p.x);
  blocks.y.push_back(p.y);
  blocks.z.push_back(p.z);
  blocks.flutter_x.push_back(static_cast<std::int8_t>(flutter.x));
  blocks.flutter_y.push_back(static_cast<std::int8_t>(flutter.y));
  blocks.flutter_z.push_back(static_cast<std::int8_t>(flutter.z));
  blocks.flutter_phase.push_back(mesh.flutter_phase[vertex]);
}

}  // namespace

std::uint32_t LimbMesh::add_vertex(glm::vec3 position, std::uint32_t of_limb, glm::vec3 at_full_flutter,
                                   std::uint8_t phase) {
  positions.push_back(position);
  limb.push_back(of_limb);
  flutter.push_back(at_full_flutter);
  flutter_phase.push_back(phase);
  return static_cast<std::uint32_t>(positions.size() - 1);
}

void measure_reach(LimbMesh& mesh) {
  const auto wood = mesh.triangles.find(SurfaceClass::wood);
  if (wood == mesh.triangles.end()) return;
  for (std::uint32_t vertex : wood->second) {
    Limb& limb = mesh.limbs[mesh.limb[vertex]];
    const glm::vec3 offset = mesh.positions[vertex] - limb.base;
    limb.reach = std::max(limb.reach, glm::length(offset - glm::dot(offset, limb.axis) * limb.axis));
  }
}

Prototype assemble(const std::string& name, const LimbMesh& mesh) {
  Prototype prototype;
  prototype.name = name;
  prototype.limbs = mesh.limbs;
  for (const auto& [surface, triangles] : mesh.triangles) {
    const std::vector<std::uint32_t> sorted = ordered_by_limb(mesh, triangles);
    if (sorted.empty()) continue;
    prototype.runs.push_back({surface, prototype.triangle_count(), static_cast<std::uint32_t>(sorted.size() / 3)});
    prototype.triangles.insert(prototype.triangles.end(), sorted.begin(), sorted.end());
  }
  if (prototype.triangles.empty()) {
    throw Error(ErrorKind::invalid_input, name + ": no triangle with an area; a mesh needs at least one");
  }

  prototype.flutter_scale = largest_component(mesh.flutter);
  const float inverse_step = prototype.flutter_scale > 0 ? 127 / prototype.flutter_scale : 0;
  VertexBlocks& blocks = prototype.vertices;
  std::vector<std::uint32_t> new_index(mesh.positions.size(), unused);
  const std::vector<std::uint32_t> order = vertex_order(mesh, prototype.triangles);
  prototype.low = prototype.high = mesh.positions[order.front()];
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t vertex = order[i];
    new_index[vertex] = static_cast<std::uint32_t>(blocks.x.size());
    push_vertex(blocks, mesh, vertex, inverse_step);
    prototype.low = glm::min(prototype.low, mesh.positions[vertex]);
    prototype.high = glm::max(prototype.high, mesh.positions[vertex]);
    const bool last_of_limb = i + 1 == order.size() || mesh.limb[order[i + 1]] != mesh.limb[vertex];
    while (last_of_limb && blocks.x.size() % vertex_block != 0) push_vertex(blocks, mesh, vertex, inverse_step);
  }
  for (std::uint32_t& index : prototype.triangles) index = new_index[index];
  return prototype;
}

}  // namespace understory
