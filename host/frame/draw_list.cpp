#include "host/frame/draw_list.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "host/frame/spread_order.hpp"
#include "host/frame/thinning.hpp"

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

/// Pairs of vertices along a blade: bent by a radian, its middle lies an eighth of its length beside the chord, which
/// few pairs show where that is a pixel or two, and one where it is half of one.
std::uint32_t strip_pairs(double length_in_pixels) { return length_in_pixels > 24 ? 3 : length_in_pixels > 5 ? 2 : 1; }

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

void join(ListedSections& to, ListedSections& from, std::uint32_t first_limb) {
  const auto first_vertex = static_cast<std::uint32_t>(to.blocks.size() * vertex_block);
  for (PosedBlock& block : from.blocks) block.limb_pose += first_limb;
  for (TriangleChunk& chunk : from.chunks) chunk.first_vertex += first_vertex;
  to.blocks.insert(to.blocks.end(), from.blocks.begin(), from.blocks.end());
  to.block_scale.insert(to.block_scale.end(), from.block_scale.begin(), from.block_scale.end());
  to.chunks.insert(to.chunks.end(), from.chunks.begin(), from.chunks.end());
}

std::uint32_t first_triangle_after(const ListedSections& sections) {
  return static_cast<std::uint32_t>(sections.chunks.size()) * triangles_per_chunk;
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
      std::vector<glm::vec3> roots;
      for (std::size_t i = first; i < end; ++i) roots.emplace_back(field.root_x[i], field.root_y[i], field.root_z[i]);
      const std::vector<std::size_t> order = spread_order(roots, first);
      const std::vector<float>* from[] = {&field.root_x,      &field.root_y, &field.root_z, &field.length,
                                          &field.half_width,  &field.bend_x, &field.bend_y, &field.facing,
                                          &field.flexibility, &field.phase};
      std::vector<float>* to[] = {&blades.root_x,      &blades.root_y, &blades.root_z, &blades.length,
                                  &blades.half_width,  &blades.bend_x, &blades.bend_y, &blades.facing,
                                  &blades.flexibility, &blades.phase};
      for (std::size_t k = 0; k < order.size(); ++k)
        for (std::size_t plane = 0; plane < std::size(from); ++plane)
          (*to[plane])[first + k] = (*from[plane])[first + order[k]];
      groups.push_back(measure_group(field, first, end, first_blade));
      first_blade += blades_per_group;
    }
  }
  return layout;
}

bool may_hide(const Prototype& prototype) {
  return prototype.low.z < prototype.high.z &&
         std::none_of(prototype.runs.begin(), prototype.runs.end(), [](const TriangleRun& run) {
           return run.surface == SurfaceClass::leaf || run.surface == SurfaceClass::blade;
         });
}

bool has_hiders(const World& world) {
  return std::any_of(world.instances.begin(), world.instances.end(),
                     [&](const Instance& instance) { return may_hide(world.prototypes[instance.prototype]); });
}

bool has_far_pieces(const World& world) {
  return std::any_of(world.prototypes.begin(), world.prototypes.end(), [](const Prototype& prototype) {
    return std::any_of(prototype.runs.begin(), prototype.runs.end(), [](const TriangleRun& run) {
      return run.surface == SurfaceClass::leaf || run.surface == SurfaceClass::wood;
    });
  });
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
    return sideways * focal + edge * z >= -radius * std::sqrt(focal * focal + edge * edge);
  };
  const double left = double(camera.centre_x) + 1, right = camera.width - double(camera.centre_x) + 1;
  const double top = double(camera.centre_y) + 1, bottom = camera.height - double(camera.centre_y) + 1;
  return inside(x, left) && inside(-x, right) && inside(y, top) && inside(-y, bottom);
}

DrawLister::DrawLister(const World& world, const DetailLayout& layout, const BladeLayout& blades, bool thinned,
                       std::uint32_t most_vertices)
    : world_(world), layout_(layout), blades_(blades), thinned_(thinned), most_vertices_(most_vertices) {}

void DrawLister::begin(const Pose& pose, const CameraView& camera) {
  pose_ = &pose;
  camera_ = camera;
  next_instance_ = next_field_ = next_group_ = next_part_ = 0;
  waiting_.clear();
  drawn_ = nullptr;
  has_begun_ = false;
  order_nearest_first();
}

