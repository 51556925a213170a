// `understory compare`: how far the visibility of one frame file is from that of another, usually its truth.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/compare_frames.hpp"
#include "host/app/bench_json.hpp"
#include "host/app/commands.hpp"
#include "sim/error.hpp"
#include "viz/exr/frame_exr.hpp"
#include "viz/exr/image.hpp"
#include "viz/vtk/false_colour.hpp"
#include "viz/vtk/png.hpp"

namespace understory {
namespace {

struct CompareOptions {
  std::string value, reference, channel = "Y", difference;
  std::optional<double> max_rmse;
  bool json = false;
};

/// Puts the chosen channel in frame.visibility: "Y", "sphere-cap" or "sphere-cap.Y". False: the file has none.
bool choose_channel(std::string channel, Frame& frame) {
  if (channel == "Y") return true;
  if (channel.ends_with(".Y")) channel.resize(channel.size() - 2);
  const auto found = frame.terms.find(channel);
  if (found == frame.terms.end()) return false;
  frame.visibility = found->second;
  return true;
}

std::string channels_of(const Frame& frame) {
  std::string names = "Y";
  for (const auto& [name, plane] : frame.terms) names += " " + name;
  return names;
}

void print_line(const std::string& name, const ErrorStatistics& errors) {
  fmt::print("{:<10}{:>9}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.3f}{:>9.4f}", name, errors.pixels,
             errors.rmse, errors.rmse_denoised, errors.mae, errors.bias, errors.max, errors.p95, errors.log_mae,
             errors.best_constant);
  if (errors.inside >= 0) fmt::print("{:>9.3f}{:>9.4f}", errors.inside, errors.truth_noise);
  fmt::print("\n");
}

void print(const FrameComparison& comparison) {
  fmt::print("{:<10}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}", "", "pixels", "RMSE", "denoised", "MAE", "bias",
             "max", "p95", "log MAE", "constant");
  fmt::print("{}\n", comparison.all.inside >= 0 ? "   inside    noise" : "");
  print_line("all", comparison.all);
  for (const auto& [name, errors] : comparison.classes) print_line(name, errors);
  fmt::print("SSIM {:.4f}", comparison.ssim);
  if (comparison.mismatched > 0) fmt::print("; {} pixels that show different things left out", comparison.mismatched);
  fmt::print("\n");
}

void write_difference(const std::filesystem::path& path, const Frame& frame, const FrameComparison& comparison) {
  if (path.extension() == ".exr") {
    ExrImage image{frame.width, frame.height, {}, {}, {}};
    image.floats["difference"] = comparison.difference;
    image.integers["validity"] = comparison.validity;
    write_exr(path, image);
    return;
  }
  const float range = static_cast<float>(std::max(0.05, std::ceil(20 * comparison.all.p95) / 20));
  write_png(path, false_colour(frame.width, frame.height, comparison.difference, comparison.validity,
                               {ColourMap::difference, -range, range, "difference"}));
}

int compare(const CompareOptions& options) {
  if (!options.difference.empty() && !options.difference.ends_with(".exr") && !options.difference.ends_with(".png"))
    throw Error(ErrorKind::usage,
                fmt::format("--difference {}: allowed are names that end in .exr or .png", options.difference));
  Frame value = read_frame_exr(options.value), reference = read_frame_exr(options.reference);
  if (!choose_channel(options.channel, value))
    throw Error(ErrorKind::usage, fmt::format("--channel {}: not in {}; allowed: {}", options.channel, options.value,
                                              channels_of(value)));
  choose_channel(options.channel, reference);  // else its Y
  FrameComparison comparison;
  try {
    comparison = compare_frames(value, reference);
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{} and {}: {}", options.value, options.reference, error.what()));
  }
  if (!options.difference.empty()) write_difference(options.difference, value, comparison);
  const bool over = options.max_rmse && !(comparison.all.rmse <= *options.max_rmse);
  if (options.json) {
    nlohmann::ordered_json json = errors_json(comparison.all);
    json["ssim"] = comparison.ssim;
    json["log_floor"] = log_floor;
    json["mismatched"] = comparison.mismatched;
    json["classes"] = nlohmann::ordered_json::object();
    for (const auto& [name, errors] : comparison.classes) json["classes"][name] = errors_json(errors);
    fmt::print("{}\n", json.dump(2));
  } else {
    print(comparison);
  }
  if (over) spdlog::error("RMSE {:.6g} is over --max-rmse {:.6g}", comparison.all.rmse, *options.max_rmse);
  return over ? comparison_over_threshold : 0;
}

}  // namespace

void add_compare(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("compare", "How far one frame file is from another, usually its truth");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->value, "Frame file whose error is asked for")->required();
  command->add_option("B", options->reference, "Frame file to hold it against; errors are A - B")->required();
  command->add_option("--channel", options->channel, "Channel of A, and of B where it has it, else B's Y")
      ->capture_default_str();
  command->add_option("--max-rmse", options->max_rmse, "Exit code 7 when the RMSE is larger")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--difference", options->difference, "Write A - B to this .exr or .png");
  command->add_flag("--json", options->json, "Print a JSON object");
  command->footer(
      "Background counts nowhere. `denoised` is the RMSE with the truth's own variance taken out; `log MAE` the mean\n"
      "|ln A - ln B| of values of at least 0.001; `constant` what the best constant would reach; `inside` the share "
      "of\n"
      "pixels within the truth's 95 % interval; `noise` the truth's standard error. SSIM: Gaussian window of 11 x 11\n"
      "pixels, deviation 1.5.\n"
      "  understory compare out/frame_0012.exr truth.exr --difference difference.png --max-rmse 0.1");
  command->callback([options, &chosen] { chosen = [options] { return compare(*options); }; });
}

}  // namespace understory
