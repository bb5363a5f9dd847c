#include "framework/golden/golden_fetch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "framework/base/sha256.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

TEST(GoldenCache, GivesBackBytesOfTheirDigestAlone) {
    const TemporaryFolder folder;
    GoldenCache cache(folder / "cache");
    const std::string bytes = "an image", digest = sha256(bytes);
    EXPECT_EQ(cache.load(digest), "");
    cache.save(digest, bytes);
    EXPECT_EQ(cache.load(digest), bytes);
    write_text(folder / ("cache/goldens/" + digest + ".exr"), "another");
    EXPECT_EQ(cache.load(digest), "");
    EXPECT_EQ(cache.fault(), "");
}

TEST(GoldenCache, RemovesWhatWasUsedLongestAgo) {
    const TemporaryFolder folder;
    GoldenCache cache(folder.path(), 25);
    const std::string old_bytes(10, 'a'), used(10, 'b'), last(10, 'c');
    for (const std::string& bytes : {old_bytes, used, last}) {
        cache.save(sha256(bytes), bytes);
        const fs::path file = folder / ("goldens/" + sha256(bytes) + ".exr");
        fs::last_write_time(file, fs::last_write_time(file) - std::chrono::hours(bytes == last ? 1 : 2));
    }
    write_text(folder / "goldens/mine.exr", std::string(100, 'd'));
    EXPECT_EQ(cache.load(sha256(used)), used);
    cache.make_room();
    EXPECT_EQ(cache.load(sha256(old_bytes)), "");
    EXPECT_EQ(cache.load(sha256(used)), used);
    EXPECT_EQ(cache.load(sha256(last)), last);
    EXPECT_TRUE(fs::exists(folder / "goldens/mine.exr")) << "no image of the cache";
}

TEST(GoldenCache, ThatCannotBeUsedSaysWhy) {
    const TemporaryFolder folder;
    write_text(folder / "file", "x");
    const std::string bytes = "an image", digest = sha256(bytes);
    GoldenCache reading(folder / "file");
    EXPECT_EQ(reading.load(digest), "");
    EXPECT_NE(reading.fault().find("cannot be reached: Not a directory (choose another folder"),
              std::string::npos)
        << reading.fault();
    GoldenCache writing(folder / "file/below");
    writing.save(digest, bytes);
    EXPECT_NE(writing.fault().find("AFTERSHADE_CACHE"), std::string::npos) << writing.fault();
    fs::create_directory_symlink(folder.path(), folder / "goldens");
    GoldenCache link(folder.path());
    link.save(digest, bytes);
    EXPECT_NE(link.fault().find("symbolic link"), std::string::npos) << link.fault();
    EXPECT_FALSE(fs::exists(folder / (digest + ".exr")));
    GoldenCache off("");
    off.save(digest, bytes);
    EXPECT_EQ(off.load(digest) + off.fault(), "");
}

}  // namespace
}  // namespace aftershade::test
