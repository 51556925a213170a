// The table that embed.cmake writes: one entry per kernel source, in order of its path.
#pragma once
#include <cstddef>
#include <string_view>

namespace understory {

struct EmbeddedFile {
  std::string_view name;  // path below kernels/: "sphere_cap.cl", "shared/real.h"
  std::string_view text;
};

extern const EmbeddedFile embedded_files[];
extern const std::size_t embedded_file_count;

}  // namespace understory
