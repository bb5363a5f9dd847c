// What a suite with a store does where its folders, its cache or its disk fail.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class GoldenStoreFaults : public GoldenCommand {
protected:
    GoldenStoreFaults() {
        use_store("images");
        EXPECT_EQ(with_cache({"approve", "golden.json"}, "cache").exit_code, 0);
        approved_ = contents(folder_ / "goldens");
        fs::remove(corner_);
    }
    void use_store(const std::string& store) {
        write_text(folder_ / "golden.json", R"({ "aftershade": 1, "store": ")" + store + R"(", "cases": [
            { "name": "corner", "steps": [ { "effect": "vignette" } ], "capture": "in_####.exr",
              "frames": "1" } ] })");
    }
    CommandResult with_cache(const std::vector<std::string>& words, const std::string& cache) {
        return golden(words, {{"AFTERSHADE_CACHE", (folder_ / cache).string()}});
    }

    const fs::path corner_ = image("corner.color.0001");
    std::map<std::string, std::string> approved_;
};

TEST_F(GoldenStoreFaults, OfTheCacheAreAWarningAndTheStoreIsUsed) {
    write_text(folder_ / "file", "x");
    fs::create_directories(folder_ / "occupied");
    write_text(folder_ / "occupied/goldens", "x");
    for (const char* cache : {"file", "occupied"}) {
        SCOPED_TRACE(cache);
        const CommandResult result = with_cache({"run", "golden.json"}, cache);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find("aftershade: warning: " + (folder_ / cache).string() + "/goldens"),
                  std::string::npos)
            << result.err;
        EXPECT_NE(result.err.find("(choose another folder with AFTERSHADE_CACHE, or off)"), std::string::npos)
            << result.err;
        EXPECT_EQ(contents(folder_ / "goldens"), approved_);
        fs::remove(corner_);
    }
}

TEST_F(GoldenStoreFaults, OfTheFolderOfTheStoreApproveNothingAndNameIt) {
    fs::remove_all(folder_ / "images");
    write_text(folder_ / "images", "x");
    const CommandResult ran = with_cache({"run", "golden.json"}, "cache");
    EXPECT_EQ(ran.exit_code, 4) << ran.err;
    EXPECT_NE(ran.err.find("cannot be reached: Not a directory (check the address in the suite's 'store'"),
              std::string::npos)
        << ran.err;
    fs::remove_all(folder_ / "goldens");
    const CommandResult result = with_cache({"approve", "golden.json"}, "cache");
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(
        result.err.find("the store's folder cannot be made: Not a directory (remove what is in its place"),
        std::string::npos)
        << result.err;
    EXPECT_TRUE(contents(folder_ / "goldens").empty()) << "nothing half";
}

TEST_F(GoldenStoreFaults, OfAnImagesPlaceNameItAndTheRemedy) {
    fs::create_directories(corner_ / "in the way");  // fails as a read-only checkout does, also for root
    const CommandResult result = with_cache({"run", "golden.json"}, "cache");
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("goldens/corner.color.0001.exr: cannot"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("of a read-only checkout, run in a copy"), std::string::npos) << result.err;
}

TEST_F(GoldenStoreFaults, OfItsAddressPrintNoPassword) {
    for (const char* store :
         {"http://ada:s3cret@host/x", "https://host/x?token=s3cret", "rclone:a:s3cret@host"}) {
        SCOPED_TRACE(store);
        use_store(store);
        const CommandResult result =
            golden({"run", "golden.json", "--json", "--report", "report", "--junit", "junit.xml"});
        EXPECT_EQ(result.exit_code, 64) << result.err;
        EXPECT_NE(result.err.find("passwords belong into ~/.netrc or rclone.conf"), std::string::npos);
        std::string all = result.out + result.err + read_text(folder_ / "junit.xml");
        for (const auto& [name, text] : contents(folder_ / "report")) all += text;
        EXPECT_EQ(all.find("s3cret"), std::string::npos);
    }
}

TEST_F(GoldenStoreFaults, OfRclonesAddressPrintNoPassword) {
    if (!fs::exists("/usr/bin/rclone")) GTEST_SKIP() << "rclone is absent (Debian package rclone)";
    use_store("rclone:share:a");
    const CommandResult result =
        golden({"run", "golden.json"}, {{"AFTERSHADE_CACHE", "off"},
                                        {"RCLONE_CONFIG_SHARE_TYPE", "webdav"},
                                        {"RCLONE_CONFIG_SHARE_URL", "http://ada:s3cret@127.0.0.1:bad/"},
                                        {"HOME", folder_.path().string()}});
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("not fetched"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("s3cret"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace aftershade::test
