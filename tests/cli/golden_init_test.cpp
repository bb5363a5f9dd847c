// What `golden init` writes, and what it leaves alone.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

class GoldenInit : public GoldenCommand {
protected:
    CommandResult init(std::vector<std::string> words) {
        words.insert(words.begin(), {"init", "lens.json", "in_####.exr"});
        return golden(words);
    }
};

TEST_F(GoldenInit, WritesASuiteThatPassesAtOnceAndNoticesAChange) {
    const CommandResult result = init({"-o", "my suite", "--frames", "1-2", "--outputs", "color,depth"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json test = Json::parse(read_text(folder_ / "my suite/golden.json"))["cases"][0];
    EXPECT_EQ(test["name"], "lens");
    EXPECT_EQ(test["look"], "../lens.json");
    EXPECT_EQ(test["tolerance"], Json({{"fail_ulp", 2}}));
    for (const char* name : {"color.0001", "color.0002", "depth.0001", "depth.0002"})
        EXPECT_TRUE(
            std::filesystem::exists(folder_ / ("my suite/goldens/lens." + std::string(name) + ".exr")))
            << name;
    EXPECT_NE(result.out.find("tolerance: fail_ulp 2\n"), result.out.npos) << result.out;
    EXPECT_NE(result.out.find("All runs gave the same bits"), result.out.npos) << result.out;
    EXPECT_NE(result.out.find("run it: aftershade golden run 'my suite'"), result.out.npos) << result.out;
    EXPECT_EQ(golden({"run", "my suite"}).exit_code, 0);
    write_text(folder_ / "lens.json", std::regex_replace(std::string(kLens), std::regex("0\\.5"), "0.51"));
    EXPECT_EQ(golden({"run", "my suite"}).exit_code, 2);
}

TEST_F(GoldenInit, NamesEachBackendThatItDrewOn) {
    const CommandResult result = init({"-o", "new", "--frames", "1", "--backend", "osmesa"});
    if (result.exit_code == 4) GTEST_SKIP() << "no OSMesa here";
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(std::regex_search(result.out, std::regex(R"(osmesa \(llvmpipe[^\n]*: the same bits\n)")))
        << result.out;
    EXPECT_TRUE(
        std::regex_search(result.out, std::regex(R"(egl-software \(llvmpipe[^\n]*: the same bits\n)")))
        << result.out;
}

TEST_F(GoldenInit, LeavesASuiteThatIsThere) {
    const std::string before = read_text(folder_ / "golden.json");
    const CommandResult result = init({"-o", "."});
    EXPECT_EQ(result.exit_code, 64);
    EXPECT_NE(result.err.find("golden.json: is there already"), result.err.npos) << result.err;
    EXPECT_EQ(read_text(folder_ / "golden.json"), before);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "goldens"));
}

TEST_F(GoldenInit, LeavesNothingOfALookThatDoesNotDraw) {
    write_text(folder_ / "lens.json",
               R"({ "aftershade": 1, "steps": [ { "effect": "bokeh", "params": { "f_numbr": 1 } } ] })");
    const CommandResult result = init({"-o", "new"});
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_NE(result.err.find("did you mean 'f_number'"), result.err.npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "new"));
}

}  // namespace
}  // namespace aftershade::test
