// `understory devices`: what --device can choose from.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/commands.hpp"
#include "host/app/device_json.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

int list(bool json) {
  const std::vector<DeviceInfo> devices = list_devices();
  if (json) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const DeviceInfo& device : devices) rows.push_back(device_json(device));
    fmt::print("{}\n", rows.dump(2));
  }
  if (devices.empty())
    throw Error(ErrorKind::no_device,
                "no OpenCL device found; PoCL runs on any processor: apt-get install pocl-opencl-icd "
                "(OCL_ICD_VENDORS, if set, must lead to its .icd file)");
  if (json) return 0;
  for (const DeviceInfo& device : devices)
    fmt::print(
        "{}  {} ({}, {}, {})\n   {} compute units, {} MiB, largest buffer {} MiB, largest group {}, {} float lanes\n",
        device.index, device.name, device.type, device.platform, device.version, device.compute_units,
        device.memory_mib, device.max_allocation_mib, device.max_group, device.vector_width);
  return 0;
}

}  // namespace

void add_devices(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("devices", "List the OpenCL devices that --device can choose");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print a JSON array");
  command->footer(
      "The index, cpu, gpu, or a part of a name goes after --device or into the variable UNDERSTORY_DEVICE.\n"
      "Without either the first CPU is taken, else the first device. Exit code 4: there is none.");
  command->callback([json, &chosen] { chosen = [json] { return list(*json); }; });
}

}  // namespace understory
