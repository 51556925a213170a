#include "host/passes/lanes.hpp"

#include "sim/error.hpp"

namespace understory {
namespace {

bool is_width(int count) { return count == 1 || count == 4 || count == 8 || count == 16; }

}  // namespace

Lanes::Lanes(const Device& device, int count, const std::string& pass) : count_(count) {
  if (const auto tuned = device.tuning().find(pass); count == 0 && tuned != device.tuning().end()) {
    count = count_ = tuned->second.lanes;
    group_ = tuned->second.group;
  }
  if (count == 0) count_ = is_width(device.info().vector_width) ? device.info().vector_width : 1;
  if (!is_width(count_))
    throw Error(ErrorKind::unexpected,
                "fragments per work-item: " + std::to_string(count) + " is not one of 0, 1, 4, 8, 16");
}

}  // namespace understory
