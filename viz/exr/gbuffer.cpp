// Channels by role, then background, then camera and space (gbuffer_camera), then a frame as our own passes expect it.
#include "viz/exr/gbuffer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/error.hpp"
#include "viz/exr/channel_roles.hpp"
#include "viz/exr/frame_exr.hpp"
#include "viz/exr/gbuffer_camera.hpp"
#include "viz/exr/gbuffer_normals.hpp"
#include "viz/exr/image.hpp"

namespace understory {
namespace {

constexpr double noticeable_spacing = 1e-3;  // m, between neighbouring half floats: told
constexpr double useless_spacing = 0.05;     // m: refused
constexpr float background_depth = 1e9f;     // Blender writes 1e10

GbufferPlanes read_planes(const std::filesystem::path& path, const ExrHeader& header, const ChannelRoles& roles) {
  std::vector<std::string> names = roles.position.names;
  names.insert(names.end(), roles.normal.names.begin(), roles.normal.names.end());
  for (const auto* role : {&roles.depth, &roles.alpha, &roles.owner})
    if (role->has_value()) names.push_back((*role)->names.front());
  std::vector<Plane> planes = read_exr_floats(path, header, names);
  GbufferPlanes result;
  std::size_t next = 0;
  for (Plane& plane : result.position) plane = std::move(planes[next++]);
  if (!roles.normal.names.empty())
    for (Plane& plane : result.normal) plane = std::move(planes[next++]);
  if (roles.depth) result.depth = std::move(planes[next++]);
  if (roles.alpha) result.alpha = std::move(planes[next++]);
  if (roles.owner) result.owner = std::move(planes[next++]);
  return result;
}

std::vector<std::uint8_t> find_surface(const GbufferPlanes& planes) {
  std::vector<std::uint8_t> surface(planes.position[0].size(), 1);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const glm::vec3 p(planes.position[0][i], planes.position[1][i], planes.position[2][i]);
    const glm::vec3 n = planes.normal[0].empty()
                            ? glm::vec3(1)
                            : glm::vec3(planes.normal[0][i], planes.normal[1][i], planes.normal[2][i]);
    const bool open = (!planes.alpha.empty() && planes.alpha[i] == 0) ||
                      (!planes.depth.empty() && !(planes.depth[i] < background_depth)) || n == glm::vec3(0) ||
                      !std::isfinite(p.x + p.y + p.z) || !std::isfinite(n.x + n.y + n.z);
    surface[i] = open ? 0 : 1;
  }
  return surface;
}

/// Half floats have 11 significant bits: their spacing at the largest coordinate, metres.
void guard_precision(const ExrHeader& header, const ChannelRoles& roles, const GbufferPlanes& planes,
                     const std::vector<std::uint8_t>& surface, std::vector<std::string>& notes) {
  const auto is_half = [&](const std::string& name) { return header.find(name)->sample == ExrSample::half_float; };
  if (std::none_of(roles.position.names.begin(), roles.position.names.end(), is_half)) return;
  float largest = 0;
  for (const Plane& plane : planes.position)
    for (std::size_t i = 0; i < plane.size(); ++i)
      if (surface[i] != 0) largest = std::max(largest, std::abs(plane[i]));
  const double spacing = largest > 0 ? std::exp2(std::floor(std::log2(largest)) - 10) : 0;
  const auto text = fmt::format("positions are 16-bit floats, {:.3g} m apart at {:.4g} m", spacing, largest);
  if (spacing > useless_spacing)
    throw Error(ErrorKind::invalid_input, text + "; at most 0.05 m is of use; render them with 32 bits");
  if (spacing > noticeable_spacing) notes.push_back("warning: " + text);
}

/// Unit normals to the viewer, depth, validity; zeros where nothing is seen.
void fill_frame(GbufferPlanes& planes, const std::vector<std::uint8_t>& surface, Gbuffer& result) {
  Frame& frame = result.frame;
  const glm::dmat4& camera = frame.world_to_camera;
  const glm::dvec3 eye = eye_of(camera), backwards(camera[0][2], camera[1][2], camera[2][2]);
  frame.depth.assign(frame.pixels(), std::numeric_limits<float>::infinity());
  frame.owner.assign(frame.pixels(), 0);
  frame.validity.assign(frame.pixels(), 0);
  std::size_t covered = 0, not_unit = 0, turned = 0;
  for (std::size_t i = 0; i < frame.pixels(); ++i) {
    glm::dvec3 p(0), n(0);
    if (surface[i] != 0) {
      ++covered;
      p = {planes.position[0][i], planes.position[1][i], planes.position[2][i]};
      n = {planes.normal[0][i], planes.normal[1][i], planes.normal[2][i]};
      const double length = glm::length(n);
      if (std::abs(length - 1) > 1e-2) {
        ++not_unit;
        frame.validity[i] |= validity::not_unit;
      }
      n /= length;
      if (glm::dot(n, frame.orthographic_height > 0 ? backwards : eye - p) < 0) {
        ++turned;
        n = -n;
      }
      frame.depth[i] = static_cast<float>(-(frame.world_to_camera * glm::dvec4(p, 1)).z);
      if (!planes.owner.empty() && planes.owner[i] > 0 && planes.owner[i] < 4e9f)
        frame.owner[i] = static_cast<std::uint32_t>(std::lround(planes.owner[i]));
    } else {
      frame.validity[i] = validity::background;
    }
    for (int axis = 0; axis < 3; ++axis) {
      planes.position[static_cast<std::size_t>(axis)][i] = static_cast<float>(p[axis]);
      planes.normal[static_cast<std::size_t>(axis)][i] = static_cast<float>(n[axis]);
    }
  }
  frame.position = std::move(planes.position);
  frame.normal = std::move(planes.normal);
  result.notes.push_back(
      fmt::format("surface: {} of {} pixels; {} normals turned to the viewer", covered, frame.pixels(), turned));
  if (not_unit * 100 > covered)
    result.notes.push_back(
        fmt::format("warning: {} of {} normals are not unit (filtered over edges?); made unit", not_unit, covered));
}

Gbuffer read_own(const std::filesystem::path& path) {
  Gbuffer result{read_frame_exr(path), {}};
  result.frame.terms.clear();
  result.frame.visibility.clear();
  // What the methods of that run flagged says nothing about the next ones.
  for (std::uint32_t& codes : result.frame.validity)
    codes &= validity::background | validity::not_finite | validity::not_unit;
  result.notes = {"a frame of this program: P, N, Z, owner, validity and camera as stored"};
  return result;
}

}  // namespace

