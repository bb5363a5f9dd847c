// --scale, --region, --history-in and --history-out, --graph, --var, looks that use looks, and sub-frames.
#include <gtest/gtest.h>

#include <cmath>

#include "framework/batch/process_codes.h"
#include "framework/file/png_file.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class RenderOptions : public testing::Test {
protected:
    RenderOptions() {
        SyntheticScene scene{
            .width = 64, .height = 36, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = 8};
        scene.box = SyntheticBox{4, 6, 16, 12, 5, 2};
        scene.points = {{50, 20, 9}};
        for (int frame = 1; frame <= 6; ++frame)
            write_capture(make_capture(scene, frame), folder_ / ("in_000" + std::to_string(frame) + ".exr"));
        write_text(folder_ / "nothing.json", R"({ "aftershade": 1, "steps": [] })");
        // Each frame holds half of those before it; a box of 5 px reaches 2 px.
        write_effect(
            "trail", R"(
            "textures": { "kept": { "format": "rgba16f", "history": true, "doc": "Light so far." } },
            "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "kept.prev"],
                          "writes": ["kept"] },
                        { "name": "show", "shader": "show.frag", "reads": ["kept"], "writes": ["color"] } ])",
            "void main() { ivec2 p = ivec2(gl_FragCoord.xy); vec4 now = texelFetch(color, p, 0);\n"
            "out_kept = frame.history_valid ? mix(now, texelFetch(kept_prev, p, 0), 0.5) : now; }\n");
        write_text(folder_ / "effects/trail/show.frag",
                   kHead + "void main() { out_color = texelFetch(kept, ivec2(gl_FragCoord.xy), 0); }\n");
        write_effect("spread", R"(
            "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])",
                     "void main() { vec4 sum = vec4(0.0); for (int y = -2; y <= 2; ++y) for (int x = -2; x "
                     "<= 2; ++x)\n"
                     "sum += texelFetch(color, clamp(ivec2(gl_FragCoord.xy) + ivec2(x, y), ivec2(0),\n"
                     "frame.size - 1), 0); out_color = sum / 25.0; }\n");
        write_text(folder_ / "trail.json", R"({ "aftershade": 1, "steps": [ { "effect": "trail" } ] })");
        write_text(folder_ / "spread.json", R"({ "aftershade": 1, "steps": [ { "effect": "spread" } ] })");
    }

    void write_effect(const std::string& id, const std::string& sections, const std::string& shader) {
        fs::create_directories(folder_ / "effects" / id);
        write_text(folder_ / "effects" / id / "effect.json",
                   R"({ "aftershade": 1, "version": "1.0.0", "summary": "A test.", "id": ")" + id +
                       R"(", "inputs": { "color": { "role": "color" } },
                           "outputs": { "color": { "role": "color" } }, )" +
                       sections + "}");
        write_text(folder_ / "effects" / id / "main.frag", kHead + shader);
    }

    CommandResult run(std::vector<std::string> arguments, int exit_code = 0) {
        arguments.insert(arguments.begin(), "run");
        for (const char* word :
             {"--effect-path", "effects", "--backend", "software", "--pixel-type", "float"})
            arguments.push_back(word);
        CommandResult result = run_aftershade(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result;
    }
    Image color(const std::string& name) { return ExrFile(folder_ / name).read_floats(0, kRgba); }
    static bool same(const Image& a, const Image& b) {
        return a.width() == b.width() && a.height() == b.height() &&
               std::equal(a.floats().begin(), a.floats().end(), b.floats().begin());
    }

    const std::string kHead = "#version 450 core\n#include <pass>\n";
    TemporaryFolder folder_;
};

