// The accuracy report as Markdown: one matrix per setting and surface, scenes down, methods across.
#include <fmt/format.h>

#include <algorithm>

#include "bench/accuracy.hpp"

namespace understory {
namespace {

struct Block {
  std::string setting, surface;
  std::vector<std::string> scenes, methods;  // in the order of the rows
};

void add_once(std::vector<std::string>& list, const std::string& item) {
  if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
}

std::vector<Block> blocks_of(const AccuracyReport& report) {
  std::vector<Block> blocks;
  for (const AccuracyRow& row : report.rows) {
    auto at = std::find_if(blocks.begin(), blocks.end(), [&](const Block& block) {
      return block.setting == row.setting && block.surface == row.surface;
    });
    if (at == blocks.end()) at = blocks.insert(at, {row.setting, row.surface, {}, {}});
    add_once(at->scenes, row.scene);
    add_once(at->methods, row.method);
  }
  return blocks;
}

const AccuracyRow* find_row(const AccuracyReport& report, const Block& block, const std::string& scene,
                            const std::string& method) {
  for (const AccuracyRow& row : report.rows)
    if (row.setting == block.setting && row.surface == block.surface && row.scene == scene && row.method == method)
      return &row;
  return nullptr;
}

/// What a reader must know of a block, below its title.
std::string note_of(const Block& block) {
  if (block.setting == "random")
    return "\nAny function of place: the least RMSE that a method can have which knows the distance from the middle "
           "and "
           "the\nangle between normal and radius, and nothing of the leaves around (`bench/place_regression.hpp`).\n";
  return {};
}

std::string title_of(const Block& block) {
  if (block.setting == "sphere") return "Alone, `sky: sphere`, at rest";
  if (block.setting == "dome") return "On ground, `sky: dome`, at rest: " + block.surface;
  if (block.setting == "gust") return "On ground, `sky: dome`, in a wind of 8 m/s: " + block.surface;
  if (block.setting == "random") return "Random crowns of 200,000 leaves, `sky: sphere`";
  if (block.setting == "grass") return "Generated grass, `sky: dome`: " + block.surface;
  if (block.setting == "stand") return "Five trees on ground, all terms combined, `sky: dome`: " + block.surface;
  return block.setting + ": " + block.surface;
}

void write_errors(const AccuracyReport& report, const Block& block, std::string& text) {
  text += fmt::format("\n## {}\n{}\n| | fragments | mean V | truth noise | best constant |", title_of(block),
                      note_of(block));
  for (const std::string& method : block.methods) text += fmt::format(" {} |", method);
  text += "\n|---|---|---|---|---|";
  for (std::size_t i = 0; i < block.methods.size(); ++i) text += "---|";
  text += "\n";
  for (const std::string& scene : block.scenes) {
    bool head = false;
    std::string cells;
    for (const std::string& method : block.methods) {
      const AccuracyRow* row = find_row(report, block, scene, method);
      if (row && !head) {
        text += fmt::format("| {} | {} | {:.3f} | {:.3f} | {:.3f} |", scene, row->errors.pixels,
                            row->errors.reference_mean, row->errors.truth_noise, row->errors.best_constant);
        head = true;
      }
      cells += row ? fmt::format(" {:.3f} ({:+.3f}, {:.2f}) |", row->errors.rmse_denoised, row->errors.bias,
                                 row->errors.log_mae)
                   : " |";
    }
    text += cells + "\n";
  }
}

/// The same turned round, where there is one scene and many methods.
void write_list(const AccuracyReport& report, const Block& block, std::string& text) {
  const ErrorStatistics& any = find_row(report, block, block.scenes[0], block.methods[0])->errors;
  text += fmt::format("\n## {}\n\n{} fragments, mean V {:.3f}, truth noise {:.3f}, best constant {:.3f}.\n\n",
                      title_of(block), any.pixels, any.reference_mean, any.truth_noise, any.best_constant);
  text += "| | RMSE | bias | log error |\n|---|---|---|---|\n";
  for (const std::string& method : block.methods) {
    const ErrorStatistics& errors = find_row(report, block, block.scenes[0], method)->errors;
    text +=
        fmt::format("| {} | {:.3f} | {:+.3f} | {:.2f} |\n", method, errors.rmse_denoised, errors.bias, errors.log_mae);
  }
}

void write_truth(const AccuracyReport& report, std::string& text) {
  if (!report.truth.empty()) {
    text +=
        "\n## The truth itself\n\nShare of its 95 % intervals that hold what 16,384 other rays find, over all and by "
        "tenth of V.\n\n| | rays | million rays/s | fragments | all |";
    for (int tenth = 0; tenth < 10; ++tenth) text += fmt::format(" {:.1f} |", 0.1 * tenth);
    text += "\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  }
  for (const TruthRow& row : report.truth) {
    text += fmt::format("| {}, {} | {} | {:.1f} | {} | {:.3f} |", row.scene, row.setting, row.rays,
                        row.rays_per_s * 1e-6, row.fragments, row.inside);
    for (int tenth = 0; tenth < 10; ++tenth)
      text += row.tenth_fragments[tenth] > 0
                  ? fmt::format(" {:.3f} of {} |", row.tenth_inside[tenth], row.tenth_fragments[tenth])
                  : " |";
    text += "\n";
  }
  if (report.canopies.empty()) return;
  text +=
      "\n## Ground under an endless random canopy\n\nV_c traced in 8 realisations, against 2 E3(LAI/2).\n\n"
      "| LAI | traced | standard error | closed form | error |\n|---|---|---|---|---|\n";
  for (const CanopyTruth& canopy : report.canopies)
    text += fmt::format("| {} | {:.5f} | {:.5f} | {:.5f} | {:+.1f} % |\n", canopy.leaf_area_index, canopy.traced,
                        canopy.standard_error, canopy.closed_form, 100 * (canopy.traced / canopy.closed_form - 1));
}

}  // namespace

std::string accuracy_markdown(const AccuracyReport& report) {
  std::string text = fmt::format(
      "# Accuracy\n\nMade by `understory bench --accuracy bench/accuracy.md --rays {} --per-side {}`, never by hand; "
      "on "
      "{}.\nV_c, fragments seen from four sides, truth of {} rays a fragment. Each entry is RMSE (bias, mean |ln V - "
      "ln "
      "truth| of\nvalues of at least 0.001), the truth's own variance taken out of the RMSE. Truth noise: the root of "
      "that variance. Best\nconstant: the RMSE of the mean truth, noise taken out too.\n",
      report.rays, report.fragments, report.device, report.rays);
  for (const Block& block : blocks_of(report))
    (block.scenes.size() == 1 && block.methods.size() > 8 ? write_list : write_errors)(report, block, text);
  write_truth(report, text);
  if (!report.unknown.empty()) {
    text += "\nNot known to this build:";
    for (const std::string& name : report.unknown) text += " `" + name + "`";
    text += ".\n";
  }
  return text;
}

}  // namespace understory
