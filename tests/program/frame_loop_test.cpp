// The overlap of computing and writing: order, failures, signals and full disks.
#include "host/app/frame_loop.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <numeric>

#include "sim/error.hpp"

namespace understory {
namespace {

std::vector<int> first(int count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

int no_signal() { return 0; }

TEST(FrameLoop, WritesEveryFrameInOrder) {
  std::vector<int> written;
  const auto result = run_frame_loop(
      first(57), [&](int index) { return [&written, index] { written.push_back(index); }; }, no_signal);
  EXPECT_EQ(written, first(57));
  EXPECT_TRUE(result.failed.empty());
  EXPECT_EQ(result.signal, 0);
}

TEST(FrameLoop, GoesOnAfterAFrameThatFails) {
  std::vector<int> written;
  const auto result = run_frame_loop(
      first(5),
      [&](int index) -> FrameWriter {
        if (index == 2) throw Error(ErrorKind::unexpected, "the device was lost");
        return [&written, index] { written.push_back(index); };
      },
      no_signal);
  EXPECT_THAT(written, testing::ElementsAre(0, 1, 3, 4));
  ASSERT_EQ(result.failed.size(), 1u);
  EXPECT_EQ(result.failed[0].index, 2);
  EXPECT_EQ(result.failed[0].message, "the device was lost");
}

TEST(FrameLoop, FinishesTheFrameAtHandWhenASignalArrives) {
  std::vector<int> written;
  int signal = 0;
  const auto result = run_frame_loop(
      first(100),
      [&](int index) -> FrameWriter {
        if (index == 3) signal = SIGTERM;  // arrives in the middle of frame 3
        return [&written, index] { written.push_back(index); };
      },
      [&] { return signal; });
  EXPECT_THAT(written, testing::ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(result.signal, SIGTERM);
}

TEST(FrameLoop, StopsAtAWriterThatFails) {
  std::vector<int> written;
  const auto compute = [&](int index) -> FrameWriter {
    return [&written, index] {
      if (index == 4) throw Error(ErrorKind::input_output, "frame_0004.exr: cannot write: No space left on device");
      written.push_back(index);
    };
  };
  try {
    run_frame_loop(first(1000), compute, no_signal);
    ADD_FAILURE() << "the full disk went unnoticed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input_output);
  }
  EXPECT_THAT(written, testing::ElementsAre(0, 1, 2, 3));
}

}  // namespace
}  // namespace understory