TEST_F(RenderOptions, ScaleAveragesLightAndPicksDepth) {
    run({"nothing.json", "in_0001.exr", "--scale", "1/4", "--output-roles", "color,depth,velocity", "-o",
         "small.exr"});
    const Image full = color("in_0001.exr"), small = color("small.exr");
    ASSERT_EQ(small.width(), 16);
    ASSERT_EQ(small.height(), 9);
    double sum = 0;
    for (int y = 4; y < 8; ++y)
        for (int x = 8; x < 12; ++x) sum += double(full.at(x, y, 0));
    EXPECT_FLOAT_EQ(small.at(2, 1, 0), float(sum / 16));
    const ExrFile file(folder_ / "small.exr");
    const std::vector<std::string> depth_name{"Z"}, velocity_name{"velocity.X"};
    const Image depth = file.read_floats(0, depth_name), velocity = file.read_floats(0, velocity_name);
    EXPECT_EQ(depth.at(3, 3, 0), 1.0f) << "the box";
    EXPECT_EQ(depth.at(15, 8, 0), 8.0f) << "never between two surfaces";
    EXPECT_EQ(velocity.at(3, 3, 0), 1.25f) << "5 px a frame at full scale";
}

TEST_F(RenderOptions, RegionIsThatPartOfTheWholePicture) {
    run({"spread.json", "in_0002.exr", "-o", "whole.exr"});
    run({"spread.json", "in_0002.exr", "--region", "10,8,30,20", "--region-margin", "4", "-o", "part.exr",
         "-o", "part.png"});
    const Image whole = color("whole.exr"), part = color("part.exr");
    const ExrFile file(folder_ / "part.exr");
    EXPECT_EQ(file.parts()[0].data_window, (Window{10, 8, 39, 27}));
    EXPECT_EQ(file.parts()[0].display_window, (Window{0, 0, 63, 35}));
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 30; ++x)
            for (int c = 0; c < 4; ++c)
                ASSERT_EQ(part.at(x, y, c), whole.at(x + 10, y + 8, c)) << x << " " << y;
    const Image png = read_png(folder_ / "part.png");
    EXPECT_EQ(png.width(), 30);
    EXPECT_EQ(png.height(), 20);
}

/// Without a "reach", effects that read nothing but their pixel count from the part of the frame in these
/// ways.
TEST_F(RenderOptions, RegionOfAnEffectThatDrawsByItsPlaceIsThatPartOfTheWholePicture) {
    for (const std::string place : {"gl_FragCoord.xy", "gl_FragCoord.xy / vec2(frame.size)",
                                    "(gl_FragCoord.xy + vec2(frame.origin)) / vec2(frame.display_size)"}) {
        fs::create_directories(folder_ / "effects/ramp");
        write_text(folder_ / "effects/ramp/effect.json",
                   R"({ "aftershade": 1, "version": "1.0.0", "summary": "A test.", "id": "ramp",
            "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
            "passes": [ { "name": "main", "shader": "main.frag", "reads": [{"color": "pixel"}], "writes": ["color"] } ] })");
        write_text(folder_ / "effects/ramp/main.frag",
                   "#version 450 core\n#include <pass>\nvoid main() { out_color = "
                   "vec4(" +
                       place + ", color.rg); }\n");
        write_text(folder_ / "ramp.json", R"({ "aftershade": 1, "steps": [ { "effect": "ramp" } ] })");
        run({"ramp.json", "in_0002.exr", "-o", "whole.exr"});
        run({"ramp.json", "in_0002.exr", "--region", "10,8,30,20", "-o", "part.exr"});
        const Image whole = color("whole.exr"), part = color("part.exr");
        for (int c = 0; c < 4; ++c) EXPECT_EQ(part.at(4, 3, c), whole.at(14, 11, c)) << place;
    }
}

