// Reads rigid matrices row by row into one track per part, and interpolates between neighbours in time.
#include "sim/motion_record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/error.hpp"
#include "sim/files/csv.hpp"
#include "sim/rotation.hpp"

namespace understory {
namespace {

using Columns = std::array<std::vector<double>, 12>;  // m00, m01, ... m23
constexpr double rigid_tolerance = 1e-3;

Transform rigid_pose(const CsvTable& table, const Columns& columns, std::size_t row, UpAxis up) {
  glm::dmat3 matrix;
  glm::dvec3 translation;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix[j][i] = columns[4 * i + j][row];
    translation[i] = columns[4 * i + 3][row];
  }
  const glm::dmat3 excess = glm::transpose(matrix) * matrix - glm::dmat3(1);
  double error = 0;
  for (int i = 0; i < 3; ++i)
    error = std::max({error, std::abs(excess[i].x), std::abs(excess[i].y), std::abs(excess[i].z)});
  if (error > rigid_tolerance || glm::determinant(matrix) < 0)
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("{}:{}: columns m00 to m22: {}, allowed: a rotation (orthonormal within {})", table.file().string(),
                    table.line(row),
                    error > rigid_tolerance ? fmt::format("not orthonormal by {:.3g}", error) : "a mirror image",
                    rigid_tolerance));
  const glm::dquat rotation = glm::normalize(glm::quat_cast(matrix));
  if (up == UpAxis::z) return {rotation, translation};
  // A turn by 90 degrees about x takes (x, y, z) to (x, -z, y); the axis of every rotation turns with it.
  return {glm::dquat(rotation.w, rotation.x, -rotation.z, rotation.y), {translation.x, -translation.z, translation.y}};
}

Transform between(const Transform& a, const Transform& b, double share) {
  const glm::dvec3 turn = rotation_vector(glm::conjugate(a.rotation) * b.rotation);
  return {a.rotation * rotation_of(turn * share), glm::mix(a.translation, b.translation, share)};
}

/// `time` within one period of the record's start. The last pose leads back to the first across the end of the period.
Transform on_track(const MotionRecord::Track& track, double time, double period) {
  const std::vector<double>& times = track.times;
  const std::vector<Transform>& poses = track.poses;
  if (time < times.front()) time += period;
  const auto after = std::ranges::upper_bound(times, time);
  if (after == times.begin()) return poses.front();  // a record of one instant has no period
  if (after != times.end()) {
    const std::size_t next = static_cast<std::size_t>(after - times.begin());
    return between(poses[next - 1], poses[next], (time - times[next - 1]) / (times[next] - times[next - 1]));
  }
  const double gap = times.front() + period - times.back();
  return gap > 0 ? between(poses.back(), poses.front(), (time - times.back()) / gap) : poses.back();
}

/// Start and period of the whole record, so that its parts stay together.
void close_loop(MotionRecord& record) {
  double end = record.tracks.front().times.back(), step = 0;
  record.start = record.tracks.front().times.front();
  for (const MotionRecord::Track& track : record.tracks) {
    record.start = std::min(record.start, track.times.front());
    end = std::max(end, track.times.back());
    if (track.times.size() > 1 && !same_pose(track.poses.front(), track.poses.back()))
      step = std::max(step, (track.times.back() - track.times.front()) / static_cast<double>(track.times.size() - 1));
  }
  record.period = end - record.start + step;
}

void append(MotionRecord::Track& track, const CsvTable& table, std::size_t row, double time, const Transform& pose) {
  if (!track.times.empty() && !(time > track.times.back()))
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}:{}: column 'time_s': {:.6g} for part '{}', allowed: after its row before, {:.6g}",
                            table.file().string(), table.line(row), time, track.part, track.times.back()));
  track.times.push_back(time);
  track.poses.push_back(pose);
}

}  // namespace

const MotionRecord::Track* MotionRecord::find(const std::string& part) const {
  const auto found = std::ranges::find(tracks, part, &Track::part);
  return found == tracks.end() ? nullptr : &*found;
}

Transform MotionRecord::at(const std::string& part, double time) const {
  const Track* track = find(part);
  if (!track) {
    std::vector<std::string> parts;
    for (const Track& known : tracks) parts.push_back(known.part);
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: no part '{}'; there are: {}", file.string(), part, fmt::join(parts, ", ")));
  }
  const double local = start + (time - start) - (period > 0 ? std::floor((time - start) / period) * period : 0);
  return on_track(*track, local, period);
}

MotionRecord read_motion_record(const std::filesystem::path& file, UpAxis up) {
  const CsvTable table(file);
  const std::vector<double> times = table.numbers("time_s");
  const std::vector<std::string>& parts = table.text("part");
  Columns columns;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) columns[4 * i + j] = table.numbers(fmt::format("m{}{}", i, j));

  MotionRecord record;
  record.file = file;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    auto track = std::ranges::find(record.tracks, parts[row], &MotionRecord::Track::part);
    if (track == record.tracks.end()) track = record.tracks.insert(track, MotionRecord::Track{parts[row], {}, {}});
    append(*track, table, row, times[row], rigid_pose(table, columns, row, up));
  }
  close_loop(record);
  return record;
}

}  // namespace understory
