// Numbers on the command line, as people write them.
#include <gtest/gtest.h>

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

TEST(SetNumbers, AreNotMadeOfWhatIsNone) {
    for (const char* written : {"exposure=.", "exposure=++1", "exposure=-+1", "exposure=+-1", "exposure=+",
                                "exposure=1..5", "exposure=a.5"})
        EXPECT_EQ(explained(written).exit_code, 2) << written;
}

}  // namespace
}  // namespace aftershade::test
