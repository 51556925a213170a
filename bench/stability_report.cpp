// stability.json and stability.md.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/stability.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

Json optional_number(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json row_json(const StabilityRow& row, bool relaxed) {
  Json json = {{"kernel", row.kernel},
               {"case", row.name},
               {"domain", row.extreme ? "extreme" : "normal"},
               {"values", row.values},
               {"max_abs_error", optional_number(row.max_abs_error)},
               {"bar", row.bar},
               {"stated_error", row.stated_error},
               {"last_place", row.last_place},
               {"finite", row.finite},
               {"in_range", row.in_range},
               {"lowest", row.lowest},
               {"highest", row.highest},
               {"continuous_within", optional_number(row.largest_jump)},
               {"monotone_within", optional_number(row.largest_fall)},
               {"passed", row.passed},
               {"reason", row.reason}};
  Json codes = Json::object();
  for (const auto& [code, count] : row.validity) codes[std::to_string(code)] = count;
  json["validity"] = codes;
  if (relaxed)
    json["relaxed"] = {{"max_abs_error", optional_number(row.relaxed_max_abs_error)},
                       {"finite", row.relaxed_finite},
                       {"in_range", row.relaxed_in_range}};
  return json;
}

std::string number(const std::optional<double>& value) { return value ? fmt::format("{:.1e}", *value) : "–"; }

std::string bounds(bool finite, bool in_range) { return !finite ? "**not finite**" : in_range ? "yes" : "**beyond**"; }

std::string codes_of(const StabilityRow& row) {
  std::string text;
  for (const auto& [code, count] : row.validity) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", code, count);
  return text;
}

void add_row(const StabilityRow& row, bool relaxed, std::string& text) {
  text += fmt::format("| {}{} | {} | {} | {} | {} | {} | {} | {} |", row.passed ? "" : "**failed**: ", row.name,
                      row.values, bounds(row.finite, row.in_range), number(row.max_abs_error), number(row.bar),
                      number(row.largest_jump), number(row.largest_fall), codes_of(row));
  if (relaxed)
    text +=
        fmt::format(" {} | {} |", bounds(row.relaxed_finite, row.relaxed_in_range), number(row.relaxed_max_abs_error));
  text += '\n';
}

/// What tables and fits of some kernels state, each once.
struct StatedError {
  std::string kernels, reason;
  double error = 0;  // the largest
};

std::vector<StatedError> stated_errors(const StabilityReport& report) {
  std::vector<StatedError> all;
  for (const StabilityRow& row : report.rows) {
    if (row.stated_error <= 0) continue;
    const auto known = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.reason == row.note; });
    if (known == all.end()) {
      all.push_back({row.kernel, row.note, row.stated_error});
      continue;
    }
    if ((", " + known->kernels + ",").find(", " + row.kernel + ",") == std::string::npos)
      known->kernels += ", " + row.kernel;
    known->error = std::max(known->error, row.stated_error);
  }
  return all;
}

constexpr const char* head = R"(# Stability at the extremes

Every kernel's V on the device beside the same model in double with exact transcendental functions. The bar on |error| is
2e-6 in the normal domain and 1e-4 at the extremes, plus what the model's tables and fits state. A value may exceed it by
what eight units in the last place of the largest component of its position and normal change: no float kernel can know
better. `jump` is the largest step of V across a branch between inputs one unit in the last place apart, beyond the model's
own slope; `fall` is the largest decrease where V must not fall.
)";
constexpr const char* limits = R"(
## Known limits of the models

- The three solid angles clip a sphere by the receiver's tangent plane only: under `sky: dome` a sphere that is wholly
  below the horizon still darkens a tilted receiver that faces it.
- Obscurance samples whole pixels: a sample on the border between two of them may take either, which no comparison counts.
- Inside a body's solid, grids know no more than their samples: validity code 16 is set in cells that have a corner
  whose neighbours all lie inside. In the layer of one or two cells along the surface it is not, and grids hold there what
  the nearest point of the surface sees.
)";

}  // namespace

std::string stability_json(const StabilityReport& report) {
  Json rows = Json::array();
  for (const StabilityRow& row : report.rows) rows.push_back(row_json(row, report.relaxed));
  const Json json = {{"device", {{"name", report.device.name}, {"version", report.device.version}}},
                     {"build_options", {{"judged", ""}, {"relaxed", "-cl-fast-relaxed-math"}}},
                     {"cases", report.rows.size()},
                     {"failures", report.failures()},
                     {"rows", rows}};
  return json.dump(2) + '\n';
}

std::string stability_markdown(const StabilityReport& report) {
  std::size_t values = 0, relaxed_bad = 0;
  for (const StabilityRow& row : report.rows) {
    values += row.values;
    relaxed_bad += !row.relaxed_finite || !row.relaxed_in_range;
  }
  std::string text = head;
  text += fmt::format("\nDevice: {}. {} cases of {} values: {} failed.", report.device.name, report.rows.size(), values,
                      report.failures());
  if (report.relaxed)
    text += fmt::format(" With -cl-fast-relaxed-math, never the default, {} cases leave [0, 1] or the numbers.",
                        relaxed_bad);
  text +=
      "\n\n## Above the bar, and why\n\n| kernel | case | error | bar | one unit in the last place | reason |\n"
      "|---|---|---|---|---|---|\n";
  for (const StabilityRow& row : report.rows)
    if (row.max_abs_error.value_or(0) > row.bar || !row.passed)
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", row.kernel, row.name, number(row.max_abs_error),
                          number(row.bar), number(row.last_place), row.passed ? row.reason : "**failed**");
  text += "\n## Stated errors\n\n| kernel | stated | of what |\n|---|---|---|\n";
  for (const StatedError& one : stated_errors(report))
    text += fmt::format("| {} | {:.1e} | {} |\n", one.kernels, one.error, one.reason);
  std::string kernel;
  for (const StabilityRow& row : report.rows) {
    if (row.kernel != kernel) {
      kernel = row.kernel;
      text += fmt::format(
          "\n## {}\n\n| case | values | in [0, 1] | error | bar | jump | fall | validity codes |{}\n{}\n", kernel,
          report.relaxed ? " relaxed: in [0, 1] | error |" : "",
          report.relaxed ? "|---|---|---|---|---|---|---|---|---|---|" : "|---|---|---|---|---|---|---|---|");
    }
    add_row(row, report.relaxed, text);
  }
  return text + limits;
}

}  // namespace understory
