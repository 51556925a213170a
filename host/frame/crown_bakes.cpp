#include "host/frame/crown_bakes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "host/frame/geometry.hpp"
#include "host/trace/bake_cache.hpp"
#include "host/trace/crown_baked.hpp"
#include "host/trace/crown_field.hpp"
#include "kernels/shared/crown_baked.h"

namespace understory {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Go up whenever the same options give another result.
constexpr std::uint32_t field_version = 1, faces_version = 3;

/// All that a bake sees of a prototype.
void add_shape(ContentHash& hash, const Prototype& prototype) {
  hash.add(prototype.vertices.x);
  hash.add(prototype.vertices.y);
  hash.add(prototype.vertices.z);
  hash.add(prototype.triangles);
}

std::string bytes_of(const CrownField& field) {
  std::string bytes(reinterpret_cast<const char*>(&field.grid), sizeof field.grid);
  bytes.append(reinterpret_cast<const char*>(field.cells.data()), field.cells.size() * sizeof(std::uint32_t));
  return bytes;
}

std::optional<CrownField> field_of(const std::string& bytes) {
  CrownField field;
  if (bytes.size() < sizeof field.grid) return std::nullopt;
  std::memcpy(&field.grid, bytes.data(), sizeof field.grid);
  const std::uint64_t cells = std::uint64_t{field.grid.columns} * field.grid.rows * field.grid.layers;
  field.cells.resize((bytes.size() - sizeof field.grid) / sizeof(std::uint32_t));
  if (cells == 0 || field.cells.size() != cells * FIELD_WORDS) return std::nullopt;
  std::memcpy(field.cells.data(), bytes.data() + sizeof field.grid, field.cells.size() * sizeof(std::uint32_t));
  return field;
}

CrownField baked_field(const Prototype& prototype, const CrownFieldOptions& options) {
  ContentHash hash;
  add_shape(hash, prototype);
  hash.add(field_version);
  hash.add(static_cast<std::int32_t>(options.sky));
  hash.add(options.cells);
  hash.add(options.rays_per_triangle);
  hash.add(options.least_rays);
  hash.add(options.most_rays);
  hash.add(options.seed);
  if (const std::optional<std::string> bytes = load_bake("crown-field", hash))
    if (std::optional<CrownField> field = field_of(*bytes)) return std::move(*field);
  CrownField field = bake_crown_field(prototype, options);
  store_bake("crown-field", hash, bytes_of(field));
  return field;
}

std::string bytes_of(const CrownBaked& baked) {
  std::string bytes(reinterpret_cast<const char*>(baked.faces.data()), baked.faces.size() * sizeof baked.faces[0]);
  bytes.append(reinterpret_cast<const char*>(baked.texels.data()), baked.texels.size() * sizeof(std::uint32_t));
  return bytes;
}

/// `bytes` begin with the faces, whose number is known.
std::optional<CrownBaked> faces_of(const std::string& bytes, std::size_t faces) {
  CrownBaked baked;
  baked.faces.resize(faces);
  const std::size_t head = faces * sizeof baked.faces[0];
  if (bytes.size() < head) return std::nullopt;
  std::memcpy(baked.faces.data(), bytes.data(), head);
  baked.texels.resize((bytes.size() - head) / sizeof(std::uint32_t));
  std::memcpy(baked.texels.data(), bytes.data() + head, baked.texels.size() * sizeof(std::uint32_t));
  return baked;
}

CrownBaked baked_faces(const Prototype& prototype, const CrownBakedOptions& options) {
  ContentHash hash;
  add_shape(hash, prototype);
  for (const TriangleRun& run : prototype.runs) hash.add(static_cast<std::uint32_t>(run.surface) + 8 * run.first);
  hash.add(faces_version);
  hash.add(static_cast<std::int32_t>(options.sky));
  hash.add(options.rays_per_triangle);
  hash.add(options.most_rays);
  hash.add(options.texels_per_triangle);
  hash.add(options.seed);
  if (const std::optional<std::string> bytes = load_bake("crown-baked", hash))
    if (std::optional<CrownBaked> baked = faces_of(*bytes, prototype.triangle_count())) return std::move(*baked);
  CrownBaked baked = bake_crown_faces(prototype, options);
  store_bake("crown-baked", hash, bytes_of(baked));
  return baked;
}

/// FACE_RISE of a triangle.
std::uint32_t rise_of(const Prototype& prototype, std::uint32_t triangle, Sky sky) {
  if (sky == Sky::sphere) return NO_RISE;
  const auto corner = [&](std::uint32_t number) {
    const std::uint32_t v = prototype.triangles[3 * triangle + number];
    return glm::vec3(prototype.vertices.x[v], prototype.vertices.y[v], prototype.vertices.z[v]);
  };
  const glm::vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
  const float length = glm::length(normal);
  if (!(length > 0)) return NO_RISE;
  return static_cast<std::uint32_t>(std::lround((std::clamp(normal.z / length, -1.0f, 1.0f) + 1) * RISE_STEPS));
}

/// Which fields there are, by prototype; -1: none.
std::vector<std::int32_t> number_fields(const World& world) {
  std::vector<std::int32_t> numbers(world.prototypes.size(), -1);
  std::int32_t next = 0;
  for (const Instance& instance : world.instances)
    if (instance.role == Instance::Role::plant && numbers[instance.prototype] < 0) numbers[instance.prototype] = next++;
  return numbers;
}

/// The plant that an owner belongs to; null for others.
const Instance* plant_of(const World& world, const Owner& owner) {
  if (owner.surface != SurfaceClass::leaf && owner.surface != SurfaceClass::wood) return nullptr;
  const Instance& instance = world.instances[static_cast<std::size_t>(owner.instance)];
  return instance.role == Instance::Role::plant ? &instance : nullptr;
}

}  // namespace

