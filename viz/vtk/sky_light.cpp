// Reflected sky light per pixel, then haze. Everything here only serves the eye: files with numbers hold V itself.
#include "viz/vtk/sky_light.hpp"

#include <cmath>

namespace understory {
namespace {

constexpr glm::vec3 fallback_albedo(0.3f);

/// Integer hash with good avalanche (C. Wellons' lowbias32), as a number in [0, 1).
float chance(std::uint32_t key) {
  key = (key ^ (key >> 16)) * 0x7feb352du;
  key = (key ^ (key >> 15)) * 0x846ca68bu;
  return static_cast<float>((key ^ (key >> 16)) >> 8) * 0x1p-24f;
}

/// Smooth noise on the ground, [0, 1]: bilinear between the corners of a square lattice of 1 m / `frequency`.
float ground_noise(float x, float y, float frequency) {
  const float column = std::floor(x * frequency), row = std::floor(y * frequency);
  const float u = x * frequency - column, v = y * frequency - row;
  const auto corner = [&](int i, int j) {
    const auto a = static_cast<std::uint32_t>(static_cast<std::int64_t>(column) + i);
    const auto b = static_cast<std::uint32_t>(static_cast<std::int64_t>(row) + j);
    return chance(a * 0x9e3779b9u + b * 0x85ebca6bu);
  };
  const float s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
  return glm::mix(glm::mix(corner(0, 0), corner(1, 0), s), glm::mix(corner(0, 1), corner(1, 1), s), t);
}

/// No two plants have quite the same green: up to 12 % lighter or darker, 10 % yellower or bluer.
glm::vec3 owner_variation(std::uint32_t owner) {
  const float lightness = 1 + 0.24f * (chance(owner * 2) - 0.5f), warmth = 0.2f * (chance(owner * 2 + 1) - 0.5f);
  return lightness * glm::vec3(1 + warmth, 1, 1 - warmth);
}

glm::vec3 albedo_at(const Frame& frame, std::size_t i, const std::vector<glm::vec3>& plant_albedo) {
  const std::uint32_t row = frame.owner[i];
  if (row == 0 || row >= frame.owners.size()) return fallback_albedo;
  const Owner& owner = frame.owners[row];
  if (owner.surface == SurfaceClass::terrain) {
    const float x = frame.position[0][i], y = frame.position[1][i];
    const float noise =
        0.5f * ground_noise(x, y, 0.4f) + 0.3f * ground_noise(x, y, 1.7f) + 0.2f * ground_noise(x, y, 9);
    return owner.albedo * (0.75f + 0.5f * noise);
  }
  if (owner.surface == SurfaceClass::blade && !frame.height_above_root.empty()) {
    // Blades are pale and dull at the root, yellower and lighter towards the tip.
    const float up = glm::smoothstep(0.0f, 0.5f, frame.height_above_root[i]);
    return plant_albedo[row] * glm::mix(glm::vec3(0.80f, 0.72f, 0.80f), glm::vec3(1.25f, 1.12f, 0.95f), up);
  }
  return plant_albedo[row];
}

/// Light that has bounced brings back more of the surface's own colour the darker its place is. Jimenez et al. 2016,
/// "Practical Real-Time Strategies for Accurate Indirect Occlusion", eq. 10: cubic in V, coefficients linear in albedo.
glm::vec3 with_bounces(float visibility, glm::vec3 albedo) {
  const glm::vec3 a = 2.0404f * albedo - 0.3324f, b = -4.7951f * albedo + 0.6417f, c = 2.7552f * albedo + 0.6903f;
  return glm::max(glm::vec3(visibility), ((visibility * a + b) * visibility + c) * visibility);
}

/// Leaves and blades let through about half as much as they reflect, yellower (Jacquemoud and Baret 1990, PROSPECT).
/// What reaches the far side: the share of sky that occluders leave, over the half dome behind. V = share (1 + n_z)/2.
glm::vec3 light_from_behind(float visibility, float normal_z) {
  const float share = std::min(1.0f, visibility / std::max(0.1f, 0.5f * (1 + normal_z)));
  return share * 0.5f * (1 - normal_z) * glm::vec3(0.55f, 0.55f, 0.25f);
}

/// CIE standard overcast sky, scaled so that a horizontal surface receives what a uniform sky of radiance 1 gives:
/// L_zenith = 9/7. Below the horizon the ground far away is hazed to the horizon's light.
glm::vec3 sky_radiance(const SkyLight& sky, float sine_of_elevation) {
  const float up = std::max(0.0f, sine_of_elevation);
  const glm::vec3 warm_horizon(1.02f, 1.0f, 0.97f);
  return sky.tint * glm::mix(warm_horizon, glm::vec3(0.96f, 0.99f, 1.03f), std::min(1.0f, 2 * up)) * (9.0f / 7.0f) *
         (1 + 2 * up) / 3.0f;
}

/// Radiances of an environment map times this have 1 as the mean that a level surface faces.
float environment_scale(const Frame& frame) {
  const float mean = glm::dot(frame.sky_mean, glm::vec3(0.2126f, 0.7152f, 0.0722f));  // Rec. 709 luminance
  return mean > 0 ? 1 / mean : 1;
}

/// Colour of the sky that a pixel sees, relative to the mean: of the uniform sky its tint.
glm::vec3 colour_of_light(const Frame& frame, std::size_t i, const SkyLight& sky) {
  if (frame.ambient_light[0].empty()) return sky.tint;
  const float scale = environment_scale(frame);
  const glm::vec3 light(frame.ambient_light[0][i], frame.ambient_light[1][i], frame.ambient_light[2][i]);
  return frame.visibility[i] > 1e-3f ? scale * light / frame.visibility[i] : scale * frame.sky_mean;
}

/// What a covered pixel reflects to the camera, relative to the sky's mean.
glm::vec3 surface_radiance(const Frame& frame, std::size_t i, const SkyLight& sky,
                           const std::vector<glm::vec3>& plant_albedo) {
  const glm::vec3 albedo = albedo_at(frame, i, plant_albedo);
  const float visibility = frame.visibility[i], normal_z = frame.normal[2][i];
  const float from_ground = sky.ground_albedo * 0.5f * (1 - normal_z) * (0.3f + 0.7f * visibility);
  glm::vec3 arriving = with_bounces(visibility, albedo) + from_ground;
  const std::uint32_t row = frame.owner[i];
  const SurfaceClass surface = row < frame.owners.size() ? frame.owners[row].surface : SurfaceClass::background;
  if (surface == SurfaceClass::leaf || surface == SurfaceClass::blade)
    arriving += light_from_behind(visibility, normal_z);
  return albedo * colour_of_light(frame, i, sky) * arriving;
}

/// Where the pixel looks.
glm::vec3 view_direction(const Frame& frame, std::size_t i, const glm::mat3& to_world, float half_height) {
  const auto width = static_cast<float>(frame.width), height = static_cast<float>(frame.height);
  const auto x = static_cast<float>(i % static_cast<std::size_t>(frame.width)) + 0.5f;
  const auto y = static_cast<float>(i / static_cast<std::size_t>(frame.width)) + 0.5f;
  const glm::vec3 ray =
      to_world * glm::vec3((2 * x - width) / height * half_height, (1 - 2 * y / height) * half_height, -1);
  return glm::normalize(ray);
}

}  // namespace

LightPicture sky_light_picture(const Frame& frame, const SkyLight& sky) {
  LightPicture result{frame.width, frame.height, std::vector<glm::vec3>(frame.pixels())};
  std::vector<glm::vec3> plant_albedo;
  for (std::uint32_t row = 0; row < frame.owners.size(); ++row) {
    const SurfaceClass surface = frame.owners[row].surface;
    const bool plant = surface == SurfaceClass::leaf || surface == SurfaceClass::blade || surface == SurfaceClass::wood;
    plant_albedo.push_back(frame.owners[row].albedo * (plant ? owner_variation(row) : glm::vec3(1)));
  }
  const glm::mat3 to_world = glm::transpose(glm::mat3(glm::mat4(frame.world_to_camera)));
  const float half_height = std::tan(0.5f * static_cast<float>(frame.vertical_fov));
  const float scale = environment_scale(frame);
  const auto background = [&](glm::vec3 towards) {
    if (!frame.environment) return sky_radiance(sky, towards.z);
    return scale * radiance_towards(*frame.environment, frame.environment_turn, glm::dvec3(towards));
  };
  const glm::vec3 haze = frame.environment ? scale * frame.sky_mean : sky_radiance(sky, 0);
  const float extinction = 3.912f / sky.meteorological_range;  // Koschmieder: ln(1/0.02) over the range
  for (std::size_t i = 0; i < result.light.size(); ++i) {
    if ((frame.validity[i] & validity::background) != 0) {
      result.light[i] = background(view_direction(frame, i, to_world, half_height));
    } else {
      const float kept = std::exp(-extinction * frame.depth[i]);
      result.light[i] = glm::mix(haze, surface_radiance(frame, i, sky, plant_albedo), kept);
    }
  }
  return result;
}

Picture sky_lit_picture(const Frame& frame, const SkyLight& sky) {
  return develop(sky_light_picture(frame, sky), sky.exposure);
}

}  // namespace understory
