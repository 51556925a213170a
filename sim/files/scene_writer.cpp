// Numbers and paths of a resolved scene, so that what is written reads back to the same bits.
#include "sim/files/scene_writer.hpp"

#include <charconv>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace understory {
namespace {

double to_radians(double value) { return value * (glm::pi<double>() / 180); }  // as the reader does

/// The degrees that the reader turns into this angle: the round number people wrote if there is one.
double to_degrees(double angle) {
  const double exact = angle * (180 / glm::pi<double>());
  const double round = std::round(exact * 1e9) / 1e9;
  if (to_radians(round) == angle) return round;
  for (const double near : {exact, std::nextafter(exact, -1e9), std::nextafter(exact, 1e9)}) {
    if (to_radians(near) == angle) return near;
  }
  return exact;
}

double written(double value, const Range& range) { return range.is_angle ? to_degrees(value) : value; }

/// The shortest decimal that reads back to this float: 0.1 and not 0.10000000149.
double written(float value, const Range&) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double shortest = 0;
  std::from_chars(text, end, shortest);
  return shortest;
}

template <class Float>
nlohmann::ordered_json written_list(std::span<Float> values, const Range& range) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Float value : values) list.push_back(written(value, range));
  return list;
}

}  // namespace

void SceneWriter::number(const char* key, double& value, const Range& range, const char*) {
  if (value != range.unset) json[key] = written(value, range);
}

void SceneWriter::numbers(const char* key, std::span<double> values, const Range& range, const char*) {
  json[key] = written_list(values, range);
}

void SceneWriter::numbers(const char* key, std::span<float> values, const Range& range, const char*) {
  json[key] = written_list(values, range);
}

void SceneWriter::file(const char* key, std::filesystem::path& value, const char*) {
  if (value.empty()) return;
  json[key] = (paths_ == PathStyle::absolute ? value : value.filename()).string();
}

std::string resolved_scene(const Scene& scene, PathStyle paths) {
  Scene copy = scene;  // the table takes references that the reader writes through
  SceneWriter writer(paths);
  keys(writer, copy);
  return writer.json.dump(2) + '\n';
}

}  // namespace understory
