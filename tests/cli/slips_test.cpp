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
    expect_hint({"run", "nothing.json", "in_0001.exr", "-o", "film.avi"}, "-o - --print-ffmpeg");
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

TEST_F(Slip, ACaptureWithoutALookSaysWhatThereIsAndALineThatDraws) {
    write_frames(1, 1);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"run", "in_0001.exr"}, {"run", "in_0001.exr", "-o", "o.exr"}}) {
        const CommandResult result = run_aftershade(words, folder_.path());
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find("LOOK is missing"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("roles: albedo, color, depth, "), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("\n  noir "), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("aftershade serve in_0001.exr\n"), std::string::npos) << result.err;
        const std::size_t begin = result.err.find("draw one: aftershade run ") + 25;
        const std::string look = result.err.substr(begin, result.err.find(' ', begin) - begin);
        EXPECT_EQ(result.err.substr(begin + look.size(), 23), " in_0001.exr -o out.png");
        EXPECT_EQ(run_aftershade({"run", look, "in_0001.exr", "-o", "out.png"}, folder_.path()).exit_code, 0);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "o.exr"));
    }
    expect_hint({"run", "nothing.json"}, "capture is required");
    expect_hint({"serve", "nothing.json"}, "aftershade serve nothing.json CAPTURE");
    expect_hint({"serve"}, "aftershade serve [LOOK] CAPTURE");
    expect_hint({"serve", "none/new.json", "in_0001.exr"}, "there is no folder");
}

TEST_F(Slip, ALookAndACaptureThatChangedPlacesAreNamedOnceEach) {
    write_frames(1, 1);
    write_text(folder_ / "capture.json", R"({"aftershade": 1, "frames": "in_0001.exr"})");
    for (const std::string capture : {"in_0001.exr", "capture.json"}) {
        const CommandResult result =
            run_aftershade({"run", capture, "nothing.json", "-o", "o.exr"}, folder_.path());
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find("this place takes a capture; the look comes before the capture"),
                  std::string::npos)
            << result.err;
        EXPECT_NE(result.err.find("2 errors"), std::string::npos) << result.err;
    }
}

TEST_F(Slip, ADepthPassThatIsReadAsColorIsSaid) {
    const auto says = [&](const std::string& name, const std::string& channel) {
        const Image image(8, 4, 1);
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 7, 3};
        const std::vector<ExrOutputChannel> channels = {{channel, PixelType::float32, &image, 0}};
        write_exr(folder_ / name, channels, options);
        return run_aftershade({"inspect", name}, folder_.path()).out;
    };
    const std::string hint = "--role depth=";
    EXPECT_NE(says("depth.0001.exr", "Y").find(hint + "depth.0001.exr"), std::string::npos);
    EXPECT_NE(says("shot_Zdepth_0001.exr", "Y").find(hint), std::string::npos);
    EXPECT_NE(says("shot-z.exr", "Y").find(hint), std::string::npos);
    EXPECT_EQ(says("depth_of_field_0001.exr", "Y").find(hint), std::string::npos);
    EXPECT_EQ(says("depth_0001.exr", "Z").find(hint), std::string::npos);
}

TEST_F(Slip, LightThatAPngCutsIsSaidOnce) {
    const auto says = [&](float light, const std::string& look, const std::string& output) {
        SyntheticScene scene{.width = 8, .height = 4, .background = {light, light, light}};
        for (int frame = 1; frame <= 2; ++frame) write_capture(make_capture(scene, frame), frame_path(frame));
        write_text(folder_ / "look.json", look);
        const CommandResult result =
            run_aftershade({"run", "look.json", "in_####.exr", "-o", output}, folder_.path());
        EXPECT_EQ(result.exit_code, 0) << result.err;
        int times = 0;
        const std::string name = "a last step that makes display";
        for (std::size_t at = 0; (at = result.err.find(name, at)) != std::string::npos; ++at) ++times;
        return times;
    };
    const std::string plain =
        R"({"aftershade": 1, "steps": [{"effect": "vignette", "params": {"strength": 0}}]})";
    const std::string viewed = R"({"aftershade": 1, "steps": [{"effect": "view_transform"}]})";
    EXPECT_EQ(says(2, plain, "o_####.png"), 1);
    EXPECT_EQ(says(0.5, plain, "o_####.png"), 0);
    EXPECT_EQ(says(2, plain, "o_####.exr"), 0);
    EXPECT_EQ(says(2, viewed, "o_####.png"), 0);
}

}  // namespace
}  // namespace aftershade::test
