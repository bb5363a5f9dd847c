// What becomes of history where a frame in the middle cannot be rendered.
#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"
#include "tests/cli/native_effect.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class BatchHistory : public BatchWork {
protected:
    BatchHistory() { write_frames(1, 6); }
    void cut(int frame) const { fs::resize_file(frame_path(frame), fs::file_size(frame_path(frame)) / 2); }
    std::vector<float> pixels(const std::string& name) const {
        const Image image = color(name);
        return {image.floats().begin(), image.floats().end()};
    }
    CommandResult trail(const std::string& out, std::vector<std::string> more, int exit_code) const {
        more.insert(more.begin(), {"trail.json", "in_####.exr", "-o", out});
        return run(more, exit_code);
    }
};

TEST_F(BatchHistory, APluginThatCrashesCostsItsFrameAndNoHistory) {
    write_native_effect(folder_.path(), "crashes_late");  // in frame 3
    write_native_effect(folder_.path(), "older");
    const auto look = [&](const std::string& id) {
        write_text(folder_ / (id + ".json"), R"({ "aftershade": 1, "steps": [ { "effect": ")" + id +
                                                 R"(" }, { "effect": "trail" } ] })");
        return id + ".json";
    };
    const auto film = [&](const std::string& id, const std::string& out, std::vector<std::string> more,
                          int exit_code) {
        more.insert(more.begin(), {look(id), "in_####.exr", "-o", out, "--plugin-path", kCases});
        return run(more, exit_code);
    };
    film("crashes_late", "out_####.exr", {"--jobs", "1", "--warmup", "2"}, int(ExitCode::partial));
    // As if frame 3 had never been: frame 4 continues the trail of 1 and 2.
    film("older", "whole_####.exr", {"--frames", "1,2,4-6"}, 0);
    for (const int frame : {1, 2, 4, 5, 6}) {
        const std::string number = FramePattern("####").path(frame);
        EXPECT_EQ(pixels("out_" + number + ".exr"), pixels("whole_" + number + ".exr")) << frame;
    }
    // No warm-up is needed: the plug-in has a process of its own, and the worker lives on.
    film("crashes_late", "short_####.exr", {"--jobs", "1", "--warmup", "1"}, int(ExitCode::partial));
    EXPECT_EQ(pixels("short_0004.exr"), pixels("whole_0004.exr"));
}

TEST_F(BatchHistory, FramesBehindAFailedOneAreRenderedAgainUntilItCanBeRead) {
    const std::string sound = read_text(frame_path(3));
    cut(3);
    trail("out_####.exr", {}, int(ExitCode::partial));
    const std::vector<float> without = pixels("out_0006.exr");
    const CommandResult again = trail("out_####.exr", {}, int(ExitCode::partial));
    EXPECT_EQ(again.out, "out_0004.exr\nout_0005.exr\nout_0006.exr\n");
    EXPECT_EQ(pixels("out_0006.exr"), without) << "the same pixels as before";
    write_text(frame_path(3), sound);
    EXPECT_EQ(trail("out_####.exr", {}, 0).out, "out_0003.exr\nout_0004.exr\nout_0005.exr\nout_0006.exr\n");
    trail("whole_####.exr", {}, 0);
    for (const char* number : {"0003", "0004", "0006"})
        EXPECT_EQ(read_text(folder_ / ("out_" + std::string(number) + ".exr")),
                  read_text(folder_ / ("whole_" + std::string(number) + ".exr")));
    EXPECT_EQ(trail("out_####.exr", {}, 0).out, "");
}

TEST_F(BatchHistory, ABadSubFrameLeavesNoTraceInTheFramesBehindIt) {
    write_effect("average",
                 R"("accumulates": "subframes",
        "textures": { "total": { "format": "rgba32f", "history": true, "doc": "Sum." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "total.prev"], "writes": ["total"] },
                    { "name": "show", "shader": "show.frag", "reads": ["total"], "writes": ["color"] } ])",
                 "out_total = texelFetch(color, p, 0) +\n"
                 "(frame.subframe > 0 ? texelFetch(total_prev, p, 0) : vec4(0.0));");
    write_text(folder_ / "effects/average/show.frag",
               head() + "out_color = texelFetch(total, p, 0) / float(frame.subframe_count);\n}\n");
    write_text(folder_ / "look.json",
               R"({ "aftershade": 1, "steps": [ { "effect": "average" }, { "effect": "trail" } ] })");
    // Frame n is the files 2 n and 2 n + 1.
    write_frames(2, 9);
    write_text(folder_ / "capture.json",
               R"({ "aftershade": 1, "frames": "in_####.exr", "subframes": 2, "range": "1-4" })");
    cut(5);
    run({"look.json", "capture.json", "-o", "out_####.exr"}, int(ExitCode::partial));
    EXPECT_FALSE(fs::exists(folder_ / "out_0002.exr"));
    run({"look.json", "capture.json", "-o", "whole_####.exr", "--frames", "1,3-4"}, 0);
    for (const char* number : {"0001", "0003", "0004"})
        EXPECT_EQ(pixels("out_" + std::string(number) + ".exr"),
                  pixels("whole_" + std::string(number) + ".exr"))
            << number;
}

}  // namespace
}  // namespace aftershade::test