TEST_F(RenderOptions, RegionBeyondThePictureIsCutToItAndSaid) {
    const CommandResult over = run({"nothing.json", "in_0002.exr", "--region=50,-4,40,20", "-o", "part.exr",
                                    "-o", "part.png", "--report", "report.json"});
    const std::string said =
        "the region, 40 x 20 px at (50, -4), reaches beyond the picture, 64 x 36 px at (0, 0); 14 x 16 px at "
        "(50, 0) of it are written";
    EXPECT_NE(over.err.find("warning: in_0002.exr: " + said), std::string::npos) << over.err;
    EXPECT_NE(read_text(folder_ / "report.json").find(said), std::string::npos);
    EXPECT_EQ(ExrFile(folder_ / "part.exr").parts()[0].data_window, (Window{50, 0, 63, 15}));
    EXPECT_EQ(read_png(folder_ / "part.png").width(), 14);
    EXPECT_EQ(read_png(folder_ / "part.png").height(), 16);
    const CommandResult within =
        run({"nothing.json", "in_0002.exr", "--region=50,0,14,16", "-o", "part.exr"});
    EXPECT_EQ(within.err.find("region"), std::string::npos) << within.err;
    const CommandResult beside = run(
        {"nothing.json", "in_0002.exr", "--region", "64,0,4,4", "-o", "none.exr"}, int(ExitCode::capture));
    EXPECT_NE(
        beside.err.find("no pixel of the data window (4 x 4 px at (64, 0) against 64 x 36 px at (0, 0); "
                        "choose one within it)"),
        std::string::npos)
        << beside.err;
}

TEST_F(RenderOptions, HistoryGoesFromChunkToChunkBitForBit) {
    run({"trail.json", "in_####.exr", "-o", "whole_####.exr"});
    run({"trail.json", "in_####.exr", "--frames", "1-2", "--history-out", "h", "-o", "part_####.exr"});
    run({"trail.json", "in_####.exr", "--frames", "3-4", "--history-in", "h", "--history-out", "h", "-o",
         "part_####.exr"});
    run({"trail.json", "in_####.exr", "--frames", "5-6", "--history-in", "h", "-o", "part_####.exr"});
    for (const char* frame : {"1", "2", "3", "4", "5", "6"})
        EXPECT_TRUE(same(color("whole_000" + std::string(frame) + ".exr"),
                         color("part_000" + std::string(frame) + ".exr")))
            << frame;
    const CommandResult refused =
        run({"trail.json", "in_####.exr", "--frames", "2", "--history-in", "h", "-o", "no.exr"}, 2);
    EXPECT_NE(refused.err.find("this history is of frame 4; it continues with frame 5, not with 2"),
              std::string::npos);
    EXPECT_FALSE(fs::exists(folder_ / "no.exr"));
}

