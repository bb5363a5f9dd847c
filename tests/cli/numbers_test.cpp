// Numbers on the command line, as people write them.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <string>
#include <vector>

#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

/// What --explain says of the step for one --set.
CommandResult explained(const std::string& set) {
    const TemporaryFolder folder;
    write_text(folder / "look.json", R"({"aftershade": 1, "steps": [{"effect": "color_grade"}]})");
    write_capture(make_capture({.width = 8, .height = 8}), folder / "in.exr");
    return run_aftershade({"run", (folder / "look.json").string(), (folder / "in.exr").string(), "-o",
                           "o.exr", "--explain", "--set", "color_grade." + set, "--backend", "software"},
                          folder.path());
}

TEST(SetNumbers, MayHaveAPlusAndNoZero) {
    for (const auto& [written, plain] : {std::pair{"exposure=.5", "exposure=0.5"},
                                         {"exposure=+0.5", "exposure=0.5"},
                                         {"exposure=+.5", "exposure=0.5"},
                                         {"exposure=-.25", "exposure=-0.25"},
                                         {"exposure=2.", "exposure=2"},
                                         {"exposure=+.5 ev", "exposure=0.5 ev"},
                                         {"slope=[.5, +.25,+1]", "slope=[0.5, 0.25, 1]"}}) {
        const CommandResult result = explained(written), expected = explained(plain);
        EXPECT_EQ(result.exit_code, 0) << written << result.err;
        EXPECT_EQ(result.out, expected.out) << written;
    }
}

/// The options of a verb whose help gives them a value of that type.
std::vector<std::string> options_of_type(const std::string& verb, const std::string& type) {
    const std::string help = run_aftershade({verb, "--help"}, ".").out;
    const std::regex row("\n  (?:-\\w, )?(--[a-z-]+) " + type + "\\b");
    std::vector<std::string> names;
    for (std::sregex_iterator at(help.begin(), help.end(), row), end; at != end; ++at)
        names.push_back((*at)[1]);
    return names;
}

TEST(OptionNumbers, ThatSlipPastTheirLimitsAreRefused) {
    const TemporaryFolder folder;
    std::size_t count = 0;
    for (const std::string verb : {"run", "check", "compare", "render", "submit", "warm", "serve", "inspect"})
        for (const auto& [type, values] : std::map<std::string, std::vector<std::string>>{
                 {"FLOAT", {"nan", "-NaN"}},
                 {"UINT", {"-1", "18446744073709551616"}},
                 {"SIZE", {"-1", "0", "1XB", "1.5", "18446744073709551615", "16EB"}}})
            for (const std::string& option : options_of_type(verb, type))
                for (const std::string& value : values) {
                    const CommandResult result = run_aftershade({verb, option, value}, folder.path());
                    EXPECT_TRUE(result.exit_code == 2 || result.exit_code == 64) << verb << option << value;
                    EXPECT_NE(result.err.find(option + ": "), std::string::npos) << result.err;
                    ++count;
                }
    EXPECT_GT(count, 60U);
    EXPECT_EQ(run_aftershade({"compare", "a.exr", "a.exr", "--forgive-blur", "nan"}, folder.path()).exit_code,
              64);
    const CommandResult size = run_aftershade(
        {"render", AFTERSHADE_SOURCE_DIR "/scenes/wheel", "-o", "r", "--size", "-1x5"}, folder.path());
    EXPECT_EQ(size.exit_code, 2);
    EXPECT_EQ(size.err.find("GiB"), std::string::npos) << size.err;
}

TEST(OptionNumbers, OfBytesTakeUnits) {
    const TemporaryFolder folder;
    write_text(folder / "look.json", R"({"aftershade": 1, "steps": [{"effect": "color_grade"}]})");
    write_capture(make_capture({.width = 8, .height = 8}), folder / "in.exr");
    for (const auto& [size, code] : std::vector<std::pair<std::string, int>>{
             {"1kb", 7}, {"1MB", 7}, {"359 MiB", 7}, {"600m", 0}, {"2GB", 0}, {"1tib", 0}}) {
        const CommandResult result =
            run_aftershade({"run", "look.json", "in.exr", "-o", "o.exr", "--overwrite", "--max-memory", size},
                           folder.path());
        EXPECT_EQ(result.exit_code, code) << size << result.err;
        if (code == 7) {
            EXPECT_NE(result.err.find("--max-memory 360MB"), std::string::npos) << result.err;
        }
    }
}

TEST(SetNumbers, AreNotMadeOfWhatIsNone) {
    for (const char* written : {"exposure=.", "exposure=++1", "exposure=-+1", "exposure=+-1", "exposure=+",
                                "exposure=1..5", "exposure=a.5"})
        EXPECT_EQ(explained(written).exit_code, 2) << written;
}

}  // namespace
}  // namespace aftershade::test
