#include "host/frame/runner.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/frame/camera_view.hpp"
#include "host/frame/geometry.hpp"
#include "host/frame/read_back.hpp"
#include "host/frame/resolved_planes.hpp"
#include "host/frame/seen_geometry.hpp"
#include "host/frame/visibility.hpp"
#include "host/passes/pose_grass.hpp"
#include "host/passes/pose_mesh.hpp"
#include "host/passes/rasterise.hpp"
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
  Impl(Device& the_device, const World& the_world, std::uint32_t most_posed_vertices);
  void choose(const Methods& methods);
  void draw();
  void draw_seen();
  void upload_everything();
  void pose_everything(const Pose& whole);
  void resolve_batch();
  void shade();
  const Geometry& drawn() const { return seen ? seen->geometry() : geometry; }

  Device& device;
  const World& world;
  Plan plan;
  int guard = 0;                     // pixels drawn around the image
  std::optional<SeenGeometry> seen;  // unless everything is drawn
  Geometry geometry;                 // of everything, once that is asked for
  std::vector<SwaySeries> series;    // per World::grass
  Pose pose;                         // of the last frame, and the camera that saw it, guard included
  CameraView camera{};
  std::uint64_t drawn_triangles = 0;
  Batch batch;  // the one that was drawn last
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

FrameRunner::Impl::Impl(Device& the_device, const World& the_world, std::uint32_t most_posed_vertices)
    : device(the_device), world(the_world) {
  owners = upload_owners(device, world.owners);
  if (world.scene.detail == "brute")
    upload_everything();
  else
    seen.emplace(device, world, world.scene.detail == "thinned", most_posed_vertices);
  const bool mesh = !world.instances.empty();
  const bool grass =
      std::any_of(world.grass.begin(), world.grass.end(), [](const GrassBlades& field) { return field.size() > 0; });
  if (grass)
    for (const ModalSeries& response : world.dynamics->grass) series.push_back(upload_series(device, response));
  rasterise.emplace(device, mesh, grass && !seen, device.info().atomic64);
  choose(world.scene.methods);
}

void FrameRunner::Impl::choose(const Methods& methods) {
  plan = make_plan(world, methods);
  guard = guard_band(methods);
  const auto width = static_cast<std::size_t>(world.scene.image.width + 2 * guard);
  const auto height = static_cast<std::size_t>(world.scene.image.height + 2 * guard);
  if (visible.words.size() != 2 * width * height)
    visible.words = Buffer<std::uint32_t>(device, 2 * width * height, "visibility buffer");
  const ResolvedPlanes resolved = resolved_planes(plan);
  visibility.reset();  // first free the old methods' programs and planes
  resolve.reset();
  planes = allocate_planes(device, width, height, resolved.grass_height);
  if (resolved.rest_point) allocate_rest_planes(device, planes);
  if (resolved.texel) allocate_texel_planes(device, planes);
  resolve.emplace(device, resolved, device.info().atomic64);
  visibility.emplace(device, &world, methods, plan, width, height);
}

void FrameRunner::Impl::draw() {
  if (seen) return draw_seen();
  pose_everything(pose);
  drawn_triangles = 0;
  for (const TriangleChunk& chunk : geometry.chunks) drawn_triangles += chunk.count;
  rasterise->run(drawn().triangles, drawn().posed, camera, visible);
}

void FrameRunner::Impl::draw_seen() {
  seen->begin(pose, camera);
  batch = {};
  drawn_triangles = 0;
  rasterise->clear(visible);
  seen->draw_hiders(*rasterise, visible);
  while (true) {
    batch.last = !seen->draw_next(series, *rasterise, visible);
    drawn_triangles += seen->list().triangles;
    if (batch.last) return;
    resolve_batch();  // the next one overwrites its vertices
    batch.first = false;
  }
}

void FrameRunner::Impl::upload_everything() {
  geometry = upload_geometry(device, world);
  if (geometry.has_mesh()) pose_mesh.emplace(device);
  if (geometry.has_grass()) pose_grass.emplace(device);
}

void FrameRunner::Impl::pose_everything(const Pose& whole) {
  if (pose_mesh) {
    if (limbs.size() != whole.limbs.size()) limbs = Buffer<LimbPose>(device, whole.limbs.size(), "limb poses");
    limbs.write(whole.limbs);
    pose_mesh->run(geometry.rest, geometry.blocks, limbs, geometry.posed);
  }
  for (std::size_t field = 0; field < geometry.fields.size(); ++field) {
    const FieldRange& range = geometry.fields[field];
    if (range.blades > 0)
      pose_grass->run(geometry.blades, whole.grass[field], series[field], range.first_blade, range.blades,
                      range.first_vertex, geometry.posed);
  }
}

void FrameRunner::Impl::resolve_batch() {
  const auto* faces = visibility->baked_faces();
  const RestGeometry rest{drawn().blades,  static_cast<float>(-pose.eye.z),   &drawn().rest,
                          &drawn().blocks, seen ? seen->faces(faces) : faces, &drawn().mesh_grass};
  resolve->run(visible, drawn().triangles, drawn().posed, rest, camera, planes, batch);
}

void FrameRunner::Impl::shade() {
  resolve_batch();
  visibility->see(obscurance_view(camera));
  visibility->run(&pose, owners, planes);
}

FrameRunner::FrameRunner(Device& device, const World& world, std::uint32_t most_posed_vertices)
    : impl_(std::make_unique<Impl>(device, world, most_posed_vertices)) {}
FrameRunner::~FrameRunner() = default;

void FrameRunner::choose(const Methods& methods) { impl_->choose(methods); }
const Plan& FrameRunner::plan() const { return impl_->plan; }

Frame FrameRunner::render(int index, double time, glm::dvec2 pixel_offset) {
  Frame frame;
  render(frame, index, time, pixel_offset);
  return frame;
}

void FrameRunner::render(Frame& frame, int index, double time, glm::dvec2 pixel_offset) {
  const Scene& scene = impl_->world.scene;
  const auto pose_now = impl_->seen ? pose_without_plants : pose_at;
  impl_->pose = pose_now(impl_->world, time, scene.camera.position);
  impl_->device.take_pass_times();
  impl_->camera = with_guard(camera_view(scene.camera, scene.image, pixel_offset), impl_->guard);
  impl_->draw();
  impl_->shade();

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
  frame.orthographic_height = 0;
  frame.halfwidth.clear();
  frame.rays.clear();
  frame.pass_ms = impl_->device.take_pass_times();
  read_planes(impl_->planes, impl_->pose.eye, frame);
  read_visibility(*impl_->visibility, impl_->planes.row_length, frame);
}

void FrameRunner::shade_again() { impl_->shade(); }

std::uint64_t FrameRunner::drawn_triangles() const { return impl_->drawn_triangles; }

PosedGeometry FrameRunner::posed_geometry() const {
  Impl& impl = *impl_;
  if (impl.seen) {
    if (impl.geometry.vertices == 0) impl.upload_everything();
    impl.pose_everything(pose_at(impl.world, impl.pose.time, impl.pose.eye));
  }
  return read_geometry(impl.geometry, impl.pose.eye);
}

}  // namespace understory
