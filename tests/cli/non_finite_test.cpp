// NaN in captures and from effects: --on-nan.
#include <cmath>
#include <regex>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class NonFiniteFrame : public BatchWork {
protected:
    NonFiniteFrame() {
        write_frames(1, 3);
        clean_ = make_capture({.width = 64, .height = 36, .background = {0.5f, 0.25f, 1}}, 2);
        write_capture(clean_, frame_path(2));
    }
    void damage_frame_two() {
        Capture damaged = clean_;
        damaged.images.at("color").at(30, 17, 1) = kNan;
        damaged.images.at("color").at(31, 17, 0) = kNan;
        write_capture(damaged, frame_path(2));
    }
    static std::size_t count_of_nan(const Image& image) {
        std::size_t count = 0;
        for (const float value : image.floats()) count += std::isnan(value);
        return count;
    }
    static void expect_told(const CommandResult& result, const std::string& line) {
        EXPECT_TRUE(std::regex_search(result.err, std::regex(line))) << line << "\n" << result.err;
    }

    Capture clean_;
};

TEST_F(NonFiniteFrame, IsReportedByItsFileRoleCountAndFirstPixelWithTheRemedy) {
    damage_frame_two();
    const CommandResult result = run({"spread.json", "in_####.exr", "-o", "out_####.exr"}, 0);
    expect_told(result,
                "aftershade: warning: frame 2: the role 'color' of in_0002\\.exr has 2 NaN pixels, the first "
                "at \\(30, 17\\) \\(--on-nan mend replaces such pixels, --on-nan fail .*\\)");
    // A box of 5 x 5 px makes 25 of one, and 5 more of its neighbour.
    expect_told(result,
                "aftershade: warning: frame 2: the output 'color' has 30 NaN pixels, the first at \\(28, "
                "15\\); the capture has them in 'color' \\(--on-nan mend");
    expect_told(result, "NaN or infinite pixels in 1 of 3 frames: 2\n");
    EXPECT_EQ(result.err.find("frame 1: the"), std::string::npos) << result.err;
    EXPECT_GT(count_of_nan(color("out_0002.exr")), 0u);
}

TEST_F(NonFiniteFrame, IsLeftOutWithFailAndTheOthersAreWritten) {
    run({"spread.json", "in_####.exr", "-o", "whole_####.exr"}, 0);
    damage_frame_two();
    const CommandResult result =
        run({"spread.json", "in_####.exr", "-o", "out_####.exr", "--on-nan", "fail"}, int(ExitCode::partial));
    EXPECT_EQ(result.out, "out_0001.exr\nout_0003.exr\n");
    expect_told(result,
                "aftershade: error: frame 2: the role 'color' of in_0002\\.exr has 2 NaN pixels.*left out");
    EXPECT_FALSE(fs::exists(folder_ / "out_0002.exr"));
    EXPECT_EQ(read_text(folder_ / "out_0003.exr"), read_text(folder_ / "whole_0003.exr"));
    run({"spread.json", "in_0002.exr", "-o", "out.exr", "--on-nan", "fail"}, int(ExitCode::capture));
}

TEST_F(NonFiniteFrame, IsRepairedBeforeABlurSpreadsIt) {
    damage_frame_two();
    const CommandResult result =
        run({"spread.json", "in_####.exr", "-o", "mended_####.exr", "--on-nan", "mend"}, 0);
    expect_told(result,
                "frame 2: the role 'color' of in_0002\\.exr has 2 NaN pixels, the first at \\(30, 17\\); "
                "replaced by the mean of the finite pixels around them\n");
    EXPECT_EQ(result.err.find("the output"), std::string::npos) << result.err;
    // All neighbours are alike, so the mean of them is what was there before.
    write_capture(clean_, frame_path(2));
    run({"spread.json", "in_0002.exr", "-o", "clean.exr"}, 0);
    const Image mended = color("mended_0002.exr"), clean = color("clean.exr");
    for (std::size_t i = 0; i < clean.floats().size(); ++i)
        ASSERT_NEAR(mended.floats()[i], clean.floats()[i], 1e-6f) << i;
}

TEST_F(NonFiniteFrame, IsMendedBeforeItIsScaled) {
    damage_frame_two();
    run({"nothing.json", "in_0002.exr", "-o", "out.exr", "--on-nan", "mend", "--scale", "1/2"}, 0);
    EXPECT_EQ(count_of_nan(color("out.exr")), 0u);
}

TEST_F(NonFiniteFrame, OfAnEffectIsPutDownToTheEffect) {
    const std::string made =
        "frame 1: the output 'color' has 1 NaN pixel, at \\(9, 4\\); what effects read has none, so an "
        "effect "
        "made them: --audit names its pass";
    expect_told(run({"poison.json", "in_0001.exr", "-o", "out.exr"}, 0), made);
    EXPECT_EQ(count_of_nan(color("out.exr")), 1u);
    const CommandResult mended = run({"poison.json", "in_0001.exr", "-o", "out.exr", "--on-nan", "mend"}, 0);
    expect_told(mended, made + "; replaced");
    EXPECT_EQ(count_of_nan(color("out.exr")), 0u);
    fs::remove(folder_ / "out.exr");
    expect_told(
        run({"poison.json", "in_0001.exr", "-o", "out.exr", "--on-nan", "fail"}, int(ExitCode::effect)),
        "error: " + made);
    EXPECT_FALSE(fs::exists(folder_ / "out.exr"));
}

