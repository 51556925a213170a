// Owners, crowns and spheres on a grid; fragments by tile from counter-based chance.
#include "bench/fragments.hpp"

#include <array>
#include <cmath>

#include "sim/frame.hpp"

namespace understory {
namespace {

constexpr std::size_t tile = 16;
constexpr std::uint32_t crown_count = 64;
constexpr std::uint64_t seed = 7;

/// Few fragments are a small picture, not a strip.
std::size_t row_length_of(std::size_t fragments) { return fragments < (1 << 15) ? 128 : 2048; }

std::vector<Owner> make_owners() {
  std::vector<Owner> rows(1);
  for (std::uint32_t i = 0; i < crown_count; ++i) {
    const auto number = static_cast<std::int32_t>(i);
    rows.push_back({SurfaceClass::leaf, "tree", number, glm::vec3(0), number, number});
  }
  rows.push_back({SurfaceClass::blade, "grass", 0, glm::vec3(0), -1, -1});
  rows.push_back({SurfaceClass::terrain, "terrain", 0, glm::vec3(0), -1, -1});
  return rows;
}

/// 8 x 8 crowns, 12 m apart, 3 to 5 m in radius.
std::vector<CrownRecord> make_crowns() {
  std::vector<CrownRecord> rows(crown_count);
  for (std::uint32_t i = 0; i < crown_count; ++i) {
    Random random(seed, stream_of("crown"), i);
    CrownRecord& crown = rows[i];
    crown.radius = static_cast<float>(random.uniform(3, 5));
    crown.centre_x = crown.x = 12.0f * static_cast<float>(i % 8) - 42.0f;
    crown.centre_y = crown.y = 12.0f * static_cast<float>(i / 8) + 10.0f;
    crown.centre_z = crown.z = crown.radius;
    crown.alpha_rho = 0.01f;
    const glm::vec3 radii = crown.radius * glm::vec3(1.1f, 0.9f, 1.2f);
    crown.to_unit[0] = 1 / radii.x;
    crown.to_unit[5] = 1 / radii.y;
    crown.to_unit[10] = 1 / radii.z;
    for (int axis = 0; axis < 3; ++axis) crown.to_unit[4 * axis + 3] = radii[axis] * radii[axis];
    crown.volume_scale = radii.x * radii.y * radii.z;
    crown.ambient = 0.9f;
    crown.extinction = 0.4f;
  }
  return rows;
}

std::vector<ShadingSphere> make_spheres(const std::vector<CrownRecord>& crowns) {
  std::vector<ShadingSphere> rows;
  for (const CrownRecord& crown : crowns) {
    const auto group = static_cast<record_int>(rows.size());
    rows.push_back({crown.x, crown.y, crown.z, crown.radius, 0.7f, group, {}});
  }
  return rows;
}

glm::vec3 unit_vector(Random& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(-3.14159, 3.14159), flat = std::sqrt(1 - z * z);
  return glm::normalize(glm::vec3(flat * std::cos(turn), flat * std::sin(turn), z));
}

GroundCover make_cover() {
  GroundCover cover;
  cover.extent = {{-64, -64}, {192, 192}};
  cover.columns = cover.rows = 256;
  for (std::uint32_t row = 0; row < cover.rows; ++row) {
    for (std::uint32_t column = 0; column < cover.columns; ++column) {
      cover.visibility.push_back(static_cast<float>(BenchFragments::cover_at(column - 63.5, row - 63.5)));
    }
  }
  return cover;
}

}  // namespace

double BenchFragments::cover_at(double x, double y) { return 0.5 + 0.002 * x - 0.001 * y; }

BenchFragments::BenchFragments(Device& device, std::size_t fragments, Cover filled_by)
    : planes(allocate_planes(device, row_length_of(fragments),
                             (fragments + row_length_of(fragments) - 1) / row_length_of(fragments), true)),
      cover(device, make_cover()),
      filled_by_(filled_by),
      owner_rows_(make_owners()),
      crown_rows_(make_crowns()),
      sphere_rows_(make_spheres(crown_rows_)) {
  owners = upload_owners(device, owner_rows_);
  crowns = Buffer<CrownRecord>(device, std::span<const CrownRecord>(crown_rows_), "crowns");
  spheres = Buffer<ShadingSphere>(device, std::span<const ShadingSphere>(sphere_rows_), "spheres");
  upload();
}

std::uint32_t BenchFragments::owner_of_tile(Random& random) const {
  const auto crown = 1 + static_cast<std::uint32_t>(random.below(crown_count));
  if (filled_by_ == Cover::grass) return crown_count + 1;
  return filled_by_ == Cover::ground ? crown_count + 2 : crown;
}

BenchFragment BenchFragments::at(std::size_t index) const {
  const std::size_t row_length = planes.row_length, column = index % row_length / tile, row = index / row_length / tile;
  Random of_tile(seed, stream_of("tile"), row * row_length + column);
  Random own(seed, stream_of("fragment"), index);
  BenchFragment fragment;
  fragment.owner = owner_of_tile(of_tile);
  const glm::vec3 direction = unit_vector(of_tile);
  const auto share = static_cast<float>(of_tile.uniform());
  fragment.normal = glm::normalize(direction + 0.9f * unit_vector(own));
  const glm::vec3 jitter = 0.1f * unit_vector(own);
  const Owner& owner = owner_rows_[fragment.owner];
  if (owner.crown >= 0) {
    const CrownRecord& crown = crown_rows_[static_cast<std::size_t>(owner.crown)];
    fragment.position = glm::vec3(crown.x, crown.y, crown.z) + 0.95f * crown.radius * share * direction + jitter;
    return fragment;
  }
  fragment.position = glm::vec3(48.0f, 48.0f, 0.1f) * direction + glm::vec3(0, 50, 0) + jitter;
  if (owner.surface != SurfaceClass::blade) return fragment;
  fragment.blade_length = 0.3f + 0.1f * share;
  fragment.height = fragment.blade_length * static_cast<float>(own.uniform());
  return fragment;
}

void BenchFragments::upload() {
  const std::size_t count = planes.padded_fragments;
  std::array<Plane, 8> values;
  for (Plane& plane : values) plane.resize(count);
  std::vector<std::uint32_t> owner(count);
  for (std::size_t i = 0; i < count; ++i) {
    const BenchFragment fragment = at(i);
    owner[i] = fragment.owner;
    const glm::vec3 p = fragment.position, n = fragment.normal;
    const float numbers[] = {p.x, p.y, p.z, n.x, n.y, n.z, fragment.height, fragment.blade_length};
    for (std::size_t plane = 0; plane < values.size(); ++plane) values[plane][i] = numbers[plane];
  }
  Buffer<float>* const targets[] = {&planes.position_x,        &planes.position_y,  &planes.position_z,
                                    &planes.normal_x,          &planes.normal_y,    &planes.normal_z,
                                    &planes.height_above_root, &planes.blade_length};
  for (std::size_t plane = 0; plane < values.size(); ++plane) targets[plane]->write(values[plane]);
  planes.owner.write(owner);
  planes.validity.write(std::vector<std::uint32_t>(count, 0));
}

}  // namespace understory
