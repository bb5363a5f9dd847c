// Usual slips on the command line: each names the command that was meant.
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

class Slip : public BatchWork {
protected:
    void expect_hint(std::vector<std::string> words, const std::string& hint) {
        const CommandResult result = run_aftershade(words, folder_.path());
        EXPECT_NE(result.exit_code, 0);
        EXPECT_NE(result.err.find(hint), std::string::npos) << hint << "\n" << result.err;
    }
};

TEST_F(Slip, APatternWithAStarIsWrittenWithHashes) {
    write_frames(1, 2);
    expect_hint({"run", "nothing.json", "in_*.exr", "-o", "out_####.exr"}, "'in_####.exr'");
    expect_hint({"inspect", "in_*.exr"}, "'in_####.exr'");
    // The shell expanded it.
    expect_hint({"run", "nothing.json", "in_0001.exr", "in_0002.exr", "-o", "out_####.exr"},
                "does not expand it: 'in_####.exr'");
}

TEST_F(Slip, AFilmIsMadeByFfmpeg) {
    write_frames(1, 1);
    expect_hint({"run", "nothing.json", "in_0001.exr", "-o", "film.mp4"}, "-o - --print-ffmpeg");
}

TEST_F(Slip, AnEffectsPathIsAnOptionOfItsOwn) {
    expect_hint({"new", "a/b"}, "aftershade new b --path a");
}

TEST_F(Slip, ANameThatBeginsWithADashNeedsAFolder) {
    expect_hint({"inspect", "-dash.exr"}, "./-dash.exr");
    expect_hint({"run", "nothing.json", "-dash.exr", "-o", "o.exr"}, "./-dash.exr");
}

TEST_F(Slip, ATrailingCommaIsNamed) {
    write_frames(1, 1);
    write_text(folder_ / "comma.json", R"({"aftershade": 1, "steps": [{"effect": "vignette"},]})");
    expect_hint({"run", "comma.json", "in_0001.exr", "-o", "o.exr"}, "remove the comma before it");
}

TEST_F(Slip, OptionsComeAfterTheCommand) {
    expect_hint({"--effect-path", "x", "run", "nothing.json", "in_0001.exr", "-o", "o.exr"},
                "aftershade run nothing.json in_0001.exr -o o.exr --effect-path x");
}

TEST_F(Slip, TheLookComesBeforeTheCapture) {
    write_frames(1, 1);
    expect_hint({"serve", "in_0001.exr"}, "aftershade serve look.json in_0001.exr");
    expect_hint({"run", "in_0001.exr", "-o", "o.exr"}, "aftershade run look.json in_0001.exr");
}

}  // namespace
}  // namespace aftershade::test
