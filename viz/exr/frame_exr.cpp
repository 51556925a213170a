// Frame to named planes and attributes and back.
#include "viz/exr/frame_exr.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "sim/error.hpp"
#include "viz/exr/image.hpp"
#include "viz/exr/owner_table.hpp"

namespace understory {
namespace {

constexpr const char* axis_names[] = {"X", "Y", "Z"};
constexpr const char* light_names[] = {"R", "G", "B"};
constexpr const char* term_suffix = ".Y";

/// OpenEXR's camera is left-handed, x right, y up, +z forward ("Standard Attributes"); ours looks along -z.
glm::dmat4 flip_z(glm::dmat4 world_to_camera) {
  for (int column = 0; column < 4; ++column) world_to_camera[column].z *= -1;
  return world_to_camera;
}

Plane valid_mask(const Frame& frame) {
  Plane mask(frame.pixels(), 1.0f);
  for (std::size_t i = 0; i < mask.size(); ++i)
    if ((frame.validity.at(i) & validity::background) != 0) mask[i] = 0.0f;
  return mask;
}

std::string methods_to_json(const Methods& methods) {
  return nlohmann::json{{"tree", methods.tree},           {"grass", methods.grass}, {"crowns", methods.crowns},
                        {"occluders", methods.occluders}, {"near", methods.near},   {"ambient", methods.ambient}}
      .dump();
}

template <class Table>
const auto& need(const Table& table, const std::string& name, const std::filesystem::path& path) {
  const auto at = table.find(name);
  if (at == table.end())
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("{}: no `{}`; only frames written by this program can be read as such", path.string(), name));
  return at->second;
}

}  // namespace

glm::dmat4 world_to_ndc(const Frame& frame) {
  const double half_height = std::tan(0.5 * frame.vertical_fov);
  const double half_width = half_height * frame.width / frame.height;
  glm::dmat4 ndc(0);
  // x' = x / (2 half_width) + w/2, y' = -y / (2 half_height) + w/2, with w = -z before the divide.
  ndc[0][0] = 0.5 / half_width;
  ndc[1][1] = -0.5 / half_height;
  ndc[2][0] = -0.5;
  ndc[2][1] = -0.5;
  ndc[3][2] = frame.near_plane;
  ndc[2][3] = -1;
  return ndc * frame.world_to_camera;
}

void write_frame_exr(const std::filesystem::path& path, const Frame& frame, const ExrAttributes& attributes) {
  ExrImage image{frame.width, frame.height, {}, {}, {}};
  image.floats["Y"] = frame.visibility;
  for (const auto& [method, plane] : frame.terms) image.floats[method + term_suffix] = plane;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    image.floats[std::string("P.") + axis_names[axis]] = frame.position[axis];
    image.floats[std::string("N.") + axis_names[axis]] = frame.normal[axis];
  }
  for (std::size_t channel = 0; channel < 3 && !frame.ambient_light[channel].empty(); ++channel)
    image.floats[light_names[channel]] = frame.ambient_light[channel];
  image.floats["Z"] = frame.depth;
  image.floats["A"] = valid_mask(frame);
  if (!frame.height_above_root.empty()) image.floats["height"] = frame.height_above_root;
  image.integers["owner"] = frame.owner;
  image.integers["validity"] = frame.validity;
  if (!frame.halfwidth.empty()) image.floats["halfwidth"] = frame.halfwidth;
  if (!frame.rays.empty()) image.integers["rays"] = frame.rays;

  auto& [texts, numbers, vectors, matrices] = image.attributes;
  texts["understory:version"] = UNDERSTORY_VERSION;
  texts["understory:unit"] = "m";
  texts["understory:owners"] = owners_to_json(frame.owners);
  texts["understory:methods"] = methods_to_json(attributes.methods);
  texts["understory:seed"] = std::to_string(attributes.seed);  // 64 bits; header integers have 32
  if (!attributes.scene_sha256.empty()) texts["understory:scene_sha256"] = attributes.scene_sha256;
  if (!attributes.channels_in.empty()) texts["understory:channels_in"] = attributes.channels_in;
  if (!attributes.adaptive.empty()) texts["understory:adaptive"] = attributes.adaptive;
  if (!attributes.truth.empty()) texts["understory:truth"] = attributes.truth;
  numbers["understory:frame"] = frame.index;
  numbers["understory:time_s"] = frame.time;
  numbers["understory:vertical_fov_rad"] = frame.vertical_fov;
  if (frame.orthographic_height > 0) numbers["understory:orthographic_height_m"] = frame.orthographic_height;
  numbers["understory:near_plane_m"] = frame.near_plane;
  vectors["understory:origin"] = frame.origin;
  matrices["worldToCamera"] = flip_z(frame.world_to_camera);
  matrices["understory:world_to_camera"] = frame.world_to_camera;  // 64 bits
  if (frame.vertical_fov > 0) matrices["worldToNDC"] = world_to_ndc(frame);
  write_exr(path, image);
}

Frame read_frame_exr(const std::filesystem::path& path) {
  ExrImage image = read_exr(path);
  const auto& [texts, numbers, vectors, matrices] = image.attributes;
  need(texts, "understory:version", path);
  Frame frame;
  frame.width = image.width;
  frame.height = image.height;
  frame.index = static_cast<int>(need(numbers, "understory:frame", path));
  frame.time = need(numbers, "understory:time_s", path);
  frame.vertical_fov = need(numbers, "understory:vertical_fov_rad", path);
  if (const auto found = numbers.find("understory:orthographic_height_m"); found != numbers.end())
    frame.orthographic_height = found->second;
  frame.near_plane = need(numbers, "understory:near_plane_m", path);
  frame.origin = need(vectors, "understory:origin", path);
  frame.world_to_camera = need(matrices, "understory:world_to_camera", path);
  try {
    frame.owners = owners_from_json(need(texts, "understory:owners", path));
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}", path.string(), error.what()));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    frame.position[axis] = need(image.floats, std::string("P.") + axis_names[axis], path);
    frame.normal[axis] = need(image.floats, std::string("N.") + axis_names[axis], path);
  }
  frame.depth = need(image.floats, "Z", path);
  frame.visibility = need(image.floats, "Y", path);
  frame.owner = need(image.integers, "owner", path);
  frame.validity = need(image.integers, "validity", path);
  if (const auto height = image.floats.find("height"); height != image.floats.end())
    frame.height_above_root = height->second;
  if (const auto halfwidth = image.floats.find("halfwidth"); halfwidth != image.floats.end())
    frame.halfwidth = halfwidth->second;
  if (const auto rays = image.integers.find("rays"); rays != image.integers.end()) frame.rays = rays->second;
  for (std::size_t channel = 0; channel < 3; ++channel)
    if (const auto light = image.floats.find(light_names[channel]); light != image.floats.end())
      frame.ambient_light[channel] = light->second;
  for (auto& [name, plane] : image.floats)
    if (name.size() > 2 && name.ends_with(term_suffix) && name != "P.Y" && name != "N.Y")
      frame.terms[name.substr(0, name.size() - 2)] = std::move(plane);
  for (const std::uint32_t owner : frame.owner)
    if (owner >= frame.owners.size() && !(owner == 0 && frame.owners.empty()))
      throw Error(ErrorKind::invalid_input, fmt::format("{}: owner {} of a pixel is not in the table of {} rows",
                                                        path.string(), owner, frame.owners.size()));
  return frame;
}

}  // namespace understory
