// What decides the bytes of a run's files, gathered before anything is computed.
#pragma once
#include <string>
#include <vector>

#include "host/app/run_record.hpp"
#include "sim/scene.hpp"

namespace understory {

/// Records program, scene, input files, size and settings; device, plan and frames come later.
/// Throws Error(input_output) when a file that the scene names cannot be read.
RunRecord describe_run(const Scene& scene, const std::vector<std::string>& dumps, int supersample);

/// "exr,png" in the order exr, png, vtk, ply. Throws Error(usage) for other names and for none.
std::vector<std::string> parse_dumps(const std::string& text);

}  // namespace understory
