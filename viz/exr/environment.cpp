#include "viz/exr/environment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/error.hpp"
#include "viz/exr/image.hpp"

namespace understory {

EnvironmentMap read_environment(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::invalid_input, fmt::format("{}: {}", path.string(), why));
  };
  const ExrHeader header = read_exr_header(path);
  if (header.width != 2 * header.height)
    refuse(fmt::format("an environment map of {} x {} pixels; allowed is twice as wide as high", header.width,
                       header.height));
  std::vector<std::string> names{"R", "G", "B"};
  if (!header.find("R") && !header.find("G") && !header.find("B")) names = {"Y"};
  for (const std::string& name : names)
    if (!header.find(name)) refuse(fmt::format("no channel {}; an environment map has R, G, B, or Y", name));
  const std::vector<Plane> planes = read_exr_floats(path, header, names);

  double sum = 0;
  for (const Plane& plane : planes)
    for (const float value : plane) sum += std::isfinite(value) ? double(std::max(0.0f, value)) : 0;
  const double least = -1e-2 * sum / static_cast<double>(planes.size() * planes[0].size());

  EnvironmentMap map{header.width, header.height, std::vector<glm::vec3>(planes[0].size())};
  for (std::size_t i = 0; i < map.radiance.size(); ++i)
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const std::size_t plane = channel % planes.size();
      const float value = planes[plane][i];
      if (!(double(value) >= least && std::isfinite(value)))
        refuse(fmt::format("channel {} is {} in column {}, row {}; allowed are finite radiances from 0", names[plane],
                           value, i % std::size_t(map.width), i / std::size_t(map.width)));
      map.radiance[i][static_cast<int>(channel)] = std::max(0.0f, value);
    }
  return map;
}

}  // namespace understory
