// The sway of the generated birch beside an animated birch of another tool (Blender's Sapling, MANIFEST.md): how far
// its parts move, by height.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "sim/pose.hpp"
#include "tests/reference/pose_mesh.hpp"
#include "tests/support/data.hpp"
#include "tests/support/scenes.hpp"

namespace understory {
namespace {

constexpr int bands = 4;
using Profile = std::array<double, bands>;

/// Positions of a binary little-endian PLY whose vertices are three floats.
std::vector<glm::vec3> ply_points(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  std::size_t count = 0;
  while (std::getline(stream, line) && line != "end_header")
    if (line.starts_with("element vertex ")) count = std::stoul(line.substr(15));
  std::vector<glm::vec3> points(count);
  stream.read(reinterpret_cast<char*>(points.data()), static_cast<std::streamsize>(count * sizeof(glm::vec3)));
  EXPECT_TRUE(stream.good()) << file;
  return points;
}

/// Root mean square distance of the points from their own mean over time, m, in bands of equal height.
Profile motion_by_height(const std::vector<std::vector<glm::vec3>>& frames, const std::vector<glm::vec3>& rest) {
  float top = 0;
  for (const glm::vec3& point : rest) top = std::max(top, point.z);
  Profile sum{}, count{};
  for (std::size_t i = 0; i < rest.size(); ++i) {
    glm::vec3 mean(0);
    for (const auto& frame : frames) mean += frame[i] / float(frames.size());
    const int band = std::clamp(int(bands * rest[i].z / top), 0, bands - 1);
    for (const auto& frame : frames) sum[band] += glm::dot(frame[i] - mean, frame[i] - mean);
    count[band] += double(frames.size());
  }
  for (int band = 0; band < bands; ++band) sum[band] = std::sqrt(sum[band] / count[band]);
  return sum;
}

const std::array<double, 8> frame_times{0, 4 / 24., 8 / 24., 12 / 24., 16 / 24., 20 / 24., 24 / 24., 28 / 24.};

/// Mean profile of four stretches of a windy minute, every ninth vertex.
Profile generated_birch(double speed) {
  SpeciesSource species = small_species("birch", 4000);
  species.height = 16.1;
  Scene scene = one_plant(species);
  scene.wind.speed = speed;
  scene.has_terrain = false;
  const World world = build_world(scene);
  const Prototype& prototype = world.prototypes[0];
  std::vector<std::size_t> chosen;
  std::vector<glm::vec3> rest;
  for (std::size_t v = 0; v < prototype.vertices.x.size(); v += 9) {
    chosen.push_back(v);
    rest.emplace_back(prototype.vertices.x[v], prototype.vertices.y[v], prototype.vertices.z[v]);
  }
  Profile mean{};
  for (double start : {0.0, 15.0, 30.0, 45.0}) {
    std::vector<std::vector<glm::vec3>> frames;
    for (double time : frame_times) {
      const Pose pose = pose_at(world, start + time, {0, 0, 0});
      frames.emplace_back();
      for (std::size_t v : chosen) frames.back().emplace_back(reference::posed_vertex(prototype, pose, 0, v));
    }
    const Profile profile = motion_by_height(frames, rest);
    for (int band = 0; band < bands; ++band) mean[band] += profile[band] / 4;
  }
  return mean;
}

std::string written(const Profile& profile) {
  std::ostringstream text;
  for (double value : profile) text << ' ' << value;
  return text.str();
}

TEST(SwayAmplitude, GrowsWithHeightAndWithWind) {
  const Profile calm = generated_birch(2), breeze = generated_birch(7);
  for (int band = 0; band < bands; ++band) {
    EXPECT_GT(breeze[band], calm[band]);
    if (band > 0) {
      EXPECT_GT(breeze[band], breeze[band - 1]) << written(breeze);
    }
  }
}

TEST(SwayAmplitude, IsOfTheOrderOfAnAnimatedBirch) {
  UNDERSTORY_NEEDS_DATA();
  std::vector<std::vector<glm::vec3>> frames;
  for (const char* name :
       {"f01", "f05_points", "f09_points", "f13_points", "f17_points", "f21_points", "f25_points", "f29_points"})
    frames.push_back(ply_points(data_folder() / "birch_wind" / ("birch_wind_" + std::string(name) + ".ply")));
  const Profile animated = motion_by_height(frames, frames[0]);
  const Profile generated = generated_birch(10);
  // The animator's wind has no unit: within a factor of four in every band above the foot.
  for (int band = 1; band < bands; ++band) {
    EXPECT_GT(generated[band], animated[band] / 4) << written(animated) << " |" << written(generated);
    EXPECT_LT(generated[band], animated[band] * 4) << written(animated) << " |" << written(generated);
  }
  std::cout << "rms motion by height, m: animated" << written(animated) << ", generated" << written(generated) << '\n';
}

}  // namespace
}  // namespace understory
