// Poses rest vertices and blades on a device at any vector width, as the passes do at the device's own.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "host/opencl/kernel.hpp"
#include "host/passes/geometry.hpp"
#include "host/passes/pose_grass.hpp"
#include "sim/prototype.hpp"

namespace understory {

/// Vector widths that kernels may be built with.
inline constexpr int vector_widths[] = {1, 4, 8, 16};

template <typename T>
Buffer<T> upload_test_data(Device& device, const std::vector<T>& data) {
  return Buffer<T>(device, std::span<const T>(data), "test data");
}

inline RestVertices upload_rest(Device& device, const VertexBlocks& rest) {
  const auto up = [&](const auto& plane) { return upload_test_data(device, plane); };
  return {up(rest.x),
          up(rest.y),
          up(rest.z),
          up(rest.flutter_x),
          up(rest.flutter_y),
          up(rest.flutter_z),
          up(rest.flutter_phase)};
}

/// Three planes of camera-relative metres.
struct Points {
  std::vector<float> x, y, z;
  bool operator==(const Points&) const = default;
  glm::dvec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// The records of posed vertices as planes.
inline Points read_points(const PosedVertices& posed) {
  Points points;
  for (const std::array<float, 4>& point : posed.points.read()) {
    points.x.push_back(point[0]);
    points.y.push_back(point[1]);
    points.z.push_back(point[2]);
  }
  return points;
}

/// A coordinate that no kernel writes; results start and end with it.
inline constexpr float untouched = -12345;
inline constexpr std::array<float, 4> untouched_point = {untouched, untouched, untouched, untouched};

/// Kernel `pose_mesh` at `lanes` vertices per work-item. Fails the test when it writes past its last vertex.
inline Points pose_mesh_on(Device& device, int lanes, const VertexBlocks& rest, const std::vector<PosedBlock>& blocks,
                           const std::vector<LimbPose>& limbs) {
  Kernel kernel(device, "pose_mesh", "pose_mesh", "pose_mesh", "-DW=" + std::to_string(lanes));
  const std::size_t vertices = blocks.size() * vertex_block, beyond = 64 * 16;
  const RestVertices planes = upload_rest(device, rest);
  PosedVertices all{upload_test_data(device, std::vector(vertices + beyond, untouched_point))};
  const auto items = static_cast<std::uint32_t>(vertices / static_cast<std::size_t>(lanes));
  kernel.launch(items, 64, planes.x, planes.y, planes.z, planes.flutter_x, planes.flutter_y, planes.flutter_z,
                planes.flutter_phase, upload_test_data(device, blocks), upload_test_data(device, limbs), all.points,
                items);
  Points posed = read_points(all);
  for (std::vector<float>* plane : {&posed.x, &posed.y, &posed.z}) {
    EXPECT_EQ(std::vector<float>(plane->begin() + static_cast<std::ptrdiff_t>(vertices), plane->end()),
              std::vector<float>(beyond, untouched))
        << "wrote past the last vertex";
    plane->resize(vertices);
  }
  return posed;
}

/// Kernel `pose_grass` at `lanes` blades per work-item; as PoseGrassPass::run.
inline void pose_grass_on(Device& device, int lanes, const RestBlades& rest, const GrassWind& wind,
                          const SwaySeries& series, std::uint32_t first_blade, std::uint32_t blades,
                          std::uint32_t first_vertex, PosedVertices& posed) {
  Kernel kernel(device, "pose_grass", "pose_grass", "pose_grass", "-DW=" + std::to_string(lanes));
  const auto width = static_cast<std::size_t>(lanes);
  kernel.launch(blades / width, blades_per_group / width, rest.root_x, rest.root_y, rest.root_z, rest.length,
                rest.half_width, rest.bend_x, rest.bend_y, rest.facing_x, rest.facing_y, rest.flexibility, rest.phase,
                wind, series, first_blade, first_vertex, posed.points);
}

}  // namespace understory
