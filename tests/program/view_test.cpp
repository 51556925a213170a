// `view` on a virtual display, with a real click and a real key; and without a display.
#include "tests/program/program.hpp"
#include "tests/support/virtual_display.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

const std::string scene = scenes_folder + "/tiny.yaml";

TEST(View, SaysThatItNeedsADisplay) {
  const FinishedProcess result = run_process({"env", "-u", "DISPLAY", program_path, "view", scene});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.err, IsOneMessageWith("DISPLAY"));
}

TEST(View, PlaysAndSwitchesMethods) {
  if (!VirtualDisplay::available()) GTEST_SKIP() << "needs Xvfb and xdotool";
  const VirtualDisplay display(1024, 768);
  Process view({program_path, "view", scene, "--events", "--size", "400x250"}, {"DISPLAY=" + display.name()});
  ASSERT_TRUE(view.wait_until([&] { return view.out().find("ready\n") != std::string::npos; })) << view.err();
  std::istringstream events(view.out());
  int x = 0, y = 0;
  for (std::string word, name; events >> word;)
    if (word == "button" && events >> name && name == "tree") events >> x >> y;
  ASSERT_GT(x, 0) << view.out();
  display.click(x, y);
  EXPECT_TRUE(
      view.wait_until([&] { return view.out().find("\ntree ") != std::string::npos; }, std::chrono::seconds(20)))
      << view.out();
  display.key("v");
  EXPECT_TRUE(view.wait_until([&] { return view.out().find("show visibility\n") != std::string::npos; },
                              std::chrono::seconds(20)))
      << view.out();
  display.key("q");
  const FinishedProcess result = view.wait();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("closed\n"));
}

}  // namespace
}  // namespace understory
