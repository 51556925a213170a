// `--frames` against Python's slices, and the text of the progress line.
#include "host/app/frame_range.hpp"

#include <gmock/gmock.h>

#include "host/app/progress.hpp"
#include "sim/error.hpp"

namespace understory {
namespace {

std::vector<int> indices(const std::string& text, int scene_frames = 48) {
  const FrameRange range = parse_frame_range(text, scene_frames);
  std::vector<int> all;
  for (int i = 0; i < range.count(); ++i) all.push_back(range.at(i));
  return all;
}

TEST(FrameRange, IsHalfOpenAsInPython) {
  EXPECT_THAT(indices("2:5"), testing::ElementsAre(2, 3, 4));
  EXPECT_THAT(indices("0:10:4"), testing::ElementsAre(0, 4, 8));
  EXPECT_THAT(indices("0:9:4"), testing::ElementsAre(0, 4, 8));
  EXPECT_THAT(indices("0:8:4"), testing::ElementsAre(0, 4));
  EXPECT_THAT(indices("7"), testing::ElementsAre(7));
  EXPECT_THAT(indices(":3"), testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(indices("1::2", 6), testing::ElementsAre(1, 3, 5));
  EXPECT_EQ(indices(":").size(), 48u);
  EXPECT_THAT(indices("100:102"), testing::ElementsAre(100, 101)) << "time goes on past the scene's own frames";
}

TEST(FrameRange, RefusesWhatHoldsNoFrame) {
  for (const char* text :
       {"", "5:5", "5:2", "0:4:0", "0:4:-1", "-3:2", "a:b", "1:2:3:4", "1.5", "0:99999999999", " 1", "48:"})
    try {
      parse_frame_range(text, 48);
      ADD_FAILURE() << '"' << text << "\" was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_THAT(error.what(), testing::HasSubstr("allowed: A:B")) << text;
    }
}

TEST(Progress, SaysShareRateAndTimeLeft) {
  EXPECT_EQ(clock_text(0), "0:00");
  EXPECT_EQ(clock_text(725.4), "12:05");
  EXPECT_EQ(clock_text(3 * 3600 + 4 * 60 + 5), "3:04:05");
  EXPECT_EQ(progress_text(12, 48, 2, "frames", 8), "[##......]  25 %  12/48 frames  2.0 s each  left 1:12");
  EXPECT_EQ(progress_text(48, 48, 0.25, "frames", 0), "100 %  48/48 frames  4.0/s  left 0:00");
  EXPECT_EQ(progress_text(0, 48, 0, "frames", 0), "  0 %  0/48 frames") << "no rate before the first step";
}

}  // namespace
}  // namespace understory
