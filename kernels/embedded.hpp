// The kernel sources that were embedded at build time, so that a program needs no files beside it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace understory {

/// Stems of all embedded `.cl` files, sorted: "pose_mesh", "sphere_cap", ...
std::vector<std::string> embedded_programs();

/// Text of one file by its path below kernels/ ("sphere_cap.cl", "shared/real.h"); a leading "kernels/" is allowed.
/// Throws Error(unexpected) with the names there are.
std::string_view embedded_source(std::string_view name);

/// `kernels/<program>.cl` with every `#include "..."` replaced by the embedded file, each file once. `#line` directives
/// keep the compiler's messages at the real file and line. Throws Error(unexpected) for a file that is not embedded.
std::string expanded_source(std::string_view program);

}  // namespace understory
