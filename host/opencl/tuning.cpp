#include "host/opencl/tuning.hpp"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "host/opencl/device.hpp"
#include "sim/error.hpp"

namespace understory {
namespace fs = std::filesystem;
namespace {

fs::path user_settings() {
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder && *folder == '/') return folder;
  if (const char* home = std::getenv("HOME"); home && *home == '/') return fs::path(home) / ".config";
  return {};
}

/// "Portable_Computing_Language-pthread-AMD_EPYC.txt"
std::string file_name(const DeviceInfo& device) {
  std::string name = device.platform + "-" + device.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
  return name + ".txt";
}

bool is_allowed(const LaunchShape& shape) {
  const bool lanes = shape.lanes == 0 || shape.lanes == 1 || shape.lanes == 4 || shape.lanes == 8 || shape.lanes == 16;
  return lanes && (shape.group == 0 || (shape.group >= 16 && shape.group <= 65536));
}

}  // namespace

fs::path tuning_file(const DeviceInfo& device) {
  if (const char* file = std::getenv("UNDERSTORY_TUNING"); file && *file) {
    return file == std::string("none") ? fs::path() : fs::path(file);
  }
  const fs::path settings = user_settings();
  return settings.empty() ? fs::path() : settings / "understory" / "tuning" / file_name(device);
}

TuningTable read_tuning(const fs::path& file) {
  TuningTable table;
  std::ifstream stream(file);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string pass;
    if (!(words >> pass)) continue;
    LaunchShape shape;
    if (!(words >> shape.lanes >> shape.group) || !is_allowed(shape) || table.contains(pass))
      throw Error(
          ErrorKind::invalid_input,
          file.string() + ":" + std::to_string(number) + ": '" + line +
              "'; allowed: a pass that no line above names, 0, 1, 4, 8 or 16 fragments per work-item, 0 or 16 to "
              "65536 fragments per group (or remove the file)");
    table[pass] = shape;
  }
  return table;
}

}  // namespace understory
