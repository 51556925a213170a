// Devices, buffers and kernels: results, limits, and what the errors say.
#include "host/opencl/buffer.hpp"
#include "host/opencl/device.hpp"
#include "host/opencl/kernel.hpp"
#include "kernels/embedded.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <numeric>
#include <stdexcept>

#include "tests/support/errors.hpp"

namespace understory {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::size_t odd_count = 1003;  // no multiple of any group size

std::vector<float> ramp(std::size_t count) {
  std::vector<float> values(count);
  std::iota(values.begin(), values.end(), 1.0f);
  return values;
}

TEST(Devices, AreListedInOrderWithTheirLimits) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty()) << "the tests need an OpenCL device; PoCL is enough";
  for (std::size_t i = 0; i < devices.size(); ++i) {
    EXPECT_EQ(devices[i].index, static_cast<int>(i));
    EXPECT_FALSE(devices[i].name.empty());
    EXPECT_GT(devices[i].compute_units, 0);
    EXPECT_GE(devices[i].memory_mib, devices[i].max_allocation_mib);
    EXPECT_EQ(16 % devices[i].vector_width, 0);
    EXPECT_TRUE(devices[i].vector_width == 1 || devices[i].type == "cpu");
  }
}

TEST(Devices, AreChosenByIndexTypeOrPartOfName) {
  const DeviceInfo first = list_devices().at(0);
  EXPECT_EQ(Device("0").info().name, first.name);
  EXPECT_EQ(Device(first.type).info().type, first.type);
  EXPECT_EQ(Device(first.name.substr(1, 6)).info().name, first.name);
}

TEST(Devices, VariableChoosesUnlessTheCallDoes) {
  setenv("UNDERSTORY_DEVICE", "no such device", 1);
  const std::string text = message_of(ErrorKind::no_device, [] { Device device; });
  EXPECT_NO_THROW(Device("0"));
  unsetenv("UNDERSTORY_DEVICE");
  EXPECT_THAT(text, HasSubstr("no such device"));
}

TEST(Devices, AnUnknownOneIsAnsweredWithTheList) {
  const std::string text = message_of(ErrorKind::no_device, [] { Device device("99"); });
  EXPECT_THAT(text, AllOf(HasSubstr("'99'"), HasSubstr(list_devices().at(0).name)));
}

TEST(DevicesDeathTest, DivisionByZeroOnTheHostStillTraps) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto divide = [] {
    list_devices();
    volatile int zero = 0;
    std::exit(5 / zero);
  };
  EXPECT_EXIT(divide(), testing::KilledBySignal(SIGFPE), "");
}

TEST(Buffers, ReturnWhatWasWritten) {
  Device device;
  const std::vector<float> values = ramp(odd_count);
  const Buffer<float> buffer(device, std::span<const float>(values), "test values");
  EXPECT_EQ(buffer.read(), values);
}

TEST(Buffers, MappedShowWhatLaunchesBeforeWrote) {
  Device device;
  Kernel copy(device, "roofline", "copy_plane", "copy", "-DW=1");
  std::vector<float> values = ramp(odd_count);
  Buffer<float> in(device, values.size(), "in"), out(device, values.size(), "out");
  for (int turn = 0; turn < 3; ++turn) {
    for (float& value : values) value += 1;
    in.write(std::span<const float>(values), false);
    copy.launch(values.size(), 64, in, out, static_cast<std::uint32_t>(values.size()));
    RawMapping mapping;
    mapping = RawMapping(out.raw());
    const float* seen = static_cast<const float*>(mapping.data());
    EXPECT_TRUE(std::equal(values.begin(), values.end(), seen)) << turn;
  }
  EXPECT_EQ(RawMapping(Buffer<float>(device, 0, "nothing").raw()).data(), nullptr);
}

TEST(Buffers, AreCounted) {
  Device device;
  {
    Buffer<float> first(device, 100, "first");
    Buffer<float> second = std::move(first);
    EXPECT_EQ(device.buffer_bytes(), 400u);
    second = Buffer<float>(device, 10, "third");
  }
  EXPECT_EQ(device.buffer_bytes(), 0u);
  EXPECT_EQ(device.peak_buffer_bytes(), 440u);
}

TEST(Buffers, TooLargeOnesNameUseAndLimits) {
  Device device;
  const std::size_t count = (device.info().max_allocation_mib + 2) << 20;
  const std::string text = message_of(ErrorKind::invalid_input, [&] { Buffer<char>(device, count, "rest vertices"); });
  EXPECT_THAT(text, AllOf(HasSubstr("rest vertices"), HasSubstr(std::to_string(count >> 20) + " MiB"),
                          HasSubstr(std::to_string(device.info().max_allocation_mib) + " MiB")));
}

TEST(Buffers, RefuseRangesPastTheirEnd) {
  Device device;
  Buffer<float> buffer(device, 3, "three");
  EXPECT_THROW(buffer.write(std::vector<float>(4)), Error);
  EXPECT_NO_THROW(Buffer<float>(device, 0, "nothing").write(std::span<const float>()));
}

class CopyKernel : public testing::TestWithParam<std::size_t> {};

TEST_P(CopyKernel, CopiesEveryElementAndNothingBeyond) {
  Device device;
  Kernel copy(device, "roofline", "copy_plane", "copy", "-DW=1");
  const std::vector<float> values = ramp(2 * odd_count);
  Buffer<float> in(device, std::span<const float>(values), "in"), out(device, values.size(), "out");
  out.write(std::vector<float>(values.size(), -1));
  copy.launch(odd_count, GetParam(), in, out, static_cast<unsigned>(odd_count));
  std::vector<float> expected(values.size(), -1);
  std::copy_n(values.begin(), odd_count, expected.begin());
  EXPECT_EQ(out.read(), expected);
}
INSTANTIATE_TEST_SUITE_P(LocalSizes, CopyKernel, testing::Values(0, 1, 7, 64, 1024, 1 << 20));

