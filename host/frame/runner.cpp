#include "host/frame/runner.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/frame/camera_view.hpp"
#include "host/frame/geometry.hpp"
#include "host/frame/read_back.hpp"
#include "host/frame/seen_geometry.hpp"
#include "host/frame/visibility.hpp"
#include "host/passes/pose_grass.hpp"
#include "host/passes/pose_mesh.hpp"
#include "host/passes/rasterise.hpp"
#include "host/passes/resolve.hpp"
#include "sim/dynamics.hpp"
#include "sim/grass_wind.hpp"
#include "sim/pose.hpp"

namespace understory {
namespace {

SwaySeries upload_series(Device& device, const ModalSeries& response) {
  std::vector<std::array<float, 2>> pairs;
  for (const glm::vec2 pair : interleaved(response)) pairs.push_back({pair.x, pair.y});
  return SwaySeries(device, std::span<const std::array<float, 2>>(pairs), "grass sway series");
}

/// The same camera with so many pixels more on every side.
CameraView with_guard(CameraView camera, int guard) {
  camera.width += 2 * guard;
  camera.height += 2 * guard;
  camera.centre_x += static_cast<float>(guard);
  camera.centre_y += static_cast<float>(guard);
  return camera;
}

}  // namespace

struct FrameRunner::Impl {
  Impl(Device& the_device, const World& the_world);
  void choose(const Methods& methods);
  void draw();
  void pose_everything();
  void shade();
  const Geometry& drawn() const { return seen ? seen->geometry() : geometry; }

  Device& device;
  const World& world;
  Plan plan;
  int guard = 0;                     // pixels drawn around the image
  std::optional<SeenGeometry> seen;  // unless everything is drawn
  Geometry geometry;                 // else of everything
  std::vector<SwaySeries> series;    // per World::grass
  Pose pose;                         // of the last frame, and the camera that saw it, guard included
  CameraView camera{};
  Buffer<LimbPose> limbs;
  VisibilityBuffer visible;
  FragmentPlanes planes;
  OwnerTables owners;
  std::optional<PoseMeshPass> pose_mesh;
  std::optional<PoseGrassPass> pose_grass;
  std::optional<RasterisePass> rasterise;
  std::optional<ResolvePass> resolve;
  std::optional<VisibilityPasses> visibility;
};

FrameRunner::Impl::Impl(Device& the_device, const World& the_world) : device(the_device), world(the_world) {
  owners = upload_owners(device, world.owners);
  if (world.scene.detail == "brute")
    geometry = upload_geometry(device, world);
  else
    seen.emplace(device, world, world.scene.detail == "thinned");
  const bool mesh = !world.instances.empty();
  const bool grass =
      std::any_of(world.grass.begin(), world.grass.end(), [](const GrassBlades& field) { return field.size() > 0; });
  if (mesh && !seen) pose_mesh.emplace(device);
  if (grass) {
    if (!seen) pose_grass.emplace(device);
    for (const ModalSeries& response : world.dynamics->grass) series.push_back(upload_series(device, response));
  }
  rasterise.emplace(device, mesh, grass, device.info().atomic64);
  choose(world.scene.methods);
}

void FrameRunner::Impl::choose(const Methods& methods) {
  plan = make_plan(world, methods);
  guard = methods.near == "none" ? 0 : methods.near_field.guard;
  const auto width = static_cast<std::size_t>(world.scene.image.width + 2 * guard);
  const auto height = static_cast<std::size_t>(world.scene.image.height + 2 * guard);
  if (visible.words.size() != 2 * width * height)
    visible.words = Buffer<std::uint32_t>(device, 2 * width * height, "visibility buffer");
  ResolvedPlanes resolved;
  resolved.grass_height = plan.has("grass-height") || plan.has("grass-transmittance");  // frames keep the heights
  resolved.rest_point = plan.has("crown-field");
  resolved.texel = plan.has("crown-baked");
  visibility.reset();  // first free the old methods' programs and planes
  resolve.reset();
  planes = allocate_planes(device, width, height, resolved.grass_height);
  if (resolved.rest_point) allocate_rest_planes(device, planes);
  if (resolved.texel) allocate_texel_planes(device, planes);
  resolve.emplace(device, resolved, device.info().atomic64);
  visibility.emplace(device, &world, methods, plan, width, height);
}

void FrameRunner::Impl::draw() {
  if (seen)
    seen->pose(pose, camera, series);
  else
    pose_everything();
  rasterise->run(drawn().triangles, drawn().posed, camera, visible);
}

void FrameRunner::Impl::pose_everything() {
  if (pose_mesh) {
    if (limbs.size() != pose.limbs.size()) limbs = Buffer<LimbPose>(device, pose.limbs.size(), "limb poses");
    limbs.write(pose.limbs);
    pose_mesh->run(geometry.rest, geometry.blocks, limbs, geometry.posed);
  }
  for (std::size_t field = 0; field < geometry.fields.size(); ++field) {
    const FieldRange& range = geometry.fields[field];
    if (range.blades > 0)
      pose_grass->run(geometry.blades, pose.grass[field], series[field], range.first_blade, range.blades,
                      range.first_vertex, geometry.posed);
  }
}

void FrameRunner::Impl::shade() {
  const auto* faces = visibility->baked_faces();
  const RestGeometry rest{drawn().blades,  static_cast<float>(-pose.eye.z),   &drawn().rest,
                          &drawn().blocks, seen ? seen->faces(faces) : faces, &drawn().mesh_grass};
  resolve->run(visible, drawn().triangles, drawn().posed, rest, camera, planes);
  visibility->see(obscurance_view(camera));
  visibility->run(&pose, owners, planes);
}

FrameRunner::FrameRunner(Device& device, const World& world) : impl_(std::make_unique<Impl>(device, world)) {}
FrameRunner::~FrameRunner() = default;

void FrameRunner::choose(const Methods& methods) { impl_->choose(methods); }
const Plan& FrameRunner::plan() const { return impl_->plan; }

Frame FrameRunner::render(int index, double time, glm::dvec2 pixel_offset) {
  const Scene& scene = impl_->world.scene;
  impl_->pose = pose_at(impl_->world, time, scene.camera.position);
  impl_->device.take_pass_times();
  impl_->camera = with_guard(camera_view(scene.camera, scene.image, pixel_offset), impl_->guard);
  impl_->draw();
  impl_->shade();

  Frame frame;
  frame.index = index;
  frame.time = time;
  frame.origin = scene.origin;
  frame.width = scene.image.width;
  frame.height = scene.image.height;
  frame.owners = impl_->world.owners;
  frame.environment = impl_->world.environment;
  frame.environment_turn = scene.environment.turn;
  frame.world_to_camera = world_to_camera(scene.camera);
  frame.vertical_fov = scene.camera.vertical_fov;
  frame.near_plane = scene.camera.near_plane;
  frame.pass_ms = impl_->device.take_pass_times();
  read_planes(impl_->planes, impl_->pose.eye, frame);
  read_visibility(*impl_->visibility, impl_->planes.row_length, frame);
  return frame;
}

void FrameRunner::shade_again() { impl_->shade(); }

PosedGeometry FrameRunner::posed_geometry() const {
  return read_geometry(impl_->drawn(), impl_->world.scene.camera.position);
}

}  // namespace understory
