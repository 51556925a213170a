// The table of a tradeoff for people: CSV for spreadsheets, Markdown to read.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "bench/judged_views.hpp"
#include "bench/tradeoff.hpp"

namespace understory {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string joined(const std::vector<std::string>& parts, const char* separator) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

std::string known(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "";
}

std::string spread_text(const Spread95& spread) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", spread.median, spread.low, spread.high);
}

/// "resolve 3.9512; combine 0.2514": medians.
std::string medians_text(const std::map<std::string, Spread95>& passes) {
  std::vector<std::string> parts;
  for (const auto& [name, spread] : passes) parts.push_back(fmt::format("{} {:.4f}", name, spread.median));
  return quoted(joined(parts, "; "));
}

std::string class_rmse(const TradeoffRow& row, const char* name) {
  const auto found = row.classes.find(name);
  return found == row.classes.end() ? "" : fmt::format("{:.3f}", found->second.rmse);
}

/// Number of each row on the front in order of time, by name.
std::map<std::string, int> front_numbers(const TradeoffTable& table) {
  std::map<std::string, int> numbers;
  for (const TradeoffRow& row : table.rows)
    if (row.pareto) numbers.emplace(row.name, static_cast<int>(numbers.size()) + 1);
  return numbers;
}

std::string tie_text(const TradeoffRow& row, const std::map<std::string, int>& numbers) {
  std::vector<std::string> ties;
  for (const std::string& name : row.ties)
    if (const auto found = numbers.find(name); found != numbers.end()) ties.push_back(std::to_string(found->second));
  return joined(ties, ", ");
}

void write_front(const TradeoffTable& table, std::string& text) {
  const auto numbers = front_numbers(table);
  text +=
      "\n## The front\n\nEvery other variant is beaten by one of these: clearly, beyond both intervals, in time or in "
      "error, and not clearly\nworse in the other.\n\n"
      "| | variant | ms | frame ms | RMSE | bias |";
  for (const char* name : judged_class_names) text += fmt::format(" {} |", name);
  text += " MiB | bake s | dV/dt | flicker | ties |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const TradeoffRow& row : table.rows) {
    if (!row.pareto) continue;
    text += fmt::format("| {} | {} | {:.2f} ({:.2f} to {:.2f}) | {:.1f} | {:.4f} ({:.4f} to {:.4f}) | {:+.3f} |",
                        numbers.at(row.name), row.name, row.ms.median, row.ms.low, row.ms.high, row.frame_ms,
                        row.error.rmse, row.error.low, row.error.high, row.error.bias);
    for (const char* name : judged_class_names) text += fmt::format(" {} |", class_rmse(row, name));
    text += fmt::format(" {:.0f} | {} |", row.mib, row.bake_s < 0 ? "" : fmt::format("{:.1f}", row.bake_s));
    text += row.temporal ? fmt::format(" {:.2f} | {:.2f} |", row.temporal->rmse_dvdt, row.temporal->flicker) : " | |";
    text += fmt::format(" {} |\n", tie_text(row, numbers));
  }
  text += "\nTo use one, give `understory run` its settings (relaxed maths is measured only):\n\n";
  for (const TradeoffRow& row : table.rows)
    if (row.pareto && !row.variant.relaxed_maths)
      text += fmt::format("{}. `--set {}`\n", numbers.at(row.name), joined(row.settings, " --set "));
  text += "\nErrors in pictures (truth, variant, difference): `errors/` beside the table.\n";
}

void write_prediction(const TradeoffTable& table, std::string& text) {
  const PredictionQuality& quality = table.prediction;
  text += fmt::format(
      "\n## How well the terms predict the whole\n\nTerms were measured one by one. The time of a combination is the "
      "sum "
      "of what its passes take, its V the product of\nits terms in every judged pixel. So {} combinations were "
      "predicted; {} of them, those on the predicted front and the\nscene's own, were then measured whole. Predicted "
      "time: {:+.1f} % on average, at most {:.1f} % off; predicted RMSE: {:+.4f}\non average, at most {:.4f} off.\n",
      quality.combinations, quality.measured, 100 * quality.ms_bias, 100 * quality.ms_worst, quality.rmse_bias,
      quality.rmse_worst);
}

void write_passes(const TradeoffTable& table, std::string& text) {
  text +=
      "\n## Passes\n\nOf each pass on the front, ms, median and 95 % interval: time on the device's clock / on the "
      "host's, where each pass is\nwaited for before the next, from the end of the one before it, with what the host "
      "prepares for it. `wall`: all of them\ntogether on the host's clock, not waited for one by one.\n\n"
      "| variant | wall | passes |\n|---|---|---|\n";
  for (const TradeoffRow& row : table.rows) {
    if (!row.pareto) continue;
    std::vector<std::string> passes;
    for (const auto& [name, milliseconds] : row.pass_ms) {
      const auto on_host = row.pass_wall_ms.find(name);
      passes.push_back(name + " " + spread_text(milliseconds));
      if (on_host != row.pass_wall_ms.end()) passes.back() += " / " + spread_text(on_host->second);
    }
    text += fmt::format("| {} | {} | {} |\n", row.name, spread_text(row.wall_ms), joined(passes, ", "));
  }
}