TEST(Kernels, SumTheirTimesPerPass) {
  Device device;
  Kernel copy(device, "roofline", "copy_plane", "copy", "-DW=1"),
      also(device, "roofline", "copy_plane", "other", "-DW=1");
  Buffer<float> in(device, std::span<const float>(ramp(odd_count)), "in"), out(device, odd_count, "out");
  EXPECT_TRUE(device.take_pass_times().empty());
  for (int i = 0; i < 5000; ++i) copy.launch(odd_count, 64, in, out, static_cast<unsigned>(odd_count));
  also.launch(odd_count, 64, in, out, static_cast<unsigned>(odd_count));
  const std::map<std::string, double> times = device.take_pass_times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_GT(times.at("copy"), times.at("other"));
  EXPECT_TRUE(device.take_pass_times().empty());
  EXPECT_EQ(device.programs_built(), std::vector<std::string>{"roofline"});
}

TEST(Kernels, SumTheirTimesOnTheHostPerPass) {
  Device device;
  Kernel copy(device, "roofline", "copy_plane", "copy", "-DW=1"),
      also(device, "roofline", "copy_plane", "other", "-DW=1");
  Buffer<float> in(device, std::span<const float>(ramp(odd_count)), "in"), out(device, odd_count, "out");
  const auto launch = [&](Kernel& kernel) { kernel.launch(odd_count, 64, in, out, static_cast<unsigned>(odd_count)); };
  const auto begin = std::chrono::steady_clock::now();
  const std::map<std::string, double> times = device.host_pass_times([&] {
    for (int i = 0; i < 20; ++i) launch(copy);
    launch(also);
  });
  const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  const std::map<std::string, double> on_device = device.take_pass_times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_LE(times.at("copy") + times.at("other"), wall);
  for (const auto& [pass, milliseconds] : times)
    EXPECT_GE(milliseconds, on_device.at(pass)) << "it waits for the launch";
  launch(copy);
  EXPECT_TRUE(device.host_pass_times([] {}).empty()) << "nothing is counted outside";
  EXPECT_THROW(device.host_pass_times([] { throw std::runtime_error("no"); }), std::runtime_error);
  launch(copy);
  EXPECT_TRUE(device.host_pass_times([] {}).empty());
}

TEST(Kernels, CheckTheirArguments) {
  Device device;
  Kernel copy(device, "roofline", "copy_plane", "copy", "-DW=1");
  Buffer<float> plane(device, 4, "plane");
  const auto text_of = [&](auto... arguments) {
    return message_of(ErrorKind::unexpected, [&] { copy.launch(4, 64, arguments...); });
  };
  EXPECT_THAT(message_of(ErrorKind::unexpected, [&] { copy.launch(4, 64, plane, plane); }),
              HasSubstr("takes 3 arguments, 2"));
  EXPECT_THAT(message_of(ErrorKind::unexpected, [&] { copy.launch(4, 64, plane, plane, 4u, 4u); }),
              HasSubstr("takes 3 arguments"));
  EXPECT_THAT(message_of(ErrorKind::unexpected, [&] { copy.launch(4, 64, plane, plane, 4.0); }),
              AllOf(HasSubstr("copy_plane"), HasSubstr("uint items"), HasSubstr("8 bytes")));
  EXPECT_THAT(message_of(ErrorKind::unexpected, [&] { copy.launch(4, 64, plane, plane, plane); }),
              HasSubstr("wants a value"));
  EXPECT_THAT(text_of(1.0f), HasSubstr("wants a buffer"));
}

TEST(Kernels, ThatDoNotBuildShowFileDeviceOptionsAndLog) {
  Device device;
  const std::string text = message_of(ErrorKind::unexpected, [&] {
    Kernel(device, "roofline", "copy_plane", "copy", "-DFP_CONTRACT -Dglobal=nonsense");
  });
  EXPECT_THAT(text, AllOf(HasSubstr("kernels/roofline.cl:"), HasSubstr(device.info().name),
                          HasSubstr("-Dglobal=nonsense"), HasSubstr("nonsense")));
}

TEST(Kernels, ThatDoNotExistAreNamed) {
  Device device;
  EXPECT_THAT(message_of(ErrorKind::unexpected, [&] { Kernel(device, "roofline", "no_kernel", "x"); }),
              HasSubstr("no_kernel"));
  EXPECT_THAT(message_of(ErrorKind::unexpected, [&] { Kernel(device, "no_file", "x", "x"); }),
              AllOf(HasSubstr("no_file.cl"), HasSubstr("roofline.cl")));
}

TEST(Kernels, OptionsOfTheCallOverrideTheVectorWidth) {
  Device device;
  EXPECT_NO_THROW(Kernel(device, "roofline", "copy_plane", "copy", "-DW=1"));
}

TEST(EmbeddedSources, PasteEachIncludeOnceUnderItsOwnName) {
  for (const std::string& program : embedded_programs()) {
    const std::string text = expanded_source(program);
    EXPECT_THAT(text, HasSubstr("#line 1 \"kernels/" + program + ".cl\""));
    EXPECT_EQ(text.find("#include \""), std::string::npos) << program;
    const std::string records = "#line 1 \"kernels/shared/records.h\"";
    EXPECT_EQ(text.find(records), text.rfind(records)) << program;
  }
}

}  // namespace
}  // namespace understory
