// From what a person typed to what read_gbuffer takes.
#include "host/app/gbuffer_flags.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "sim/error.hpp"
#include "viz/exr/channel_roles.hpp"

namespace understory {

void add_gbuffer_options(CLI::App& command, GbufferFlags& flags) {
  command.add_option("--channels", flags.channels, "Which layer holds what, when names do not tell")
      ->type_name("ROLE=LAYER,...");
  command.add_option("--space", flags.space, "Space of the positions, when the header does not tell")
      ->check(CLI::IsMember({"world", "camera"}));
  command.add_option("--camera", flags.camera, "Position, target and vertical field of view in degrees")
      ->delimiter(',')
      ->expected(7)
      ->type_name("X,Y,Z,X,Y,Z,FOV");
}

GbufferOptions gbuffer_options(const GbufferFlags& flags) {
  GbufferOptions options;
  options.channels = parse_channel_choices(flags.channels);
  if (flags.space == "world") options.space = GbufferSpace::world;
  if (flags.space == "camera") options.space = GbufferSpace::camera;
  if (const auto& c = flags.camera; !c.empty()) {
    Camera camera;
    camera.position = {c[0], c[1], c[2]};
    camera.target = {c[3], c[4], c[5]};
    camera.vertical_fov = c[6] * glm::pi<double>() / 180;
    const bool finite = std::all_of(c.begin(), c.end(), [](double number) { return std::isfinite(number); });
    if (!finite || camera.position == camera.target || c[6] <= 0 || c[6] >= 180)
      throw Error(ErrorKind::usage, fmt::format("--camera {}: allowed are finite numbers, a target other than the "
                                                "position, and a field of view between 0 and 180 degrees",
                                                fmt::join(c, " ")));
    options.camera = camera;
  }
  return options;
}

}  // namespace understory
