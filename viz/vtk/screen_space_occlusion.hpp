// VTK's own screen-space ambient occlusion (vtkSSAOPass) of a frame's triangles: what obscurance is compared with.
#pragma once
#include "sim/frame.hpp"

namespace understory {

struct ScreenSpaceOcclusion {
  Plane open;          // what VTK leaves of white, [0, 1], row-major, top row first
  double pass_ms = 0;  // with the pass minus without: least processor time of all threads over the repetitions, halved
  double with_ms = 0, without_ms = 0;
};

/// `frame`: its camera and size. `radius`: m; `samples`: of the hemisphere. Draws the scene 2 * repetitions times, by
/// turns. Throws Error(no_device) without EGL.
ScreenSpaceOcclusion vtk_screen_space_occlusion(const PosedGeometry& geometry, const Frame& frame, double radius,
                                                int samples, bool blur, int repetitions);

}  // namespace understory
