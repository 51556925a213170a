// `understory bake` as a user types it.
#include <gtest/gtest.h>

#include "tests/program/program.hpp"
#include "tests/support/temporary_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

using testing::HasSubstr;

const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class Bake : public ::testing::Test {
 protected:
  FinishedProcess bake(const std::string& mesh, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"bake", mesh, "-o", (folder_ / "grid.vti").string(), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return understory_command(arguments, {"XDG_CACHE_HOME=" + (folder_ / "cache").string()});
  }
  TemporaryFolder folder_;
};

TEST_F(Bake, WritesAGridAndSaysWhatEightBitsCost) {
  const TemporaryFile mesh("body.obj", tetrahedron);
  const FinishedProcess first = bake(mesh.path(), {"--size", "8x9x10", "--cone"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const nlohmann::json json = nlohmann::json::parse(first.out);
  EXPECT_EQ(json["triangles"], 4);
  EXPECT_EQ(json["size"], nlohmann::json({8, 9, 10}));
  EXPECT_EQ(json["bytes"], 4 * 8 * 9 * 10);
  EXPECT_TRUE(json["notes"].empty());
  EXPECT_LE(json["bits8_error"]["share_max"].get<double>(), 1 / 509.0);
  const std::string bytes = file_text(folder_ / "grid.vti");
  EXPECT_THAT(bytes, HasSubstr("ImageData"));
  ASSERT_EQ(bake(mesh.path(), {"--size", "8x9x10", "--cone", "--threads", "1"}).exit_code, 0);
  EXPECT_EQ(file_text(folder_ / "grid.vti"), bytes) << "from the cache, on one thread";
}

TEST_F(Bake, SaysWhenAMeshHasNoInside) {
  const TemporaryFile open("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const FinishedProcess one = bake(open.path(), {"--size", "6"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.err, HasSubstr("open at 3 edges"));
  const TemporaryFile flat("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
  EXPECT_THAT(bake(flat.path(), {"--size", "6"}).err, HasSubstr("no inside to fill"));
  const TemporaryFile turned("turned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  EXPECT_THAT(bake(turned.path(), {"--size", "6"}).err, HasSubstr("inside out"));
}

TEST_F(Bake, RefusesInOneLine) {
  const TemporaryFile mesh("body.obj", tetrahedron);
  for (const char* size : {"1", "10000", "512x512x600"}) {
    const FinishedProcess refused = bake(mesh.path(), {"--size", size});
    EXPECT_EQ(refused.exit_code, 3) << size;
    EXPECT_THAT(refused.err, IsOneMessageWith("2 to 512"));
  }
  EXPECT_EQ(bake(mesh.path(), {"--size", "32y32"}).exit_code, 2);
  EXPECT_EQ(bake(mesh.path(), {"--size", "32x32"}).exit_code, 2);
  EXPECT_THAT(bake(mesh.path(), {"--object", "wheel"}).err, IsOneMessageWith("wheel"));
  EXPECT_THAT(bake("nowhere.obj").err, IsOneMessageWith("there is no such mesh file"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "grid.vti"));
}

TEST_F(Bake, IsFoundInTheCacheByItsContent) {
  const TemporaryFile mesh("body.obj", tetrahedron), copy("copy.obj", tetrahedron);
  const std::vector<std::string> environment{"XDG_CACHE_HOME=" + (folder_ / "cache").string()};
  const auto bakes = [&] {
    return nlohmann::json::parse(understory_command({"cache", "info", "--json"}, environment).out)["bakes"];
  };
  ASSERT_EQ(bake(mesh.path(), {"--size", "6"}).exit_code, 0);
  ASSERT_EQ(bake(copy.path(), {"--size", "6"}).exit_code, 0);
  EXPECT_EQ(bakes(), 1);
  ASSERT_EQ(bake(copy.path(), {"--size", "6", "--epsilon", "0.2"}).exit_code, 0);
  EXPECT_EQ(bakes(), 2);
}

}  // namespace
}  // namespace understory
