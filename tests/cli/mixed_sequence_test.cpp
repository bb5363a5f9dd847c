// Sequences whose frames differ from the first one: in their layers, alpha, shape of pixels.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "framework/batch/process_codes.h"
#include "framework/file/png_file.h"
#include "tests/cli/batch_work.h"
#include "tests/mixed_frames.h"

namespace aftershade::test {
namespace {

class MixedSequence : public BatchWork {
protected:
    void write(int frame, const std::vector<std::string>& channels, float pixel_aspect = 1,
               const std::map<std::string, ExrValue>& attributes = {}) {
        write_tenths(frame_path(frame), channels, attributes, pixel_aspect);
    }
    float red(const std::string& name) const { return color(name).at(0, 0, 0); }
    static void expect_text(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
};

TEST_F(MixedSequence, IsReadFromTheFirstFramesLayerByWorkersAndChunksToo) {
    write(1, view_layers({"Zeta"}));
    write(2, view_layers({"Beta", "Zeta"}));
    write(3, view_layers({"Beta", "alpha", "Zeta"}));
    const std::vector<std::string> line{"nothing.json", "in_####.exr", "-o"};
    const auto with = [&](std::initializer_list<std::string> more) {
        std::vector<std::string> all = line;
        all.insert(all.end(), more);
        return all;
    };
    const CommandResult one = run(with({"one_####.exr", "--report", "one.json"}), 0);
    expect_text(one.err, "warning: in_0002.exr: it has the layers 'Beta' and 'Zeta'; 'Zeta' is read");
    run(with({"two_####.exr", "--jobs", "3", "--report", "two.json"}), 0);
    for (const char* chunk : {"1/3", "2/3", "3/3"}) run(with({"chunk_####.exr", "--chunk", chunk}), 0);
    for (const std::string run : {"one_", "two_", "chunk_"}) {
        EXPECT_FLOAT_EQ(red(run + "0002.exr"), 0.5f) << run;
        EXPECT_FLOAT_EQ(red(run + "0003.exr"), 0.9f) << run;
    }
    for (const char* name : {"one.json", "two.json"}) {
        const auto frames = nlohmann::json::parse(read_text(folder_ / name))["frames"];
        EXPECT_FALSE(frames[0].contains("message")) << frames[0];
        expect_text(frames[1].value("message", ""), "it has the layers 'Beta' and 'Zeta'; 'Zeta' is read");
    }
}

TEST_F(MixedSequence, HasInTheReportOfEachFrameWhatItsFileLost) {
    const auto write_depth = [&](int frame, const char* compression) {
        const Image values(16, 9, 1);
        std::vector<ExrOutputChannel> channels;
        for (const char* name : {"R", "G", "B", "Z"})
            channels.push_back({name, PixelType::float32, &values, 0});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 15, 8};
        options.compression = compression;
        write_exr(frame_path(frame), channels, options);
    };
    write_depth(1, "zip");
    write_depth(2, "pxr24");
    write_depth(3, "zip");
    for (const char* jobs : {"1", "2"}) {
        const CommandResult result =
            run({"nothing.json", "in_####.exr", "-o", std::string(jobs) + "_####.exr", "--report",
                 "report.json", "--jobs", jobs},
                0);
        expect_text(result.err, "in_0002.exr: depth is read from 'Z', stored with loss (pxr24)");
        const auto frames = nlohmann::json::parse(read_text(folder_ / "report.json"))["frames"];
        for (const std::size_t other : {0, 2}) EXPECT_FALSE(frames[other].contains("message")) << frames;
        expect_text(frames[1].value("message", ""), "depth is read from 'Z', stored with loss (pxr24)");
    }
}

TEST_F(MixedSequence, FailsInAFrameWithoutTheFirstFramesLayer) {
    write(1, view_layers({"Zeta"}));
    write(2, view_layers({"alpha"}));
    write(3, view_layers({"Zeta"}));
    const CommandResult result =
        run({"nothing.json", "in_####.exr", "-o", "out_####.exr"}, int(ExitCode::partial));
    EXPECT_EQ(result.out, "out_0001.exr\nout_0003.exr\n");
    expect_text(result.err,
                "in_0002.exr: has no layer 'Zeta', which the first frame, in_0001.exr, is read from");
}

TEST_F(MixedSequence, MakesPicturesOfOneKind) {
    write(1, {"R", "G", "B", "A"});
    write(2, {"R", "G", "B"});
    const CommandResult result = run({"nothing.json", "in_####.exr", "-o", "out_####.png"}, 0);
    expect_text(result.err, "in_0002.exr: color is read from 'R', 'G' and 'B', in in_0001.exr from");
    EXPECT_EQ(read_png(folder_ / "out_0001.png").channels(), 4);
    EXPECT_EQ(read_png(folder_ / "out_0002.png").channels(), 4);
}

TEST_F(MixedSequence, RestartsHistoryWhereTheShapeOfPixelsChanges) {
    write(1, {"R", "G", "B", "A"});
    write(2, {"R", "G", "B", "A"}, 2);
    const CommandResult result = run({"trail.json", "in_####.exr", "-o", "out_####.exr"}, 0);
    expect_text(result.err, "frame 2: history reset: another pixel aspect");
    expect_text(result.err, "warning: in_0002.exr: its pixel aspect is 2, that of in_0001.exr is 1");
}

class PartOfAMixedSequence : public MixedSequence {
protected:
    /// Frames whose own first layer, alpha and colour space would each be others.
    PartOfAMixedSequence() {
        write(1, view_layers({"Zeta"}));
        write(2, view_layers({"Beta", "Zeta"}), 1, {{"chromaticities", kAcescgPrimaries}});
        std::vector<std::string> opaque = view_layers({"Beta", "Zeta"});
        opaque.pop_back();
        write(3, opaque);
        write(4, view_layers({"alpha", "Zeta"}));
        run({"trail.json", "in_####.exr", "-o", "whole_####.exr", "-o", "whole_####.png"}, 0);
    }
    CommandResult run_part(const std::vector<std::string>& more) const {
        std::vector<std::string> line{"trail.json",    "in_####.exr", "-o",
                                      "part_####.exr", "-o",          "part_####.png"};
        line.insert(line.end(), more.begin(), more.end());
        return run(line, 0);
    }
    void expect_whole(int frame) const {
        const std::string number = FramePattern("####").path(frame);
        EXPECT_TRUE(std::ranges::equal(color("part_" + number + ".exr").floats(),
                                       color("whole_" + number + ".exr").floats()))
            << frame;
        EXPECT_TRUE(std::ranges::equal(read_png(folder_ / ("part_" + number + ".png")).floats(),
                                       read_png(folder_ / ("whole_" + number + ".png")).floats()))
            << frame;
    }
};

TEST_F(PartOfAMixedSequence, HasTheBitsOfTheWholeInAChunkThatWarmsUp) {
    for (const char* chunk : {"1/4", "2/4", "3/4", "4/4"}) run_part({"--chunk", chunk, "--warmup", "3"});
    for (const int frame : {1, 2, 3, 4}) expect_whole(frame);
}

TEST_F(PartOfAMixedSequence, HasTheBitsOfTheWholeWhereTheHistoryIsHandedOn) {
    run_part({"--frames", "1-2", "--history-out", "h"});
    const CommandResult later = run_part({"--frames", "3-4", "--history-in", "h"});
    for (const int frame : {1, 2, 3, 4}) expect_whole(frame);
    expect_text(later.err,
                "warning: in_0003.exr: it has the layers 'Beta' and 'Zeta'; 'Zeta' is read, as in "
                "in_0001.exr");
    expect_text(later.err, "; its alpha is 1");
}

TEST_F(PartOfAMixedSequence, HasTheBitsOfTheWholeFromWorkers) {
    const CommandResult result = run_part({"--jobs", "2", "--warmup", "3", "--report", "report.json"});
    for (const int frame : {1, 2, 3, 4}) expect_whole(frame);
    const auto frames = nlohmann::json::parse(read_text(folder_ / "report.json"))["frames"];
    expect_text(frames[1].value("message", ""), "its colours have other primaries than those of in_0001.exr");
}

TEST_F(PartOfAMixedSequence, HasTheBitsOfTheWholeWhereItIsResumed) {
    run_part({});
    for (const char* name : {"part_0003.exr", "part_0004.png"}) std::filesystem::remove(folder_ / name);
    EXPECT_EQ(run_part({}).out, "part_0003.exr\npart_0003.png\npart_0004.exr\npart_0004.png\n");
    for (const int frame : {1, 2, 3, 4}) expect_whole(frame);
    std::filesystem::remove(folder_ / "part_0004.exr");
    run_part({"--frames", "1-4", "--resume"});
    expect_whole(4);
}

TEST_F(MixedSequence, IsRenderedAgainWhereItsFirstFrameDecidesOtherwise) {
    write(1, view_layers({"Zeta"}));
    write(2, view_layers({"Beta", "Zeta"}));
    write(3, view_layers({"Beta", "Zeta"}));
    const std::vector<std::string> line{"nothing.json", "in_####.exr", "-o", "out_####.exr"};
    run(line, 0);
    write(1, view_layers({"Zeta"}), 1, {{"comments", std::string("rendered again")}});
    EXPECT_EQ(run(line, 0).out, "out_0001.exr\n") << "which decides the same";
    write(1, view_layers({"Beta"}));
    std::vector<std::string> dry = line;
    dry.emplace_back("--dry-run");
    for (const char* frame : {"1", "2", "3"})
        expect_text(run(dry, 0).out,
                    std::string("frame ") + frame + ": what the first frame decides changed");
    EXPECT_EQ(run(line, 0).out, "out_0001.exr\nout_0002.exr\nout_0003.exr\n");
    for (const char* name : {"out_0001.exr", "out_0002.exr", "out_0003.exr"})
        EXPECT_FLOAT_EQ(red(name), 0.1f);
    // Where the first is gone, the next one decides.
    std::filesystem::remove(frame_path(1));
    EXPECT_EQ(run({"nothing.json", "in_####.exr", "-o", "out_####.exr"}, 0).out, "");
}

TEST_F(MixedSequence, OfLayersIsReadByTheFirstFrameOfEach) {
    write(1, {"R", "G", "B", "A"});
    write(2, {"R", "G", "B", "A"});
    const auto plate = [&](int frame, const std::vector<std::string>& channels) {
        write(9, channels);
        std::filesystem::rename(frame_path(9), folder_ / FramePattern("back_####.exr").path(frame));
    };
    plate(1, view_layers({"Zeta"}));
    plate(2, view_layers({"Beta", "Zeta"}));
    write_text(folder_ / "capture.json", R"({"aftershade": 1, "frames": "in_####.exr", "layers":
        [{}, {"frames": "back_####.exr"}], "range": "1-2"})");
    const CommandResult whole = run({"nothing.json", "capture.json", "-o", "whole_####.exr"}, 0);
    expect_text(whole.err, "layer 2: it has the layers 'Beta' and 'Zeta'; 'Zeta' is read, as in ");
    // 0.1 with alpha 0.4 over 0.1 or, of the second frame, 0.5.
    EXPECT_FLOAT_EQ(red("whole_0001.exr"), 0.1f + 0.6f * 0.1f);
    EXPECT_FLOAT_EQ(red("whole_0002.exr"), 0.1f + 0.6f * 0.5f);
    run({"nothing.json", "capture.json", "-o", "part_####.exr", "--frames", "2"}, 0);
    EXPECT_FLOAT_EQ(red("part_0002.exr"), 0.1f + 0.6f * 0.5f);
    plate(1, view_layers({"Beta"}));
    run({"nothing.json", "capture.json", "-o", "whole_####.exr"}, 0);
    EXPECT_FLOAT_EQ(red("whole_0002.exr"), 0.1f + 0.6f * 0.1f) << "which is not current";
}

TEST_F(MixedSequence, IsInspectedAsItIsRun) {
    write(1, view_layers({"Zeta"}));
    write(2, view_layers({"Beta", "Zeta"}));
    write(3, view_layers({"alpha"}));
    const auto inspect = [&](std::vector<std::string> more, int code) {
        more.insert(more.begin(), {"inspect", "in_####.exr"});
        const CommandResult result = run_aftershade(more, folder_.path());
        EXPECT_EQ(result.exit_code, code) << result.err;
        return result.out + result.err;
    };
    const std::string second = inspect({"--frames", "2"}, 0);
    expect_text(second, "layer: Zeta\n");
    expect_text(second, "warning: it has the layers 'Beta' and 'Zeta'; 'Zeta' is read, as in in_0001.exr\n");
    expect_text(inspect({"--frames", "2", "--json"}, 0), "'Zeta' is read, as in in_0001.exr");
    expect_text(inspect({"--frames", "3"}, 0), "has no layer 'Zeta', which the first frame, in_0001.exr");
    const std::string sheet = inspect({"--frames", "1-3", "--contact-sheet", "sheet.png"}, 1);
    expect_text(sheet, "warning: in_0002.exr: it has the layers 'Beta' and 'Zeta'");
    expect_text(sheet, "error: in_0003.exr: has no layer 'Zeta'");
}

TEST_F(MixedSequence, IsAPairWhoseVelocityIsOfOneLayer) {
    write(1, view_layers({"Zeta"}));
    write(2, view_layers({"alpha"}));
    const CommandResult result =
        run_aftershade({"inspect", "--check-velocity", "in_0001.exr", "in_0002.exr"}, folder_.path());
    EXPECT_EQ(result.exit_code, int(ExitCode::capture));
    expect_text(result.err,
                "in_0002.exr: has no layer 'Zeta', which the first frame, in_0001.exr, is read from");
}

}  // namespace
}  // namespace aftershade::test