void DrawLister::order_nearest_first() {
  const auto order = [](std::vector<Place>& places) {
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
    });
  };
  instances_.clear();
  for (std::uint32_t i = 0; i < world_.instances.size(); ++i)
    instances_.push_back({glm::distance(world_.instances[i].position, pose_->eye), i});
  order(instances_);
  const auto others = std::stable_partition(instances_.begin(), instances_.end(), [&](const Place& place) {
    return may_hide(world_.prototypes[world_.instances[place.index].prototype]);
  });
  hiders_ = static_cast<std::size_t>(others - instances_.begin());
  groups_.resize(blades_.groups.size());
  for (std::size_t field = 0; field < groups_.size(); ++field) {
    groups_[field].clear();
    for (std::uint32_t group = 0; group < blades_.groups[field].size(); ++group)
      groups_[field].push_back({glm::distance(blades_.groups[field][group].centre, pose_->eye), group});
    order(groups_[field]);
  }
}

bool DrawLister::may_be_seen(const glm::dvec3& centre, double radius) const {
  return in_view(camera_, centre, radius) && !(drawn_ && is_hidden(*drawn_, centre, radius));
}

bool DrawLister::more() const {
  return next_part_ < waiting_.size() || next_instance_ < world_.instances.size() ||
         next_field_ < blades_.fields.size();
}

void DrawLister::list_instance(std::size_t i, Part& part) const {
  const Instance& instance = world_.instances[i];
  if (instance.role == Instance::Role::plant) {
    part.limbs = plant_limbs_at(world_, i, pose_->time, pose_->eye);
  } else {
    const auto first = pose_->limbs.begin() + pose_->first_limb[i];
    part.limbs.assign(first, first + static_cast<std::ptrdiff_t>(world_.prototypes[instance.prototype].limbs.size()));
  }
  const std::vector<DetailSection>& sections = layout_.sections[instance.prototype];
  std::vector<float> areas;
  for (const DetailSection& candidate : sections) {
    if (candidate.is_far) continue;
    const LimbPose& limb = part.limbs[candidate.limb];
    const glm::vec4 sphere = posed_sphere(limb, candidate, instance.scale);
    const glm::dvec3 centre(sphere);
    const double distance = std::max(glm::length(centre), double(camera_.near_plane));
    const double pixels = double(candidate.size) * instance.scale * double(camera_.focal) / distance;
    const DetailSection* section = &candidate;
    double grown = 0;  // how far enlarged leaves reach out of the sphere
    areas.clear();
    if (thinned_ && candidate.far >= 0 && pixels < (candidate.thins ? leaf_pixels : twig_pixels))
      section = &sections[static_cast<std::size_t>(candidate.far)];
    if (thinned_ && section->thins) {
      thin(section->triangles / unit_triangles, pixels * pixels / (leaf_pixels * leaf_pixels), areas);
      grown = (std::sqrt(double(areas.front())) - 1) * double(section->piece_radius) * instance.scale;
    }
    const glm::vec4 drawn = section == &candidate ? sphere : posed_sphere(limb, *section, instance.scale);
    if (may_be_seen(glm::dvec3(drawn), double(drawn.w) + grown)) list_section(*section, instance, areas, part);
  }
}

void DrawLister::list_section(const DetailSection& section, const Instance& instance, const std::vector<float>& areas,
                              Part& part) const {
  ListedSections& to = section.is_far ? part.far : part.posed;
  const auto first_block = static_cast<std::uint32_t>(to.blocks.size());
  const std::uint32_t triangles =
      areas.empty() ? section.triangles : static_cast<std::uint32_t>(areas.size()) * unit_triangles;
  const std::uint32_t units = triangles / unit_triangles;
  const std::uint32_t blocks = areas.empty() ? section.blocks : units * section.unit_blocks;
  for (std::uint32_t unit = 0; section.is_far && unit < units; ++unit)
    part.far_units.push_back(
        {first_block + unit * section.unit_blocks,
         static_cast<std::uint32_t>(to.chunks.size()) * triangles_per_chunk + unit * unit_triangles});
  for (std::uint32_t block = 0; block < blocks; ++block)
    to.blocks.push_back({section.first_block + block, section.limb});
  for (std::uint32_t block = 0; thinned_ && block < blocks; ++block)
    to.block_scale.push_back(areas.empty() ? 1.0f : std::sqrt(areas[block / section.unit_blocks]));
  for (std::uint32_t done = 0; done < triangles; done += triangles_per_chunk)
    to.chunks.push_back({first_block * vertex_block, section.first_triangle + done,
                         std::min(triangles_per_chunk, triangles - done), instance.run_owner[section.run]});
  part.triangles += triangles;
}

void DrawLister::list_wave() {
  constexpr std::size_t wave = 64;  // instances that are listed side by side
  waiting_.clear();
  next_part_ = 0;
  waiting_.resize(std::min(wave, world_.instances.size() - next_instance_));
  tbb::parallel_for(std::size_t(0), waiting_.size(),
                    [&](std::size_t k) { list_instance(instances_[next_instance_ + k].index, waiting_[k]); });
  next_instance_ += waiting_.size();
}

