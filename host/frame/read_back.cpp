#include "host/frame/read_back.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <string>

#include "sim/error.hpp"

namespace understory {
namespace {

/// Copies planes of a frame side by side, straight from the device's memory where the host shares it. Device planes
/// may have longer rows, as many pixels more on every side, which are left out.
class PlaneCopies {
  /// Elements of a buffer, once they are there.
  template <typename T>
  struct Seen {
    const RawMapping* mapping;
    const T* operator()() const { return static_cast<const T*>(mapping->data()); }
  };
  template <typename T>
  Seen<T> map(const Buffer<T>& buffer) {
    const std::size_t needed = row_length_ * (height_ + (row_length_ - width_));  // with as many guard rows as columns
    if (buffer.size() < needed)
      throw Error(ErrorKind::unexpected, "a plane of " + std::to_string(needed) + " values was to be read, and " +
                                             std::to_string(buffer.size()) + " are there");
    return {&mappings_.emplace_back(buffer.raw())};
  }

 public:
  PlaneCopies(const Frame& frame, std::size_t row_length)
      : width_(static_cast<std::size_t>(frame.width)),
        height_(static_cast<std::size_t>(frame.height)),
        row_length_(row_length) {}

  template <typename T>
  void add(const Buffer<T>& from, std::vector<T>& to) {
    const auto seen = map(from);
    copies_.push_back([this, seen, &to] {
      if (row_length_ == width_) return to.assign(seen(), seen() + width_ * height_);
      to.clear();
      to.reserve(width_ * height_);
      for (std::size_t row = 0; row < height_; ++row)
        to.insert(to.end(), seen() + first_of(row), seen() + first_of(row) + width_);
    });
  }

  /// Camera-relative m to relative to the origin, `offset` away; background stays 0.
  void add_moved(const Buffer<float>& from, const Buffer<std::uint32_t>& validity, double offset, Plane& to) {
    const auto seen = map(from);
    const auto flags = map(validity);
    copies_.push_back([this, seen, flags, offset, &to] {
      to.resize(width_ * height_);
      for (std::size_t row = 0; row < height_; ++row) {
        const float* value = seen() + first_of(row);
        const std::uint32_t* flag = flags() + first_of(row);
        for (std::size_t column = 0; column < width_; ++column)
          to[row * width_ + column] =
              (flag[column] & validity::background) != 0 ? value[column] : static_cast<float>(value[column] + offset);
      }
    });
  }

  void run() {
    for (const RawMapping& mapping : mappings_) mapping.data();
    tbb::parallel_for(std::size_t(0), copies_.size(), [&](std::size_t i) { copies_[i](); });
  }

 private:
  std::size_t first_of(std::size_t row) const {
    const std::size_t guard = (row_length_ - width_) / 2;
    return (row + guard) * row_length_ + guard;
  }

  std::size_t width_, height_, row_length_;
  std::deque<RawMapping> mappings_;  // stay where they are
  std::vector<std::function<void()>> copies_;
};

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
  PlaneCopies copies(frame, planes.row_length);
  copies.add(planes.owner, frame.owner);
  copies.add(planes.validity, frame.validity);
  copies.add_moved(planes.position_x, planes.validity, eye.x, frame.position[0]);
  copies.add_moved(planes.position_y, planes.validity, eye.y, frame.position[1]);
  copies.add_moved(planes.position_z, planes.validity, eye.z, frame.position[2]);
  copies.add(planes.normal_x, frame.normal[0]);
  copies.add(planes.normal_y, frame.normal[1]);
  copies.add(planes.normal_z, frame.normal[2]);
  copies.add(planes.depth, frame.depth);
  frame.height_above_root.clear();
  if (planes.height_above_root.size() > 0) copies.add(planes.height_above_root, frame.height_above_root);
  copies.run();
}

void read_visibility(const VisibilityPasses& passes, std::size_t row_length, Frame& frame) {
  PlaneCopies copies(frame, row_length);
  copies.add(passes.visibility(), frame.visibility);
  std::erase_if(frame.terms, [&](const auto& term) { return !passes.terms().contains(term.first); });
  for (const auto& [name, plane] : passes.terms()) copies.add(plane, frame.terms[name]);
  for (Plane& channel : frame.ambient_light) channel.clear();
  frame.sky_mean = glm::vec3(1);
  if (const EnvironmentLight* light = passes.environment()) {
    for (std::size_t channel = 0; channel < 3; ++channel)
      copies.add(light->planes()[channel], frame.ambient_light[channel]);
    frame.sky_mean = light->mean();
  }
  copies.run();
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
