// The results of `understory bench` under the roofs that the same run measured, as a picture.
#pragma once
#include <filesystem>

#include "bench/report.hpp"
#include "viz/vtk/scatter_chart.hpp"

namespace understory {

/// GFLOP/s over operations per byte: kernels at their largest size, the memory and the arithmetic roof.
ScatterChart roofline_chart(const BenchReport& report);

/// Throws Error(usage) for a name that ends neither in .png nor in .svg.
void require_picture_name(const std::filesystem::path& file);

/// As PNG or SVG, by the file's name.
void write_roofline(const BenchReport& report, const std::filesystem::path& file);

}  // namespace understory
