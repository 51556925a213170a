// Formats the summary of a run.
#include "host/app/run_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

namespace understory {
namespace {

/// File names of one kind: same stem and extension.
struct FileKind {
  std::string first, last;
  int count = 0;
};

std::string file_lines(const RunRecord& record) {
  std::map<std::pair<std::string, std::string>, FileKind> kinds;
  for (const auto& [index, frame] : record.frames)
    for (const auto& [name, sha256] : frame.files) {
      const std::filesystem::path path(name);
      FileKind& kind = kinds[{path.stem().string().substr(0, path.stem().string().find('_')), path.extension()}];
      if (kind.count++ == 0) kind.first = name;
      kind.last = name;
    }
  std::string lines;
  for (const auto& [key, kind] : kinds)
    lines += kind.count > 1 ? fmt::format("  {} ... {} ({})\n", kind.first, kind.last, kind.count)
                            : fmt::format("  {}\n", kind.first);
  return lines;
}

std::string time_table(const RunRecord& record) {
  std::map<std::string, std::vector<double>> by_pass;
  std::vector<double> sums, frames;
  for (const auto& [index, frame] : record.frames) {
    double sum = 0;
    for (const auto& [pass, ms] : frame.passes) {
      by_pass[pass].push_back(ms);
      sum += ms;
    }
    sums.push_back(sum);
    frames.push_back(frame.ms);
  }
  std::string table = fmt::format("{:<28}{:>10}\n", "pass", "median ms");
  const auto add_row = [&](const std::string& name, const std::vector<double>& values) {
    table += fmt::format("{:<28}{:>10.2f}\n", name, median(values));
  };
  for (const std::string& pass : record.plan)  // in the order of execution
    if (const auto found = by_pass.find(pass); found != by_pass.end()) {
      add_row(pass, found->second);
      by_pass.erase(found);
    }
  for (const auto& [pass, values] : by_pass) add_row(pass, values);
  add_row("all passes on the device", sums);
  add_row("whole frame", frames);
  return table;
}

/// What was promised and what came of it; empty for a run whose methods were asked for.
std::string budget_lines(const RunRecord& record) {
  if (!record.budget) return "";
  const BudgetRecord& budget = *record.budget;
  std::string text = budget.max_error > 0 ? fmt::format("\n--max-error {:g}: {}\n", budget.max_error, budget.choice)
                                          : fmt::format("\n--max-ms {:g}: {}\n", budget.max_ms, budget.choice);
  text += fmt::format("  RMSE of V in a frame: promised {:.4f} by frames {}", budget.promised_rmse,
                      fmt::join(budget.chosen_by, ", "));
  text += budget.checked_on.empty()
              ? "; the scene has no others to check it on\n"
              : fmt::format("; found {:.4f} on frames {}\n", budget.found_rmse, fmt::join(budget.checked_on, ", "));
  if (budget.max_ms <= 0) return text;
  std::vector<double> sums;
  std::set<std::string> chosen;
  std::size_t late = 0;
  for (const auto& [index, frame] : record.frames) {
    double sum = 0;
    for (const auto& [pass, ms] : frame.passes) sum += ms;
    sums.push_back(sum);
    late += sum > budget.max_ms;
    chosen.insert(frame.chosen);
  }
  return text + fmt::format(
                    "  device time of a frame: promised {:.2f} ms; found {:.2f} ms (median), {} of {} frames over "
                    "the budget\n  adaptive: {} choices of methods were used, `chosen` in run.json tells which\n",
                    budget.promised_ms, median(sums), late, sums.size(), chosen.size());
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

std::string run_summary(const std::filesystem::path& folder, const RunRecord& record) {
  std::string text = fmt::format("{}: {} frames of {}x{}{}\n", folder.string(), record.frames.size(), record.width,
                                 record.height, record.complete ? "" : ", not complete");
  text += file_lines(record);
  for (const char* name : {"planes.pvd", "geometry.pvd", "contact_sheet.png", "movie.ogv", "run.json"})
    if (std::filesystem::exists(folder / name)) text += fmt::format("  {}\n", name);
  text += budget_lines(record);
  return record.frames.empty() ? text : text + '\n' + time_table(record);
}

}  // namespace understory
