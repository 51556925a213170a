#include "host/frame/draw_list.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "host/frame/thinning.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

glm::dvec3 rows_times(const float (&m)[12], const glm::dvec3& p) {
  const auto row = [&](int r) {
    return double(m[4 * r]) * p.x + double(m[4 * r + 1]) * p.y + double(m[4 * r + 2]) * p.z + double(m[4 * r + 3]);
  };
  return {row(0), row(1), row(2)};
}

double along(const float (&axis)[4], const glm::dvec3& p) {
  return double(axis[0]) * p.x + double(axis[1]) * p.y + double(axis[2]) * p.z;
}

/// Blades at or before the middle of the ramp of `length` pixels, in three strips of fewer and fewer vertices.
std::uint32_t strip_pairs(double length_in_pixels) { return length_in_pixels > 24 ? 3 : length_in_pixels > 3 ? 2 : 1; }

BladeGroup measure_group(const GrassBlades& field, std::size_t first, std::size_t end, std::uint32_t first_blade) {
  BladeGroup group;
  group.first_blade = first_blade;
  group.blades = static_cast<std::uint32_t>(end - first);
  glm::dvec3 low(field.root_x[first], field.root_y[first], field.root_z[first]), high = low;
  double width = 0, length = 0, longest = 0;
  for (std::size_t i = first; i < end; ++i) {
    const glm::dvec3 root(field.root_x[i], field.root_y[i], field.root_z[i]);
    low = glm::min(low, root);
    high = glm::max(high, root);
    width += 2 * double(field.half_width[i]);
    length += double(field.length[i]);
    longest = std::max(longest, double(field.length[i]) + double(field.half_width[i]));
  }
  group.centre = 0.5 * (low + high);
  group.radius = static_cast<float>(0.5 * glm::length(high - low) + longest);
  group.width = static_cast<float>(width / group.blades);
  group.length = static_cast<float>(length / group.blades);
  return group;
}

}  // namespace

BladeLayout lay_out_blades(const World& world) {
  BladeLayout layout;
  std::uint32_t first_blade = 0;
  for (const GrassBlades& field : world.grass) {
    GrassBlades& blades = layout.fields.emplace_back(field);
    std::vector<BladeGroup>& groups = layout.groups.emplace_back();
    for (std::size_t first = 0; first < field.size(); first += blades_per_group) {
      const std::size_t end = std::min<std::size_t>(first + blades_per_group, field.size());
      std::vector<std::pair<std::uint64_t, std::size_t>> order;
      for (std::size_t i = first; i < end; ++i) order.emplace_back(mix_bits(i), i);
      std::sort(order.begin(), order.end());
      const std::vector<float>* from[] = {&field.root_x,      &field.root_y, &field.root_z, &field.length,
                                          &field.half_width,  &field.bend_x, &field.bend_y, &field.facing,
                                          &field.flexibility, &field.phase};
      std::vector<float>* to[] = {&blades.root_x,      &blades.root_y, &blades.root_z, &blades.length,
                                  &blades.half_width,  &blades.bend_x, &blades.bend_y, &blades.facing,
                                  &blades.flexibility, &blades.phase};
      for (std::size_t k = 0; k < order.size(); ++k)
        for (std::size_t plane = 0; plane < std::size(from); ++plane)
          (*to[plane])[first + k] = (*from[plane])[order[k].second];
      groups.push_back(measure_group(field, first, end, first_blade));
      first_blade += blades_per_group;
    }
  }
  return layout;
}

glm::vec4 posed_sphere(const LimbPose& limb, const DetailSection& section, double scale) {
  glm::dvec3 p = rows_times(limb.to_limb, glm::dvec3(section.centre));
  const double curvature = double(limb.curvature), angle = curvature * p.x;
  const double across = std::abs(p.y) + double(section.radius);
  if (std::abs(angle) > 1e-6) {
    const double sine = std::sin(angle), versine = 1 - std::cos(angle);
    p = {sine / curvature - p.y * sine, versine / curvature + p.y * (1 - versine), p.z};
  }
  const double radius = scale * double(section.radius) * (1 + std::abs(curvature) * across);
  return glm::vec4(glm::vec3(rows_times(limb.to_scene, p)), static_cast<float>(radius));
}

bool in_view(const CameraView& camera, const glm::dvec3& centre, double radius) {
  radius = 1.0001 * radius + 1e-4 * glm::length(centre);  // poses on the device are in float
  const double x = along(camera.right, centre), y = along(camera.down, centre), z = along(camera.forward, centre);
  if (z + radius < double(camera.near_plane)) return false;
  const double focal = double(camera.focal);
  // Signed distance to the plane through the eye and the image's edge `edge` pixels off the principal point.
  const auto inside = [&](double sideways, double edge) {
    return sideways * focal + edge * z >= -radius * std::hypot(focal, edge);
  };
  const double left = double(camera.centre_x) + 1, right = camera.width - double(camera.centre_x) + 1;
  const double top = double(camera.centre_y) + 1, bottom = camera.height - double(camera.centre_y) + 1;
  return inside(x, left) && inside(-x, right) && inside(y, top) && inside(-y, bottom);
}

struct DrawLister::Part {
  std::vector<PosedBlock> blocks;
  std::vector<float> block_scale;
  std::vector<TriangleChunk> chunks;  // first_vertex counts from the part's own
  std::uint64_t triangles = 0;
};

DrawLister::DrawLister(const World& world, const DetailLayout& layout, const BladeLayout& blades, bool thinned)
    : world_(world), layout_(layout), blades_(blades), thinned_(thinned) {}

