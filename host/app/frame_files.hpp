// The files of a run: those of each frame, and what is made of all frames at the end.
//
// frame_0007.exr        planes without loss       frame_0007.png, visibility_0007.png   pictures
// frame_0007.vti, .vtp  planes and posed triangles for ParaView, with planes.pvd and geometry.pvd as time series
// frame_0007.ply        posed triangles           contact_sheet.png, movie.ogv          of all frames in the folder
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "host/app/run_record.hpp"
#include "host/frame/runner.hpp"
#include "sim/frame.hpp"
#include "viz/exr/frame_exr.hpp"
#include "viz/vtk/frame_pictures.hpp"

namespace understory {

/// A computed frame with everything that its files need.
struct FrameOutput {
  Frame frame;
  PosedGeometry geometry;  // empty unless asked for
  FramePictures samples;   // with more than one sample per pixel; else made from `frame`
  std::string chosen;      // in an adaptive run the name of `methods`, which shaded it; else empty
  Methods methods;
};

class FrameFiles {
 public:
  FrameFiles(const std::filesystem::path& folder, const RunRecord& record, const Methods& methods);

  /// Renders once in the middle of the pixels and, for pictures with supersample N, on the N x N grid within them.
  void compute(FrameRunner& runner, int index, double time, FrameOutput& output) const;

  /// Writes each file under a temporary name first. `ms` is left to the caller. Throws Error(input_output).
  FrameRecord write(const FrameOutput& output) const;

 private:
  bool dumps(const char* format) const;
  std::filesystem::path folder_;
  std::vector<std::string> dumps_;
  int supersample_;
  ExrAttributes attributes_;
};

/// Time series, contact sheet and movie, from the files that the record lists: the same whoever computed them.
void write_products(const std::filesystem::path& folder, const RunRecord& record, const Scene& scene);

}  // namespace understory
