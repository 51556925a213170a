// The cache of bakes: what was stored comes back, what was damaged does not, and clearing empties it.
#include "host/trace/bake_cache.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

ContentHash hash_of(std::string_view text) {
  ContentHash hash;
  hash.add(text);
  return hash;
}

class BakeCache : public testing::Test {
 protected:
  BakeCache() { setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1); }
  std::filesystem::path only_file() const {
    for (const auto& entry : std::filesystem::directory_iterator(bake_cache_folder())) return entry.path();
    return {};
  }
  TemporaryFolder folder_;
};

TEST_F(BakeCache, GivesBackWhatWasStored) {
  const std::string bytes("\0result\n\xff", 9);
  EXPECT_FALSE(load_bake("test", hash_of("a")));
  store_bake("test", hash_of("a"), bytes);
  EXPECT_EQ(load_bake("test", hash_of("a")), bytes);
  EXPECT_FALSE(load_bake("test", hash_of("b")));
  EXPECT_FALSE(load_bake("other", hash_of("a")));
  EXPECT_EQ(bake_cache_info().files, 1u);
  EXPECT_EQ(bake_cache_clear().files, 1u);
  EXPECT_EQ(bake_cache_info().files, 0u);
  EXPECT_FALSE(load_bake("test", hash_of("a")));
}

TEST_F(BakeCache, IsClearedOfWhatWasNotFinishedToo) {
  store_bake("test", hash_of("a"), "result");
  const std::filesystem::path unfinished = bake_cache_folder() / "tradeoff-0123";
  std::filesystem::create_directories(unfinished / "variants");
  std::ofstream(unfinished / "variants" / "one.cbor") << "half";
  EXPECT_EQ(bake_cache_info().files, 1u);
  const std::uint64_t bytes = bake_cache_info().bytes;
  EXPECT_EQ(bake_cache_clear().bytes, bytes);
  EXPECT_FALSE(std::filesystem::exists(unfinished));
  EXPECT_EQ(bake_cache_info().bytes, 0u);
}

TEST_F(BakeCache, IsNotReadWhileBakesAreToBeFresh) {
  store_bake("test", hash_of("a"), "old");
  {
    const FreshBakes none_kept;
    EXPECT_FALSE(load_bake("test", hash_of("a")));
    store_bake("test", hash_of("a"), "new");
  }
  EXPECT_EQ(load_bake("test", hash_of("a")), "new");
}

TEST_F(BakeCache, NeverGivesBackADamagedFile) {
  const std::string bytes = "some result";
  store_bake("test", hash_of("a"), bytes);
  std::string whole;
  {
    std::ifstream file(only_file(), std::ios::binary);
    whole.assign(std::istreambuf_iterator<char>(file), {});
  }
  const auto write = [&](const std::string& text) { std::ofstream(only_file(), std::ios::binary) << text; };
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    write(damaged);
    EXPECT_FALSE(load_bake("test", hash_of("a"))) << "byte " << i;
    write(whole.substr(0, i));
    EXPECT_FALSE(load_bake("test", hash_of("a"))) << "cut at " << i;
  }
  write(whole);
  EXPECT_EQ(load_bake("test", hash_of("a")), bytes);
}

TEST_F(BakeCache, WithoutAPlaceIsNoError) {
  setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
  store_bake("test", hash_of("a"), "bytes");
  EXPECT_FALSE(load_bake("test", hash_of("a")));
  EXPECT_EQ(bake_cache_info().files, 0u);
}

TEST(ContentHash, DependsOnEveryByteAndOnTheirOrder) {
  EXPECT_EQ(hash_of("abc").text(), hash_of("abc").text());
  EXPECT_NE(hash_of("abc").text(), hash_of("abd").text());
  EXPECT_NE(hash_of("abcdefgh").text(), hash_of("abcdefgh\0").text().substr(1));
  ContentHash together, apart;
  together.add(std::string_view("ab"));
  apart.add(std::string_view("a"));
  apart.add(std::string_view("b"));
  EXPECT_NE(together.text(), apart.text());
  EXPECT_EQ(together.text().size(), 32u);
}

}  // namespace
}  // namespace understory
