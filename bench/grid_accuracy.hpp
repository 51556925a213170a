// How far the methods by which moving bodies shade others are from traced truth: the table bench/grids.md. A new method
// or rule of combining joins by its name in grid_accuracy.cpp.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "host/opencl/device.hpp"

namespace understory {

struct GridAccuracyOptions {
  std::string device;                                // as --device
  std::vector<std::filesystem::path> scenes;         // their occluders and terrain alone are judged
  int frames = 4;                                    // of each scene, evenly spaced
  int rays = 2048;                                   // of the truth, per fragment
  std::size_t fragments = 2000;                      // per frame and kind of receiver
  std::function<void(const std::string&)> progress;  // told the name of what comes next; may be empty
};

/// Errors of V_c of the occluders alone, `sky: sphere`, over fragments within some occluder's grid.
struct GridAccuracyRow {
  std::string scene;
  /// ground: at least one cell of the grid from every body; near: of it, where a grid of epsilon 0.02 would reach;
  /// contact: ground within a cell; bodies; all: ground, contact and bodies.
  std::string receivers;
  std::string method;  // as in scenes; with the rule: grid-cone merge
  std::size_t fragments = 0;
  double mean_truth = 0, truth_noise = 0;  // mean V; root mean square standard error of the truth
  double rmse = 0, bias = 0, p99 = 0;      // of V; p99: 99 % of |error| are not above it
};

struct GridAccuracyReport {
  DeviceInfo device;
  int rays = 0, frames = 0;
  std::vector<GridAccuracyRow> rows;
};

/// Throws Error(invalid_input) for a scene without occluders.
GridAccuracyReport measure_grid_accuracy(const GridAccuracyOptions& options);

/// The report as Markdown, one table per kind of receiver: scenes across, methods down.
std::string grid_accuracy_markdown(const GridAccuracyReport& report);

}  // namespace understory
