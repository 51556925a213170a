#include "bench/grid_receivers.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <map>

#include "sim/occluder_motion.hpp"
#include "sim/occlusion_grid.hpp"

namespace understory {
namespace {

/// One rigid part at the frame's time.
struct PosedPart {
  Transform pose;
  Box box, near;    // of its grid, and of one of epsilon 0.02, in its own frame, m
  double cell = 0;  // m, the longest that meets the body
};

/// Longest cell of a grid that meets the body in it: cells grow away from the middle.
double longest_cell(const Box& body, const Box& grid, const GridChoice& choice) {
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * (grid.high[axis] - grid.low[axis]), more = choice.stretch;
    const double u = 0.5 * (body.high[axis] - body.low[axis]) / half, sparse = (1 + more * u) * (1 + more * u);
    longest = std::max(longest, 2 * half / (choice.size - 1) * sparse / (1 + more));
  }
  return longest;
}

std::vector<PosedPart> posed_parts(const World& world, double time) {
  std::vector<PosedPart> parts;
  const GridChoice& choice = world.scene.methods.grid;
  for (const Instance& instance : world.instances) {
    if (instance.role != Instance::Role::occluder) continue;
    const VertexBlocks& vertices = world.prototypes[instance.prototype].vertices;
    const std::vector<Transform> poses = occluder_parts_at(world, instance.occluder, time);
    std::vector<Box> boxes(poses.size(), {glm::dvec3(1e30), glm::dvec3(-1e30)});
    for (std::size_t v = 0; v < vertices.x.size(); ++v) {
      Box& box = boxes[vertices.block_limb[v / vertex_block]];
      const glm::dvec3 p(vertices.x[v], vertices.y[v], vertices.z[v]);
      box = {glm::min(box.low, p), glm::max(box.high, p)};
    }
    for (std::size_t part = 0; part < poses.size(); ++part) {
      const Box grid = grid_extent(boxes[part], choice.epsilon);
      parts.push_back({poses[part], grid, grid_extent(boxes[part], 0.02), longest_cell(boxes[part], grid, choice)});
    }
  }
  return parts;
}

bool inside(const PosedPart& part, const Box& box, glm::dvec3 p) {
  const glm::dvec3 own = glm::conjugate(part.pose.rotation) * (p - part.pose.translation);
  return glm::all(glm::greaterThan(own, box.low)) && glm::all(glm::lessThan(own, box.high));
}

/// Distance from a point to a triangle (Ericson 2005, "Real-Time Collision Detection", section 5.1.5).
double distance_to(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  const glm::dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return glm::length(ap);
  if (d3 >= 0 && d4 <= d3) return glm::length(bp);
  if (d6 >= 0 && d5 <= d6) return glm::length(cp);
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return glm::length(ap - d1 / (d1 - d3) * ab);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return glm::length(ap - d2 / (d2 - d6) * ac);
  if (va <= 0 && d4 >= d3 && d5 >= d6) return glm::length(bp - (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b));
  const double denominator = 1 / (va + vb + vc);
  return glm::length(ap - vb * denominator * ab - vc * denominator * ac);
}

std::vector<std::size_t> thinned(const std::vector<std::size_t>& all, std::size_t most) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < std::min(most, all.size()); ++i)
    kept.push_back(all[i * all.size() / std::min(most, all.size())]);
  return kept;
}

}  // namespace

std::vector<glm::vec3> occluder_corners(const Frame& frame, const PosedGeometry& geometry,
                                        std::vector<std::uint32_t>* owner) {
  std::vector<glm::vec3> corners;
  for (std::size_t t = 0; t < geometry.owner.size(); ++t) {
    if (frame.owners[geometry.owner[t]].surface != SurfaceClass::occluder) continue;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const float* p = geometry.positions.data() + 3 * std::size_t(geometry.triangles[3 * t + corner]);
      corners.emplace_back(p[0], p[1], p[2]);
    }
    if (owner) owner->push_back(geometry.owner[t]);
  }
  return corners;
}

GridReceivers grid_receivers(const World& world, const Frame& frame, const PosedGeometry& geometry, std::size_t most) {
  const std::vector<PosedPart> parts = posed_parts(world, frame.time);
  std::vector<std::uint32_t> owner;
  const std::vector<glm::vec3> corners = occluder_corners(frame, geometry, &owner);
  std::map<std::uint32_t, double> cell;  // of each owner; parts and owners come in the same order
  for (std::uint32_t row = 0, part = 0; row < frame.owners.size(); ++row)
    if (frame.owners[row].surface == SurfaceClass::occluder) cell[row] = parts.at(part++).cell;

  GridReceivers found;
  std::vector<std::size_t> terrain;
  const auto position = [&](std::size_t i) {
    return glm::dvec3(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
  };
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.owner[i] == 0) continue;
    const bool within =
        std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return inside(part, part.box, position(i)); });
    if (!within) continue;
    const SurfaceClass surface = frame.owners[frame.owner[i]].surface;
    if (surface == SurfaceClass::terrain) terrain.push_back(i);
    if (surface == SurfaceClass::occluder) found.bodies.push_back(i);
  }
  terrain = thinned(terrain, 8 * most);
  std::vector<std::uint8_t> touches(terrain.size(), 0);
  tbb::parallel_for(std::size_t{0}, terrain.size(), [&](std::size_t i) {
    const glm::dvec3 p = position(terrain[i]);
    for (std::size_t t = 0; t < owner.size() && !touches[i]; ++t)
      touches[i] = distance_to(p, glm::dvec3(corners[3 * t]), glm::dvec3(corners[3 * t + 1]),
                               glm::dvec3(corners[3 * t + 2])) < cell.at(owner[t]);
  });
  for (std::size_t i = 0; i < terrain.size(); ++i) (touches[i] ? found.contact : found.ground).push_back(terrain[i]);
  for (const std::size_t i : found.ground)
    if (std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return inside(part, part.near, position(i)); }))
      found.near.push_back(i);
  found.ground = thinned(found.ground, most);
  found.near = thinned(found.near, most);
  found.contact = thinned(found.contact, most);
  found.bodies = thinned(found.bodies, most);
  return found;
}

}  // namespace understory
