#include "host/frame/read_back.hpp"

#include <algorithm>

namespace understory {
namespace {

/// The frame's pixels of a plane with rows of `row_length`, which may have as many pixels more on every side.
template <typename T>
std::vector<T> read_image(const Buffer<T>& buffer, std::size_t row_length, const Frame& frame) {
  const auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
  const std::size_t guard = (row_length - width) / 2;
  std::vector<T> values(row_length * (height + 2 * guard));
  buffer.read(std::span<T>(values));
  if (guard == 0) return values;
  for (std::size_t row = 0; row < height; ++row)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>((row + guard) * row_length + guard), width,
                values.begin() + static_cast<std::ptrdiff_t>(row * width));
  values.resize(width * height);
  return values;
}

template <typename T>
void write_first(Buffer<T>& buffer, const std::vector<T>& values) {
  buffer.write(std::span<const T>(values));
}

Plane shifted(const Plane& values, double by) {
  Plane moved(values.size());
  std::transform(values.begin(), values.end(), moved.begin(), [by](float v) { return static_cast<float>(v + by); });
  return moved;
}

}  // namespace

void read_planes(const FragmentPlanes& planes, glm::dvec3 eye, Frame& frame) {
  const std::size_t count = frame.pixels();
  const auto read_first = [&](const auto& plane) { return read_image(plane, planes.row_length, frame); };
  frame.owner = read_first(planes.owner);
  frame.validity = read_first(planes.validity);
  const Buffer<float>* positions[3] = {&planes.position_x, &planes.position_y, &planes.position_z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Plane& plane = frame.position[axis] = read_first(*positions[axis]);
    const double offset = eye[static_cast<int>(axis)];
    for (std::size_t i = 0; i < count; ++i)
      if ((frame.validity[i] & validity::background) == 0) plane[i] = static_cast<float>(plane[i] + offset);
  }
  frame.normal = {read_first(planes.normal_x), read_first(planes.normal_y), read_first(planes.normal_z)};
  frame.depth = read_first(planes.depth);
  if (planes.height_above_root.size() > 0) frame.height_above_root = read_first(planes.height_above_root);
}

void read_visibility(const VisibilityPasses& passes, std::size_t row_length, Frame& frame) {
  frame.visibility = read_image(passes.visibility(), row_length, frame);
  for (const auto& [name, plane] : passes.terms()) frame.terms[name] = read_image(plane, row_length, frame);
  if (const EnvironmentLight* light = passes.environment()) {
    for (std::size_t channel = 0; channel < 3; ++channel)
      frame.ambient_light[channel] = read_image(light->planes()[channel], row_length, frame);
    frame.sky_mean = light->mean();
  }
}

FragmentPlanes upload_planes(Device& device, const Frame& frame, glm::dvec3 eye) {
  FragmentPlanes planes =
      allocate_planes(device, static_cast<std::size_t>(frame.width), static_cast<std::size_t>(frame.height), false);
  write_first(planes.position_x, shifted(frame.position[0], -eye.x));
  write_first(planes.position_y, shifted(frame.position[1], -eye.y));
  write_first(planes.position_z, shifted(frame.position[2], -eye.z));
  write_first(planes.normal_x, frame.normal[0]);
  write_first(planes.normal_y, frame.normal[1]);
  write_first(planes.normal_z, frame.normal[2]);
  write_first(planes.depth, frame.depth);
  write_first(planes.owner, frame.owner);
  write_first(planes.validity, frame.validity);
  return planes;
}

PosedGeometry read_geometry(const Geometry& geometry, glm::dvec3 eye) {
  PosedGeometry posed;
  if (geometry.vertices == 0) return posed;
  posed.positions.reserve(3 * std::size_t{geometry.vertices});
  for (const std::array<float, 4>& point : geometry.posed.points.read())
    for (std::size_t axis = 0; axis < 3; ++axis)
      posed.positions.push_back(static_cast<float>(point[axis] + eye[static_cast<int>(axis)]));

  const bool mesh = geometry.has_mesh();
  const std::vector<std::uint32_t> a = mesh ? geometry.triangles.index_a.read() : std::vector<std::uint32_t>{};
  const std::vector<std::uint32_t> b = mesh ? geometry.triangles.index_b.read() : std::vector<std::uint32_t>{};
  const std::vector<std::uint32_t> c = mesh ? geometry.triangles.index_c.read() : std::vector<std::uint32_t>{};
  for (std::size_t index = 0; index < geometry.chunks.size(); ++index) {
    const TriangleChunk& chunk = geometry.chunks[index];
    for (std::uint32_t lane = 0; lane < chunk.count; ++lane) {
      const std::uint32_t t = chunk.first_index + lane, v = chunk.first_vertex;
      if (index < geometry.triangles.mesh_chunks)
        posed.triangles.insert(posed.triangles.end(), {v + a[t], v + b[t], v + c[t]});
      else
        posed.triangles.insert(posed.triangles.end(),
                               {v + lane, v + triangles_per_chunk + lane, v + 2 * triangles_per_chunk + lane});
      posed.owner.push_back(chunk.owner);
    }
  }
  return posed;
}

}  // namespace understory