CrownFieldTables upload_crown_fields(Device& device, const World& world) {
  const std::vector<std::int32_t> numbers = number_fields(world);
  std::vector<CrownFieldGrid> grids;
  std::vector<std::uint32_t> cells;
  CrownFieldOptions options;
  options.sky = world.scene.sky;
  for (std::int32_t number = 0;; ++number) {
    const auto prototype = std::find(numbers.begin(), numbers.end(), number) - numbers.begin();
    if (static_cast<std::size_t>(prototype) == numbers.size()) break;
    const CrownField field = baked_field(world.prototypes[static_cast<std::size_t>(prototype)], options);
    grids.push_back(field.grid);
    grids.back().first_cell = static_cast<record_uint>(cells.size() / FIELD_WORDS);
    cells.insert(cells.end(), field.cells.begin(), field.cells.end());
  }
  std::vector<std::int32_t> owner_field;
  for (const Owner& owner : world.owners) {
    const Instance* plant = plant_of(world, owner);
    owner_field.push_back(plant ? numbers[plant->prototype] : -1);
  }
  CrownFieldTables tables;
  tables.owner_field = Buffer<std::int32_t>(device, std::span<const std::int32_t>(owner_field), "owner fields");
  tables.grids = Buffer<CrownFieldGrid>(device, std::span<const CrownFieldGrid>(grids), "crown field grids");
  tables.cells = Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(cells), "crown field cells");
  return tables;
}

CrownBakedTables upload_crown_baked(Device& device, const World& world) {
  const std::vector<std::uint32_t> starts = first_triangles(world);
  std::vector<std::array<std::uint32_t, 2>> faces(starts.back());
  std::vector<std::uint32_t> texels;
  CrownBakedOptions options;
  options.sky = world.scene.sky;
  const std::vector<std::int32_t> of_plants = number_fields(world);
  std::size_t run_number = 0;
  for (std::size_t i = 0; i < world.prototypes.size(); ++i) {
    const Prototype& prototype = world.prototypes[i];
    if (of_plants[i] < 0) {
      run_number += prototype.runs.size();
      continue;
    }
    const CrownBaked baked = baked_faces(prototype, options);
    for (const TriangleRun& run : prototype.runs) {
      const std::uint32_t start = starts[run_number++];
      for (std::uint32_t k = 0; k < run.count; ++k) {
        std::array<std::uint32_t, 2> face = baked.faces[run.first + k];
        face[0] += static_cast<std::uint32_t>(texels.size());
        face[1] |= rise_of(prototype, run.first + k, options.sky) << 16;
        faces[start + k] = face;
      }
    }
    texels.insert(texels.end(), baked.texels.begin(), baked.texels.end());
  }
  CrownBakedTables tables;
  tables.faces =
      Buffer<std::array<std::uint32_t, 2>>(device, std::span<const std::array<std::uint32_t, 2>>(faces), "baked faces");
  tables.texels = Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(texels), "baked texels");
  return tables;
}

void map_back_rigidly(Device& device, const World& world, const Frame& frame, FragmentPlanes& planes) {
  allocate_rest_planes(device, planes);
  std::array<std::vector<float>, 3> position, normal;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    position[axis].assign(planes.padded_fragments, 0.0f);
    normal[axis].assign(planes.padded_fragments, 0.0f);
  }
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    if (frame.owner[i] >= world.owners.size()) continue;
    const Instance* plant = plant_of(world, world.owners[frame.owner[i]]);
    if (!plant) continue;
    const double cosine = std::cos(plant->yaw), sine = std::sin(plant->yaw);
    const auto turned_back = [&](glm::dvec3 v) {
      return glm::dvec3(cosine * v.x + sine * v.y, cosine * v.y - sine * v.x, v.z);
    };
    const glm::dvec3 p(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
    const glm::dvec3 n(frame.normal[0][i], frame.normal[1][i], frame.normal[2][i]);
    const glm::dvec3 at = turned_back(p - plant->position) / plant->scale, facing = turned_back(n);
    for (int axis = 0; axis < 3; ++axis) {
      position[static_cast<std::size_t>(axis)][i] = static_cast<float>(at[axis]);
      normal[static_cast<std::size_t>(axis)][i] = static_cast<float>(facing[axis]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    planes.rest_position[axis].write(position[axis]);
    planes.rest_normal[axis].write(normal[axis]);
  }
}

}  // namespace understory
