// How far every method is from the traced truth, on real plants, random crowns, grass and a stand of trees: the table
// bench/accuracy.md. A new method joins by its name in accuracy_scenes.cpp.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/canopy_truth.hpp"
#include "bench/error_statistics.hpp"

namespace understory {

struct AccuracyOptions {
  std::string device;                                // as --device
  std::filesystem::path data;                        // folder of the meshes (data/MANIFEST.md)
  std::string filter;                                // only rows whose "scene/setting/method" contains it; empty: all
  std::filesystem::path pictures;                    // folder for truth | method | difference; empty: none
  int rays = 1024;                                   // of the truth, per fragment
  std::size_t fragments = 1000;                      // per side and surface, taken at random
  std::function<void(const std::string&)> progress;  // told the name of what comes next; may be empty
};

/// One method on one kind of surface of one scene, all four sides together.
struct AccuracyRow {
  std::string scene;    // black oak, ...
  std::string setting;  // sphere: alone under `sky: sphere`; dome: on ground; gust: on ground in a wind of 8 m/s; ...
  std::string surface;  // plant, ground, blades
  std::string method;   // "crown-field", or "tree + crowns" where both are chosen; "any function of place": the bound
                        // of bench/place_regression.hpp
  ErrorStatistics errors;
};

/// The truth itself: how fast it is, and whether its 95 % intervals hold what 16,384 rays find.
struct TruthRow {
  std::string scene, setting;
  double rays_per_s = 0;         // traced, all cores
  std::size_t fragments = 0;     // judged
  int rays = 0;                  // per fragment
  double inside = 0;             // share of the intervals that hold
  double tenth_inside[10] = {};  // by tenth of V
  std::size_t tenth_fragments[10] = {};
};

struct AccuracyReport {
  std::string device;
  int rays = 0;               // per fragment
  std::size_t fragments = 0;  // at most, per side and surface
  std::vector<AccuracyRow> rows;
  std::vector<TruthRow> truth;
  std::vector<CanopyTruth> canopies;
  std::vector<std::string> unknown;  // methods that this build does not know
};

/// Throws Error(invalid_input) when the data folder lacks a mesh.
AccuracyReport measure_accuracy(const AccuracyOptions& options);

/// The report as Markdown: per setting and surface a table of RMSE without the truth's noise, bias and log error.
std::string accuracy_markdown(const AccuracyReport& report);

}  // namespace understory