Gbuffer read_gbuffer(const std::filesystem::path& path, const GbufferOptions& options) {
  const ExrHeader header = read_exr_header(path);
  if (header.attributes.texts.contains("understory:version") && options.channels.empty()) return read_own(path);
  try {
    std::vector<std::string> names;
    for (const ExrChannel& channel : header.channels) names.push_back(channel.name);
    const ChannelRoles roles = resolve_channel_roles(names, options.channels);
    Gbuffer result;
    const auto tell = [&](const char* role, const RoleChannels& channels) {
      result.notes.push_back(fmt::format("{}: {}", role, fmt::join(channels.names, "/")));
    };
    tell("position", roles.position);
    if (!roles.normal.names.empty()) tell("normal", roles.normal);
    if (roles.depth) tell("depth (background only)", *roles.depth);
    if (roles.alpha) tell("alpha", *roles.alpha);
    if (roles.owner) tell("owner", *roles.owner);
    result.notes.insert(result.notes.end(), roles.notes.begin(), roles.notes.end());
    if (header.data_window_differs)
      result.notes.push_back("data window differs from display window: outside is background");

    result.frame.width = header.width;
    result.frame.height = header.height;
    result.frame.owners.push_back({});
    GbufferPlanes planes = read_planes(path, header, roles);
    const auto surface = find_surface(planes);
    guard_precision(header, roles, planes, surface, result.notes);
    settle_camera(header, options, surface, planes, result);
    if (roles.normal.names.empty()) {
      result.notes.push_back("normal: none in the file; made from the positions");
      planes.normal = normals_from_positions(header.width, header.height, planes.position, surface,
                                             eye_of(result.frame.world_to_camera));
    }
    fill_frame(planes, surface, result);
    return result;
  } catch (const Error& error) {
    const std::string what = error.what();
    if (what.starts_with(path.string())) throw;
    throw Error(error.kind(), fmt::format("{}: {}", path.string(), what));
  }
}

}  // namespace understory
