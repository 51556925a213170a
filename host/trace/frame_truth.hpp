// The truth of a whole frame: its fragments against the posed triangles of that very frame.
#pragma once
#include <functional>

#include "host/trace/truth.hpp"
#include "sim/frame.hpp"

namespace understory {

/// The triangles of a frame, relative to the scene's origin as the frame's positions are.
Tracer tracer_of(const PosedGeometry& geometry);

/// Replaces frame.visibility by the truth and fills halfwidth and rays; terms are dropped. Background keeps V = 1,
/// half-width 0 and no rays. options.eye and first_point are set here. `progress` is told the share that is done.
void trace_frame(const Tracer& tracer, TruthOptions options, Frame& frame,
                 const std::function<void(double share)>& progress = {});

}  // namespace understory