TEST_F(RenderOptions, HistoryBeginsAnewAtACutAndAfterAMissingFrameAndSaysSo) {
    write_text(folder_ / "capture.json",
               R"({ "aftershade": 1, "frames": "in_####.exr", "range": "1-6", "cuts": [3] })");
    fs::remove(folder_ / "in_0005.exr");
    const CommandResult result =
        run({"trail.json", "capture.json", "--missing", "skip", "-o", "out_####.exr"});
    EXPECT_NE(result.err.find("frame 3: history reset: a cut"), std::string::npos);
    EXPECT_NE(result.err.find("frame 6: history reset: it follows frame 4, not 5"), std::string::npos);
    for (const char* frame : {"1", "3", "6"}) {
        // Half precision in the texture: the source is exact in it but for 0.1 and 0.2.
        const Image out = color("out_000" + std::string(frame) + ".exr"),
                    in = color("in_000" + std::string(frame) + ".exr");
        for (std::size_t i = 0; i < out.floats().size(); ++i)
            ASSERT_NEAR(out.floats()[i], in.floats()[i], 1e-3f * std::abs(in.floats()[i]) + 1e-6f) << frame;
    }
}

/// Each frame's light is its number; the look writes the numbers that it reads as digits to the base 8.
TEST_F(RenderOptions, FramesUpToThreeAwayAreReadAsFarAsTheShotAndTheFilesGo) {
    const std::vector<int> offsets{-3, -2, -1, 1, 2, 3};
    std::string inputs = R"("color": { "role": "color" })", shader = "void main() { float sum = 0.0;\n";
    for (const int offset : offsets) {
        const std::string distance = std::to_string(std::abs(offset));
        inputs += std::string(", \"") + (offset < 0 ? "before_" : "after_") + distance +
                  R"(": { "role": "color", "optional": true, "frame": )" + std::to_string(offset) + " }";
        const std::string value =
            std::string("texelFetch(") + (offset < 0 ? "before_" : "after_") + distance + ", ivec2(0), 0).r";
        shader += std::string("#ifdef HAS_") + (offset < 0 ? "BEFORE_" : "AFTER_") + distance +
                  "\nsum += " + std::to_string(int(std::pow(8, offset + 3))) + ".0 * " + value +
                  ";\n#endif\n";
    }
    shader += "out_color = vec4(sum + 512.0 * texelFetch(color, ivec2(0), 0).r); }\n";
    write_effect("around", R"("passes": [ { "name": "main", "shader": "main.frag" } ])", shader);
    const fs::path manifest = folder_ / "effects/around/effect.json";
    std::string text = read_text(manifest);
    const std::string own = R"("inputs": { "color": { "role": "color" } })";
    text.replace(text.find(own), own.size(), "\"inputs\": { " + inputs + " }");
    write_text(manifest, text);
    write_text(folder_ / "around.json", R"({ "aftershade": 1, "steps": [ { "effect": "around" } ] })");
    for (int frame = 1; frame <= 7; ++frame)
        write_capture(make_capture({.width = 16, .height = 16, .background = {float(frame), 0, 0}}, frame),
                      folder_ / ("n_000" + std::to_string(frame) + ".exr"));
    fs::remove(folder_ / "n_0004.exr");
    write_text(folder_ / "capture.json",
               R"({ "aftershade": 1, "frames": "n_####.exr", "range": "1-7", "cuts": [3] })");
    run({"around.json", "capture.json", "--missing", "skip", "-o", "around_####.exr"});
    for (const int frame : {1, 2, 3, 5, 6, 7}) {
        double expected = 0;
        for (int other = 1; other <= 7; ++other)
            if (other != 4 && (other < 3) == (frame < 3) && std::abs(other - frame) <= 3)
                expected += other * std::pow(8, other - frame + 3);
        EXPECT_EQ(color("around_000" + std::to_string(frame) + ".exr").at(3, 3, 0), float(expected)) << frame;
    }
}

TEST_F(RenderOptions, GraphIsDrawn) {
    const CommandResult result =
        run({"trail.json", "in_0001.exr", "-o", "a.exr", "--graph", "g.dot", "--verbose"});
    const std::string dot = read_text(folder_ / "g.dot");
    EXPECT_EQ(dot.find("digraph"), 0u);
    EXPECT_NE(dot.find("trail.main"), std::string::npos);
    EXPECT_NE(result.err.find("MiB without sharing memory"), std::string::npos);
    run({"trail.json", "in_0001.exr", "-o", "a.exr", "--graph", "g.txt"}, 2);
}

TEST_F(RenderOptions, ALookUsesAnotherWithVariablesAndAPrefix) {
    fs::create_directories(folder_ / "looks");
    write_text(folder_ / "looks/light.json", R"({ "aftershade": 1, "vars": { "stops": 0 }, "steps": [
        { "effect": "view_transform", "params": { "exposure": { "var": "stops" } } } ] })");
    write_text(folder_ / "film.json", R"({ "aftershade": 1, "vars": { "push": 1 }, "steps": [
        { "effect": "spread" }, { "use": "looks/light.json", "name": "final", "vars": { "stops": { "var": "push" } } } ] })");
    const CommandResult plain = run({"film.json", "in_0001.exr", "-o", "a.png", "--explain"});
    EXPECT_NE(plain.out.find("final_view_transform.exposure = 1 ev   [the look]"), std::string::npos)
        << plain.out;
    const CommandResult pushed =
        run({"film.json", "in_0001.exr", "-o", "a.png", "--explain", "--var", "push=2.5"});
    EXPECT_NE(pushed.out.find("exposure = 2.5 ev"), std::string::npos);
    const CommandResult unknown = run({"film.json", "in_0001.exr", "-o", "a.png", "--var", "puhs=2"}, 2);
    EXPECT_NE(unknown.err.find("the look has no variable 'puhs'; did you mean 'push'?"), std::string::npos);
}

