#include "host/passes/lanes.hpp"

#include "sim/error.hpp"

namespace understory {
namespace {

bool is_width(int count) { return count == 1 || count == 4 || count == 8 || count == 16; }

}  // namespace

Lanes::Lanes(int count) : count_(count) {
  if (!is_width(count))
    throw Error(ErrorKind::unexpected,
                "fragments per work-item: " + std::to_string(count) + " is not one of 1, 4, 8, 16");
}

Lanes Lanes::of_device(const Device& device) {
  const int width = device.info().vector_width;
  return Lanes(is_width(width) ? width : 1);
}

}  // namespace understory
