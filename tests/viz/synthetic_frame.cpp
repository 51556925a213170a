// One ray per pixel against four shapes; nearest hit wins.
#include "tests/viz/synthetic_frame.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace understory {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Hit {
  double distance = infinity;
  glm::dvec3 normal{0};
  std::uint32_t owner = 0;
  double height = 0;
};

struct Ball {
  glm::dvec3 centre;
  double radius;
  std::uint32_t owner;
};

void cast_plane(glm::dvec3 eye, glm::dvec3 ray, Hit& hit) {
  const double distance = -eye.z / ray.z;
  if (distance > 0 && distance < hit.distance) hit = {distance, {0, 0, 1}, 1, 0};
}

void cast_ball(const Ball& ball, glm::dvec3 eye, glm::dvec3 ray, Hit& hit) {
  const double middle = glm::dot(ball.centre - eye, ray);
  const double square = ball.radius * ball.radius - glm::dot(ball.centre - eye, ball.centre - eye) + middle * middle;
  if (square < 0 || middle - std::sqrt(square) < 0 || middle - std::sqrt(square) > hit.distance) return;
  const double distance = middle - std::sqrt(square);
  hit = {distance, (eye + distance * ray - ball.centre) / ball.radius, ball.owner, 0};
}

void cast_blades(glm::dvec3 eye, glm::dvec3 ray, Hit& hit) {
  const double distance = (3 - eye.y) / ray.y;
  if (!(distance > 0) || distance > hit.distance) return;
  const glm::dvec3 p = eye + distance * ray;
  const double blade = p.x * 20 - std::floor(p.x * 20);  // every 5 cm, a third of it wide, pointed
  if (std::abs(p.x) > 3 || p.z < 0 || p.z > 0.5 * (1 - 3 * std::abs(blade - 0.5))) return;
  hit = {distance, {0, -1, 0}, 4, p.z};
}

/// Cosine-weighted share that a ball above leaves: 1 - cos(theta) (r/d)^2, its disc taken as wholly above.
double share_left(const Ball& ball, glm::dvec3 p, glm::dvec3 n) {
  const glm::dvec3 to_ball = ball.centre - p;
  const double distance = glm::length(to_ball);
  const double cosine = glm::dot(n, to_ball) / distance;
  return 1 - std::max(0.0, cosine) * std::pow(std::min(1.0, ball.radius / distance), 2);
}

}  // namespace

Frame synthetic_frame(int width, int height, double time) {
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.index = static_cast<int>(time * 24);
  frame.time = time;
  frame.origin = {691234.5, 5335678.25, 512};
  frame.vertical_fov = 0.9;
  frame.near_plane = 0.05;
  const glm::dvec3 eye(0.3, -4, 1.7);
  frame.world_to_camera = glm::lookAt(eye, glm::dvec3(0, 6, 1.5), glm::dvec3(0, 0, 1));
  frame.owners = {{},
                  {SurfaceClass::terrain, "ground", 0, {0.20f, 0.16f, 0.11f}, -1, -1},
                  {SurfaceClass::leaf, "broad \"leaf\"", 1, {0.10f, 0.17f, 0.05f}, 0, 0},
                  {SurfaceClass::occluder, "ball", 2, {0.5f, 0.1f, 0.1f}, -1, 1},
                  {SurfaceClass::blade, "meadow", 0, {0.12f, 0.20f, 0.05f}, -1, -1}};
  const Ball balls[] = {{{-3, 8, 2.5}, 2, 2}, {{2.5 + std::sin(time), 6, 1}, 1, 3}};

  const auto count = frame.pixels();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    frame.position[axis].assign(count, 0);
    frame.normal[axis].assign(count, 0);
  }
  frame.depth.assign(count, std::numeric_limits<float>::infinity());
  frame.owner.assign(count, 0);
  frame.validity.assign(count, validity::background);
  frame.height_above_root.assign(count, 0);
  frame.visibility.assign(count, 1);
  frame.terms["open-dome"].assign(count, 1);
  frame.terms["solid-angle"].assign(count, 1);

  const glm::dmat3 to_world = glm::transpose(glm::dmat3(frame.world_to_camera));
  const double half_height = std::tan(0.5 * frame.vertical_fov);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 seen((2 * (x + 0.5) / width - 1) * half_height * width / height,
                            (1 - 2 * (y + 0.5) / height) * half_height, -1);
      const glm::dvec3 ray = glm::normalize(to_world * seen);
      Hit hit;
      cast_plane(eye, ray, hit);
      for (const Ball& ball : balls) cast_ball(ball, eye, ray, hit);
      cast_blades(eye, ray, hit);
      if (hit.distance > 200) continue;
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const glm::dvec3 p = eye + hit.distance * ray;
      for (int axis = 0; axis < 3; ++axis) {
        frame.position[static_cast<std::size_t>(axis)][i] = static_cast<float>(p[axis]);
        frame.normal[static_cast<std::size_t>(axis)][i] = static_cast<float>(hit.normal[axis]);
      }
      frame.depth[i] = static_cast<float>(-(frame.world_to_camera * glm::dvec4(p, 1)).z);
      frame.owner[i] = hit.owner;
      frame.validity[i] = 0;
      frame.height_above_root[i] = static_cast<float>(hit.height);
      double solid_angle = 1;
      for (const Ball& ball : balls)
        if (ball.owner != hit.owner) solid_angle *= share_left(ball, p, hit.normal);
      frame.terms["open-dome"][i] = static_cast<float>(0.5 * (1 + hit.normal.z));
      frame.terms["solid-angle"][i] = static_cast<float>(solid_angle);
      frame.visibility[i] = frame.terms["open-dome"][i] * frame.terms["solid-angle"][i];
    }
  return frame;
}

}  // namespace understory
