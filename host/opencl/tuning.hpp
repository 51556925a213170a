// How passes are launched on one device, where somebody has measured it: `understory bench --tune` writes the table,
// every Device of that name reads it. Results do not depend on it, only their time.
#pragma once
#include <filesystem>
#include <map>
#include <string>

namespace understory {

struct DeviceInfo;

struct LaunchShape {
  int lanes = 0;  // fragments per work-item: 1, 4, 8 or 16; 0: as the pass would have it
  int group = 0;  // fragments per work-group, 16 to 65536; 0: likewise
  bool operator==(const LaunchShape&) const = default;
};

/// By pass name.
using TuningTable = std::map<std::string, LaunchShape>;

/// $UNDERSTORY_TUNING where it is set ("none": no file), else (XDG_CONFIG_HOME or
/// ~/.config)/understory/tuning/DEVICE.txt. Empty: there is no place for one.
std::filesystem::path tuning_file(const DeviceInfo& device);

/// Lines `PASS LANES GROUP` and whatever follows them; # starts a comment. A file that is not there: no rows. Throws
/// Error(invalid_input) with file and line for anything else.
TuningTable read_tuning(const std::filesystem::path& file);

}  // namespace understory
