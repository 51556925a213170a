// obscurance_samples > host/passes/obscurance_samples.cpp: the tables of sample sets, always the same. Minutes.
#include <fmt/format.h>

#include <vector>

#include "bench/sample_relaxation.hpp"

namespace understory {
namespace {

constexpr std::uint64_t seed = 1;
constexpr int starts = 30;

void print_set(const RelaxedSamples& samples) {
  const bool disc = samples.domain == SampleDomain::disc;
  fmt::print("constexpr ObscuranceSample {}_{}[] = {{\n", disc ? "lines" : "points", samples.points.size());
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const glm::dvec3 p = samples.points[i];
    fmt::print("    {{{:.7f}f, {:.7f}f, {:.7f}f, {:.7f}f, {:.7f}f}},\n", p.x, p.y, p.z, samples.constant_share[i],
               samples.quadratic_share[i]);
  }
  fmt::print("}};\n\n");
}

void print_row(const RelaxedSamples& samples) {
  const bool disc = samples.domain == SampleDomain::disc;
  fmt::print("    {{{}_{}, {}, {}, {:.4f}, {:.5f}}},\n", disc ? "lines" : "points", samples.points.size(),
             samples.centre, seed, samples.deviation, samples.noise);
}

void print_sets(const char* name, const std::vector<RelaxedSamples>& sets) {
  for (const RelaxedSamples& samples : sets) print_set(samples);
  fmt::print("constexpr ObscuranceSampleSet {}[] = {{\n", name);
  for (const RelaxedSamples& samples : sets) print_row(samples);
  fmt::print("}};\n\n");
}

const char* const head =
    R"(// Written by `obscurance_samples` (bench/obscurance_samples.cpp). x, y, z, constant share, quadratic share.
#include "host/passes/obscurance_samples.hpp"

#include <string>

#include "sim/error.hpp"

// clang-format off
namespace understory {
namespace {

)";

const char* const tail =
    R"(const ObscuranceSampleSet& find(std::span<const ObscuranceSampleSet> sets, int count, const char* what) {
  std::string allowed;
  for (const ObscuranceSampleSet& set : sets) {
    if (static_cast<int>(set.samples.size()) == count) return set;
    allowed += " " + std::to_string(set.samples.size());
  }
  throw Error(ErrorKind::invalid_input, std::to_string(count) + " " + what + ": no such sample set; allowed:" + allowed);
}

}  // namespace

const ObscuranceSampleSet& line_samples(int count) { return find(line_sets, count, "lines"); }
const ObscuranceSampleSet& point_samples(int count) { return find(point_sets, count, "points"); }

}  // namespace understory
)";

}  // namespace
}  // namespace understory

int main() {
  using namespace understory;
  std::vector<RelaxedSamples> lines, points;
  for (const int count : {1, 4, 5, 7, 9, 12, 13, 15, 16}) {
    const bool centre = count != 4 && count != 12 && count != 15;
    lines.push_back(relax_samples(SampleDomain::disc, count, centre, seed, starts, true));
  }
  for (const int count : {6, 12, 33})
    points.push_back(relax_samples(SampleDomain::ball, count, false, seed, starts, true));
  fmt::print("{}", head);
  print_sets("line_sets", lines);
  print_sets("point_sets", points);
  fmt::print("{}", tail);
}
