// Keys as in DESIGN.md, "What machines read".
#include "host/app/device_json.hpp"

#include <nlohmann/json.hpp>

namespace understory {

nlohmann::ordered_json device_json(const DeviceInfo& device) {
  return {{"index", device.index},
          {"platform", device.platform},
          {"name", device.name},
          {"type", device.type},
          {"version", device.version},
          {"driver", device.driver},
          {"compute_units", device.compute_units},
          {"memory_mib", device.memory_mib},
          {"max_allocation_mib", device.max_allocation_mib},
          {"max_group", device.max_group},
          {"vector_width", device.vector_width},
          {"atomic64", device.atomic64}};
}

}  // namespace understory