TEST_F(RenderOptions, LooksThatUseEachOtherAreRefused) {
    write_text(folder_ / "a.json", R"({ "aftershade": 1, "steps": [ { "use": "b.json" } ] })");
    write_text(folder_ / "b.json", R"({ "aftershade": 1, "steps": [ { "use": "a.json" } ] })");
    const CommandResult result = run({"a.json", "in_0001.exr", "-o", "a.png"}, 2);
    EXPECT_NE(result.err.find(
                  "b.json:1:40: error: 'a.json' uses itself: a.json uses b.json uses a.json (remove one of "
                  "these 'use')"),
              std::string::npos)
        << result.err;
}

TEST_F(RenderOptions, SubframesOfACaptureMakeOneFrame) {
    write_effect("average", R"("accumulates": "subframes",
        "textures": { "total": { "format": "rgba32f", "history": true, "doc": "Sum." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "total.prev"], "writes": ["total"] },
                    { "name": "show", "shader": "show.frag", "reads": ["total"], "writes": ["color"] } ])",
                 "void main() { ivec2 p = ivec2(gl_FragCoord.xy); out_total = texelFetch(color, p, 0) +\n"
                 "(frame.subframe > 0 ? texelFetch(total_prev, p, 0) : vec4(0.0)); }\n");
    write_text(folder_ / "effects/average/show.frag",
               kHead +
                   "void main() { out_color = texelFetch(total, ivec2(gl_FragCoord.xy), 0) / "
                   "float(frame.subframe_count); }\n");
    write_text(folder_ / "average.json", R"({ "aftershade": 1, "steps": [ { "effect": "average" } ] })");
    write_text(folder_ / "capture.json", R"({ "aftershade": 1, "frames": "in_####.exr", "subframes": 2 })");
    // Files 2 and 3 are frame 1, 4 and 5 frame 2; 1 and 6 are halves of frames that are not whole.
    const CommandResult result = run({"average.json", "capture.json", "-o", "out_####.exr"});
    EXPECT_EQ(result.out, "out_0001.exr\nout_0002.exr\n");
    const Image first = color("in_0004.exr"), second = color("in_0005.exr"), made = color("out_0002.exr");
    for (std::size_t i = 0; i < made.floats().size(); ++i)
        ASSERT_EQ(made.floats()[i], (first.floats()[i] + second.floats()[i]) / 2.0f) << i;
    run({"nothing.json", "capture.json", "--frames", "2", "-o", "centre.exr"});
    EXPECT_TRUE(same(color("centre.exr"), second)) << "without accumulation the middle stands for the frame";
}

TEST_F(RenderOptions, WordsThatMakeNoSenseAreAllListed) {
    const CommandResult result =
        run({"nothing.json", "in_0001.exr", "-o", "a.exr", "--scale", "0.3", "--region", "1,2,3", "--graph",
             "g.png", "--var", "x", "--keep-channels"},
            2);
    for (const char* fault :
         {"--scale 0.3: error: must be 1, 1/2, 1/3", "--region 1,2,3: error: must be x,y,w,h",
          "--graph g.png: error: must end in .dot or .svg", "--var x: error: expected name=value"})
        EXPECT_NE(result.err.find(fault), std::string::npos) << fault << "\n" << result.err;
}

}  // namespace
}  // namespace aftershade::test