void DrawLister::append(Part& part) {
  if (part.triangles > 0) {
    const auto limb = static_cast<std::uint32_t>(list_.limbs.size());
    list_.limbs.insert(list_.limbs.end(), part.limbs.begin(), part.limbs.end());
    for (const FarUnit& unit : part.far_units)
      far_units_.push_back({unit.first_block + static_cast<std::uint32_t>(far_.blocks.size()),
                            unit.first_triangle + first_triangle_after(far_)});
    list_.vertices += static_cast<std::uint32_t>(part.vertices());
    list_.triangles += part.triangles;
    join(list_.mesh, part.posed, limb);
    join(far_, part.far, limb);
  }
  part = Part();
}

void DrawLister::append_far() {
  list_.posed_blocks = list_.mesh.blocks.size();
  list_.posed_chunks = static_cast<std::uint32_t>(list_.mesh.chunks.size());
  for (const FarUnit& unit : far_units_)
    list_.far_units.push_back({unit.first_block + static_cast<std::uint32_t>(list_.posed_blocks),
                               unit.first_triangle + first_triangle_after(list_.mesh)});
  join(list_.mesh, far_, 0);
  far_ = {};
  far_units_.clear();
  list_.mesh_chunks = static_cast<std::uint32_t>(list_.mesh.chunks.size());
}

void DrawLister::list_group(std::size_t field, const BladeGroup& group) {
  const glm::dvec3 centre = group.centre - pose_->eye;
  if (!may_be_seen(centre, double(group.radius))) return;
  const double scale = double(camera_.focal) / std::max(glm::length(centre), double(camera_.near_plane));
  const std::size_t all = (group.blades + blades_per_unit - 1) / blades_per_unit;
  thin(all, thinned_ ? double(group.width) * scale / blade_pixels : 2.0, widths_);
  const std::uint32_t pairs = thinned_ ? strip_pairs(double(group.length) * scale) : 3;
  for (std::uint32_t unit = 0; unit < widths_.size(); ++unit)
    list_.blade_units.push_back({first_triangle_after(list_.mesh) + unit * blades_per_unit, widths_[unit], pairs, 0});
  const auto count = std::min(group.blades, static_cast<std::uint32_t>(widths_.size()) * blades_per_unit);
  for (std::uint32_t k = 0; k < 2 * pairs - 1; ++k)
    list_.mesh.chunks.push_back(
        {list_.vertices + k * blades_per_group, group.first_blade, count, blades_.fields[field].owner});
  list_.vertices += (2 * pairs + 1) * blades_per_group;
  list_.triangles += std::uint64_t{2 * pairs - 1} * count;
}

void DrawLister::list_grass() {
  for (std::size_t field = 0; field < blades_.fields.size(); ++field) {
    list_.first_unit.push_back(static_cast<std::uint32_t>(list_.blade_units.size()));
    if (field != next_field_) continue;
    const std::vector<BladeGroup>& groups = blades_.groups[field];
    while (next_group_ < groups.size() && (list_.vertices < most_vertices_ || list_.mesh.chunks.empty()))
      list_group(field, groups[groups_[field][next_group_++].index]);
    if (next_group_ < groups.size()) continue;  // the batch is full
    ++next_field_;
    next_group_ = 0;
  }
  list_.first_unit.push_back(static_cast<std::uint32_t>(list_.blade_units.size()));
}

void DrawLister::clear_list() {
  list_.limbs.clear();
  list_.mesh.blocks.clear();
  list_.mesh.block_scale.clear();
  list_.mesh.chunks.clear();
  list_.far_units.clear();
  list_.blade_units.clear();
  list_.first_unit.clear();
  list_.vertices = 0;
  list_.triangles = 0;
}

const DrawList& DrawLister::hiders() {
  clear_list();
  for (; next_instance_ < hiders_; ++next_instance_) {
    Part part;
    list_instance(instances_[next_instance_].index, part);
    if (list_.vertices > 0 && list_.vertices + part.vertices() > most_vertices_) break;
    append(part);
  }
  append_far();
  list_.first_unit.assign(blades_.fields.size() + 1, 0);
  has_begun_ = true;
  return list_;
}

const DrawList& DrawLister::next() {
  if (!has_begun_) clear_list();
  has_begun_ = false;
  list_.first_unit.clear();
  bool full = false;
  while (!full && (next_part_ < waiting_.size() || next_instance_ < world_.instances.size())) {
    if (next_part_ == waiting_.size()) list_wave();
    while (!full && next_part_ < waiting_.size()) {
      full = list_.vertices > 0 && list_.vertices + waiting_[next_part_].vertices() > most_vertices_;
      if (!full) append(waiting_[next_part_++]);
    }
  }
  append_far();
  if (full)
    list_.first_unit.assign(blades_.fields.size() + 1, 0);
  else
    list_grass();
  return list_;
}

}  // namespace understory
