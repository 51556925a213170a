// The contract of records.h: every device sees each record as the host does, and no byte is left to the compiler.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "host/opencl/buffer.hpp"
#include "host/opencl/kernel.hpp"
#include "kernels/shared/record_fields.h"

namespace understory {
namespace {

struct Layout {
  std::string what;
  std::size_t value;
};

/// What the probe kernel reports, as this compiler sees it.
std::vector<Layout> host_layout() {
  std::vector<Layout> layout;
#define HOST_FIELD(record, name)                                           \
  layout.push_back({#record "." #name " offset", offsetof(record, name)}); \
  layout.push_back({#record "." #name " size", sizeof(record::name)});
#define HOST_RECORD(record) layout.push_back({#record " size", sizeof(record)});
  UNDERSTORY_RECORD_FIELDS(HOST_RECORD, HOST_FIELD)
  return layout;
}

TEST(Records, LieOnTheDeviceAsOnTheHost) {
  const std::vector<Layout> expected = host_layout();
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty()) << "no OpenCL device";
  for (const DeviceInfo& info : devices) {
    Device device(std::to_string(info.index));
    Kernel probe(device, "probe_records", "probe_records", "probe_records");
    Buffer<unsigned> out(device, expected.size(), "layout");
    probe.launch(1, 1, out);
    const std::vector<unsigned> reported = out.read();
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(reported[i], expected[i].value) << expected[i].what << " on " << info.name;
    }
  }
}

/// Fields that fill their record without gap or overlap leave nothing unlisted and nothing to padding rules.
TEST(Records, AreFilledByTheirFields) {
  std::size_t end = 0;
#define NEXT_FIELD(record, name)                               \
  EXPECT_EQ(offsetof(record, name), end) << #record "." #name; \
  end += sizeof(record::name);
#define CLOSE_RECORD(record)                 \
  EXPECT_EQ(end, sizeof(record)) << #record; \
  end = 0;
  UNDERSTORY_RECORD_FIELDS(CLOSE_RECORD, NEXT_FIELD)
}

}  // namespace
}  // namespace understory
