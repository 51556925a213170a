// A device as the JSON object that `devices --json` and run.json show.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "host/opencl/device.hpp"

namespace understory {

nlohmann::ordered_json device_json(const DeviceInfo& device);

}  // namespace understory