TEST_F(NonFiniteFrame, LeavesInfiniteDepthAlone) {
    Capture capture = make_capture({.width = 16, .height = 9, .background = {1, 1, 1}});  // nothing is hit
    write_capture(capture, folder_ / "sky.exr");
    const CommandResult result = run(
        {"nothing.json", "sky.exr", "-o", "out.exr", "--output-roles", "color,depth", "--on-nan", "fail"}, 0);
    EXPECT_EQ(result.err.find("infinite"), std::string::npos) << result.err;
}

TEST_F(NonFiniteFrame, IsFoundInDepthAndVectorsThoughDecodingReplacesIt) {
    for (const char* role : {"depth", "velocity"}) {
        Capture damaged = clean_;
        damaged.images.at(role).at(30, 17, 0) = kNan;
        write_capture(damaged, frame_path(2));
        const std::string roles = std::string("color,") + role;
        const std::string fault =
            "frame 2: the role '" + std::string(role) + "' of in_0002\\.exr has 1 NaN pixel, at \\(30, 17\\)";
        const std::string read_as = role == std::string("depth") ? "no hit" : "no motion data";
        expect_told(run({"nothing.json", "in_0002.exr", "-o", "out.exr", "--output-roles", roles}, 0),
                    "warning: " + fault + "; read as " + read_as + " \\(--on-nan fail leaves");
        expect_told(
            run({"nothing.json", "in_0002.exr", "-o", "no.exr", "--output-roles", roles, "--on-nan", "fail"},
                int(ExitCode::capture)),
            "error: " + fault + ".*left out");
        EXPECT_FALSE(fs::exists(folder_ / "no.exr"));
        expect_told(
            run({"nothing.json", "in_0002.exr", "-o", "out.exr", "--output-roles", roles, "--on-nan", "mend"},
                0),
            fault + "; read as " + read_as);
    }
}

TEST_F(NonFiniteFrame, WhoseDepthIsNegativeIsWarnedOfOnceByARunAndByInspect) {
    clean_.images.at("depth").at(3, 4, 0) = -2;
    for (int frame = 2; frame <= 3; ++frame) write_capture(clean_, frame_path(frame));
    const std::string warning = "depth is negative in places";
    const std::string err =
        run({"nothing.json", "in_####.exr", "-o", "out_####.exr", "--output-roles", "color,depth"}, 0).err;
    EXPECT_NE(err.find("in_0002.exr: " + warning), std::string::npos) << err;
    EXPECT_EQ(err.find("in_0003.exr: " + warning), std::string::npos) << err;
    const std::string out = run_aftershade({"inspect", "in_0002.exr"}, folder_.path()).out;
    EXPECT_NE(out.find("warning: " + warning), std::string::npos) << out;
    EXPECT_EQ(out.find(warning), out.rfind(warning)) << out;
    EXPECT_EQ(run_aftershade({"inspect", "in_0001.exr"}, folder_.path()).out.find(warning),
              std::string::npos);
}

TEST_F(NonFiniteFrame, IsToldInAPictureToo) {
    damage_frame_two();
    const CommandResult result =
        run({"nothing.json", "in_0002.exr", "-o", "out.png", "--progress", "none"}, 0);
    expect_told(result, "warning: frame 2: the role 'color' of in_0002\\.exr has 2 NaN pixels");
}

TEST_F(NonFiniteFrame, ThatAHalfMakesOfLargeValuesIsReportedWithCountAndRemedy) {
    Capture bright = clean_;
    bright.images.at("color").at(3, 4, 0) = 1e30f;
    bright.images.at("color").at(5, 4, 0) = -70000;
    bright.images.at("color").at(6, 4, 1) = 65504;
    write_capture(bright, frame_path(2));
    const CommandResult result =
        run_aftershade({"run", "nothing.json", "in_0002.exr", "-o", "out.exr"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_told(
        result,
        "aftershade: warning: frame 2: out\\.exr: 2 values of 'R' above 65504, the largest half, became "
        "infinite \\(write floats: --pixel-type float; or lower the exposure\\)");
    expect_told(result, "NaN or infinite pixels in 1 of 1 frames: 2\n");
    EXPECT_TRUE(std::isinf(color("out.exr").at(3, 4, 0)));
    const CommandResult floats = run({"nothing.json", "in_0002.exr", "-o", "float.exr"}, 0);
    EXPECT_EQ(floats.err.find("65504"), std::string::npos) << floats.err;
    EXPECT_EQ(color("float.exr").at(3, 4, 0), 1e30f);
}

}  // namespace
}  // namespace aftershade::test
