#include "bench/accuracy_judge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "bench/accuracy_pictures.hpp"
#include "bench/place_regression.hpp"
#include "host/trace/calibrated_world.hpp"
#include "host/trace/frame_truth.hpp"
#include "sim/error.hpp"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr int image_size = 320;    // pixels, both ways
constexpr int picture_rays = 128;  // a pixel
constexpr int reference_rays = 16384;
constexpr double field_of_view = 0.6;

/// While only positions are rendered.
Methods no_methods() { return {.tree = "none", .grass = "none", .crowns = "none", .occluders = "none"}; }

World world_of(const AccuracySubject& subject) {
  Scene scene = subject.scene;
  scene.name = subject.name;
  scene.image = {image_size, image_size};
  scene.methods = no_methods();
  World world = build_world(scene);
  calibrate_world(world);
  return world;
}

/// What the cameras look at: everything but the terrain.
struct Bounds {
  glm::dvec3 low{1e9}, high{-1e9};
  void add(glm::dvec3 a, glm::dvec3 b) { low = glm::min(low, a), high = glm::max(high, b); }
};

Bounds bounds_of(const World& world) {
  Bounds bounds;
  for (const Instance& instance : world.instances) {
    if (instance.role == Instance::Role::terrain) continue;
    const Prototype& prototype = world.prototypes[instance.prototype];
    // Yaw is left out: cameras look at the sphere about the box, which hardly grows with it.
    bounds.add(instance.position + instance.scale * glm::dvec3(prototype.low),
               instance.position + instance.scale * glm::dvec3(prototype.high));
  }
  for (const GrassField& field : world.scene.grass)
    bounds.add({field.region.low, 0}, {field.region.high, field.height.mean});
  return bounds;
}

Camera camera_at(const Bounds& bounds, int side, double elevation) {
  const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
  const double radius = 0.5 * glm::length(bounds.high - bounds.low), azimuth = (side + 0.1) * glm::half_pi<double>();
  const double distance = radius / std::tan(0.5 * field_of_view);
  Camera camera;
  camera.target = centre;
  camera.position = centre + distance * glm::dvec3(std::cos(elevation) * std::cos(azimuth),
                                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  camera.vertical_fov = field_of_view;
  return camera;
}

const char* surface_name(SurfaceClass surface) {
  switch (surface) {
    case SurfaceClass::leaf:
    case SurfaceClass::wood:
      return "plant";
    case SurfaceClass::blade:
      return "blades";
    case SurfaceClass::terrain:
      return "ground";
    default:
      return "";
  }
}

/// At most `count` of them, at random but always the same.
void thin_out(std::vector<std::size_t>& pixels, std::size_t count) {
  std::sort(pixels.begin(), pixels.end(), [](auto a, auto b) { return mix_bits(a) < mix_bits(b); });
  if (pixels.size() > count) pixels.resize(count);
}

template <typename T>
void append(const std::vector<T>& part, std::vector<T>& all) {
  all.insert(all.end(), part.begin(), part.end());
}

void append(const Truth& part, Truth& all) {
  append(part.visibility, all.visibility);
  append(part.halfwidth, all.halfwidth);
  append(part.rays, all.rays);
}

}  // namespace

AccuracyJudge::AccuracyJudge(Device& device, const AccuracySubject& subject, const AccuracyOptions& options)
    : name_(subject.name), setting_(subject.setting), world_(world_of(subject)), runner_(device, world_) {
  const Bounds bounds = bounds_of(world_);
  for (int side = 0; side < 4; ++side) {
    Side& seen = sides_.emplace_back();
    seen.camera = camera_at(bounds, side, subject.elevation);
    seen.time = subject.first_time + side * subject.time_step;
    const Frame frame = render(seen);
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
      const std::string surface = surface_name(frame.owners.at(frame.owner[i]).surface);
      const glm::dvec2 place(frame.position[0][i], frame.position[1][i]);
      // Ground counts where the plants have a say, not out to the horizon.
      const bool near = glm::length(place - glm::dvec2(bounds.low + bounds.high) / 2.0) <
                        0.75 * glm::length(glm::dvec2(bounds.high - bounds.low));
      if (surface.empty() || (surface == "ground" && !(subject.ground && near))) continue;
      seen.pixels[surface].push_back(i);
    }
    for (auto& [surface, pixels] : seen.pixels) thin_out(pixels, options.fragments);
    trace(seen, options);
  }
}