void write_all_rows(const TradeoffTable& table, std::string& text) {
  text +=
      "\n## Everything that was measured\n\n`start`: seconds to build the programs and to upload the tables with warm "
      "caches; `bake`: to bake what is needed.\n\n"
      "| variant | ms | RMSE | bias | MiB | start s | bake s | |\n|---|---|---|---|---|---|---|---|\n";
  for (const TradeoffRow& row : table.rows) {
    if (!row.verified) {
      text += fmt::format("| {} | | | | | | | not timed: {} |\n", row.name, row.failure);
      continue;
    }
    text += fmt::format("| {} | {:.2f} | {:.4f} | {:+.3f} | {:.0f} | {:.2f} | {} | {} |\n", row.name, row.ms.median,
                        row.error.rmse, row.error.bias, row.mib, row.start_s,
                        row.bake_s < 0 ? "" : fmt::format("{:.1f}", row.bake_s), row.pareto ? "front" : "");
  }
}

}  // namespace

std::string tradeoff_csv(const TradeoffTable& table) {
  std::string text =
      "name,ms,ms_low,ms_high,wall_ms,frame_ms,rmse,rmse_low,rmse_high,bias,rmse_tree,rmse_grass,rmse_ground,"
      "rmse_occluder,mib,start_s,bake_s,rmse_dvdt,flicker,predicted_ms,predicted_rmse,verified,pareto,ties,settings,"
      "pass_ms,pass_wall_ms\n";
  for (const TradeoffRow& row : table.rows) {
    text += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.6f},{:.6f},{:.6f},{:.6f}", quoted(row.name),
                        row.ms.median, row.ms.low, row.ms.high, row.wall_ms.median, row.frame_ms, row.error.rmse,
                        row.error.low, row.error.high, row.error.bias);
    for (const char* name : judged_class_names) text += "," + class_rmse(row, name);
    text +=
        fmt::format(",{:.2f},{:.4f},{}", row.mib, row.start_s, row.bake_s < 0 ? "" : fmt::format("{:.3f}", row.bake_s));
    text += row.temporal ? fmt::format(",{:.5f},{:.5f}", row.temporal->rmse_dvdt, row.temporal->flicker) : ",,";
    text += fmt::format(",{},{},{},{},{},{}", known(row.predicted_ms, 4), known(row.predicted_rmse, 6),
                        row.verified ? 1 : 0, row.pareto ? 1 : 0, quoted(joined(row.ties, "; ")),
                        quoted(joined(row.settings, " ")));
    text += fmt::format(",{},{}\n", medians_text(row.pass_ms), medians_text(row.pass_wall_ms));
  }
  return text;
}

std::string tradeoff_markdown(const TradeoffTable& table) {
  std::vector<std::string> frames, drawing;
  for (const int frame : table.frames) frames.push_back(std::to_string(frame));
  for (const auto& [shrink, ms] : table.draw_ms)
    drawing.push_back(shrink == 1 ? fmt::format("{:.1f} ms", ms)
                                  : fmt::format("{:.1f} ms at 1/{} of the size", ms, shrink));
  double noise = 0;
  std::string truth_dvdt;
  for (const TradeoffRow& row : table.rows) {
    noise = std::max(noise, row.error.truth_noise);
    if (row.temporal) truth_dvdt = fmt::format(" (the truth's own is {:.2f})", row.temporal->truth_dvdt);
  }
  std::string text = fmt::format(
      "# Time and error: {}\n\nMade by `understory tradeoff`, never by hand; on {}. Judged: {} pixels of frames {} "
      "seen "
      "by {} cameras, the scene's and\nthe one opposite, against traced truth of {} rays a pixel, whose noise of "
      "{:.4f} "
      "is taken out. `ms`: device time of a frame's\nresolve and all passes after it, median and 95 % interval, the "
      "resolve's part of it over all variants that resolve alike; posing\nand drawing take {} more whatever the "
      "methods. "
      "RMSE, bias: of V, with 95 % intervals from the scatter of the pixels. dV/dt: RMSE of\nthe change of V, 1/s{}; "
      "flicker: the largest change between two frames that the truth does not have.\n\n"
      "![time and error](tradeoff.svg)\n",
      table.scene, table.device, table.pixels, joined(frames, ", "), table.cameras, table.rays, noise,
      joined(drawing, ", "), truth_dvdt);
  write_front(table, text);
  write_prediction(table, text);
  write_passes(table, text);
  write_all_rows(table, text);
  return text;
}

}  // namespace understory