void DrawLister::list_instance(std::size_t i, const Pose& pose, const CameraView& camera, Part& part) const {
  const Instance& instance = world_.instances[i];
  const std::vector<DetailSection>& sections = layout_.sections[instance.prototype];
  std::vector<float> areas;
  for (const DetailSection& candidate : sections) {
    if (candidate.is_coarse) continue;
    const std::uint32_t limb = pose.first_limb[i] + candidate.limb;
    const glm::vec4 sphere = posed_sphere(pose.limbs[limb], candidate, instance.scale);
    const glm::dvec3 centre(sphere);
    const double distance = std::max(glm::length(centre), double(camera.near_plane));
    const double pixels = double(candidate.size) * instance.scale * double(camera.focal) / distance;
    const DetailSection* section = &candidate;
    double grown = 0;  // how far enlarged leaves reach out of the sphere
    std::uint32_t units = section->triangles / unit_triangles;
    areas.clear();
    if (thinned_ && candidate.thins()) {
      thin(units, pixels * pixels / (leaf_pixels * leaf_pixels), areas);
      units = static_cast<std::uint32_t>(areas.size());
      grown = (std::sqrt(double(areas.front())) - 1) * double(section->piece_radius) * instance.scale;
    } else if (thinned_ && candidate.coarse >= 0 && pixels < twig_pixels) {
      section = &sections[static_cast<std::size_t>(candidate.coarse)];
      units = section->triangles / unit_triangles;
    }
    if (!in_view(camera, centre, double(sphere.w) + grown)) continue;

    const auto first_vertex = static_cast<std::uint32_t>(part.blocks.size() * vertex_block);
    const std::uint32_t blocks = areas.empty() ? section->blocks : units * unit_blocks;
    for (std::uint32_t block = 0; block < blocks; ++block) part.blocks.push_back({section->first_block + block, limb});
    if (thinned_)
      for (std::uint32_t block = 0; block < blocks; ++block)
        part.block_scale.push_back(areas.empty() ? 1.0f : std::sqrt(areas[block / unit_blocks]));
    const std::uint32_t triangles = units * unit_triangles;
    for (std::uint32_t done = 0; done < triangles; done += triangles_per_chunk)
      part.chunks.push_back({first_vertex, section->first_triangle + done,
                             std::min(triangles_per_chunk, triangles - done), instance.run_owner[section->run]});
    part.triangles += triangles;
  }
}

void DrawLister::gather(std::vector<Part>& parts) {
  std::vector<std::size_t> first_block(parts.size() + 1, 0), first_chunk(parts.size() + 1, 0);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    first_block[i + 1] = first_block[i] + parts[i].blocks.size();
    first_chunk[i + 1] = first_chunk[i] + parts[i].chunks.size();
    list_.triangles += parts[i].triangles;
  }
  list_.blocks.resize(first_block.back());
  list_.block_scale.resize(thinned_ ? first_block.back() : 0);
  list_.chunks.resize(first_chunk.back());
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
    const auto block = static_cast<std::ptrdiff_t>(first_block[i]), chunk = static_cast<std::ptrdiff_t>(first_chunk[i]);
    std::copy(parts[i].blocks.begin(), parts[i].blocks.end(), list_.blocks.begin() + block);
    std::copy(parts[i].block_scale.begin(), parts[i].block_scale.end(), list_.block_scale.begin() + block);
    for (TriangleChunk& c : parts[i].chunks)
      c.first_vertex += static_cast<std::uint32_t>(first_block[i] * vertex_block);
    std::copy(parts[i].chunks.begin(), parts[i].chunks.end(), list_.chunks.begin() + chunk);
  });
  list_.mesh_chunks = static_cast<std::uint32_t>(list_.chunks.size());
  list_.vertices = static_cast<std::uint32_t>(list_.blocks.size() * vertex_block);
}

void DrawLister::list_grass(const Pose& pose, const CameraView& camera) {
  list_.blade_units.clear();
  list_.first_unit.clear();
  std::vector<float> widths;
  for (std::size_t field = 0; field < blades_.fields.size(); ++field) {
    list_.first_unit.push_back(static_cast<std::uint32_t>(list_.blade_units.size()));
    for (const BladeGroup& group : blades_.groups[field]) {
      const glm::dvec3 centre = group.centre - pose.eye;
      if (!in_view(camera, centre, double(group.radius))) continue;
      const double scale = double(camera.focal) / std::max(glm::length(centre), double(camera.near_plane));
      const std::size_t all = (group.blades + blades_per_unit - 1) / blades_per_unit;
      thin(all, thinned_ ? double(group.width) * scale / blade_pixels : 2.0, widths);
      const std::uint32_t pairs = thinned_ ? strip_pairs(double(group.length) * scale) : 3;
      for (std::uint32_t unit = 0; unit < widths.size(); ++unit)
        list_.blade_units.push_back(
            {group.first_blade + unit * blades_per_unit, list_.vertices + unit * blades_per_unit, widths[unit], pairs});
      const auto count = std::min(group.blades, static_cast<std::uint32_t>(widths.size()) * blades_per_unit);
      for (std::uint32_t k = 0; k < 2 * pairs - 1; ++k)
        list_.chunks.push_back(
            {list_.vertices + k * blades_per_group, group.first_blade, count, blades_.fields[field].owner});
      list_.vertices += (2 * pairs + 1) * blades_per_group;
      list_.triangles += std::uint64_t{2 * pairs - 1} * count;
    }
  }
  list_.first_unit.push_back(static_cast<std::uint32_t>(list_.blade_units.size()));
}

const DrawList& DrawLister::list(const Pose& pose, const CameraView& camera) {
  list_.triangles = 0;
  std::vector<Part> parts(world_.instances.size());
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) { list_instance(i, pose, camera, parts[i]); });
  gather(parts);
  list_grass(pose, camera);
  return list_;
}

}  // namespace understory