Frame AccuracyJudge::render(const Side& side) {
  world_.scene.camera = side.camera;
  return runner_.render(0, side.time);
}

void AccuracyJudge::trace(Side& side, const AccuracyOptions& options) {
  Frame frame = render(side);
  tracer_.emplace(tracer_of(runner_.posed_geometry()));
  TruthOptions truth_options;
  truth_options.sky = world_.scene.sky;
  truth_options.eye = glm::vec3(side.camera.position);
  for (const auto& [surface, pixels] : side.pixels) {
    Points points;
    for (const std::size_t i : pixels) {
      points.positions.emplace_back(frame.position[0][i], frame.position[1][i], frame.position[2][i]);
      points.normals.emplace_back(frame.normal[0][i], frame.normal[1][i], frame.normal[2][i]);
    }
    truth_options.rays = options.rays;
    append(trace_truth(*tracer_, points.positions, points.normals, truth_options), truth_[surface]);
    append(points.positions, points_[surface].positions);
    append(points.normals, points_[surface].normals);
  }
  if (options.pictures.empty() || &side != &sides_.front()) return;
  truth_options.rays = picture_rays;
  trace_frame(*tracer_, truth_options, frame);
  first_truth_ = std::move(frame);
}

std::map<std::string, ErrorStatistics> AccuracyJudge::errors(const Methods& methods) {
  try {
    (void)make_plan(world_, methods);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::invalid_input) return {};
    throw;
  }
  runner_.choose(methods);
  std::map<std::string, std::vector<float>> values;
  for (const Side& side : sides_) {
    const Frame frame = render(side);
    for (const auto& [surface, pixels] : side.pixels)
      for (const std::size_t i : pixels) values[surface].push_back(frame.visibility[i]);
  }
  std::map<std::string, ErrorStatistics> result;
  for (const auto& [surface, value] : values) {
    const Truth& truth = truth_.at(surface);
    result[surface] = error_statistics(value, truth.visibility, truth.halfwidth, truth.rays);
  }
  return result;
}

ErrorStatistics AccuracyJudge::best_of_ball(glm::dvec4 ball) const {
  const Points& points = points_.at("plant");
  const Truth& truth = truth_.at("plant");
  std::vector<glm::dvec2> places;
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const glm::dvec3 p = (glm::dvec3(points.positions[i]) - glm::dvec3(ball)) / ball.w;
    const double distance = std::max(glm::length(p), 1e-9);
    // Dense crowns go dark within a fraction of their radius: depth counts three times.
    places.emplace_back(3 * distance, glm::dot(p, glm::dvec3(points.normals[i])) / distance);
  }
  return error_statistics(best_of_place(places, truth.visibility), truth.visibility, truth.halfwidth, truth.rays);
}

TruthRow AccuracyJudge::truth_itself() const {
  const Points& points = points_.at("plant");
  TruthOptions options;
  options.sky = world_.scene.sky;
  options.eye = glm::vec3(sides_.front().camera.position);
  options.seed = 2;
  const auto started = std::chrono::steady_clock::now();
  const Truth truth = trace_truth(*tracer_, points.positions, points.normals, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  TruthRow row;
  row.scene = name_;
  row.setting = setting_;
  row.fragments = truth.visibility.size();
  row.rays = options.rays;
  row.rays_per_s = static_cast<double>(row.fragments) * row.rays / elapsed.count();
  options.rays = reference_rays;
  options.seed = 3;
  const Truth exact = trace_truth(*tracer_, points.positions, points.normals, options);
  for (std::size_t i = 0; i < row.fragments; ++i) {
    const bool inside = std::abs(truth.visibility[i] - exact.visibility[i]) <= truth.halfwidth[i];
    const int tenth = std::min(9, static_cast<int>(10 * exact.visibility[i]));
    row.inside += inside;
    row.tenth_inside[tenth] += inside;
    ++row.tenth_fragments[tenth];
  }
  row.inside /= static_cast<double>(row.fragments);
  for (int tenth = 0; tenth < 10; ++tenth)
    if (row.tenth_fragments[tenth] > 0) row.tenth_inside[tenth] /= static_cast<double>(row.tenth_fragments[tenth]);
  return row;
}

void AccuracyJudge::write_pictures(const Methods& methods, const std::string& method_name,
                                   const std::filesystem::path& folder) {
  runner_.choose(methods);
  const std::string name = name_ + " " + setting_ + " " + method_name;
  write_accuracy_picture(folder, name, name, first_truth_, render(sides_.front()));
}

}  // namespace understory
