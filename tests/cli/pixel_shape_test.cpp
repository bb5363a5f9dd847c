// Runs over frames whose pixels are not square, some of whose steps work on square ones.
#include <gtest/gtest.h>

#include <cstring>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

class PixelShape : public BatchWork {
protected:
    PixelShape() {
        write_text(folder_ / "sharpen.json",
                   R"({ "aftershade": 1, "steps": [ { "effect": "sharpen", "params": { "radius": 2 } } ] })");
    }
    void write_frames(int last, float aspect) {
        SyntheticScene scene{
            .width = 101, .height = 71, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = 8};
        scene.box = SyntheticBox{40, 30, 16, 12, 5, 2};
        for (int frame = 1; frame <= last; ++frame) {
            const Image color = make_capture(scene, frame).images.at("color");
            std::vector<ExrOutputChannel> channels;
            for (int c = 0; c < 4; ++c)
                channels.push_back({std::string(1, "RGBA"[c]), PixelType::float32, &color, c});
            ExrWriteOptions options;
            options.data_window = {0, 0, 100, 70};
            options.display_window = {3, -2, 90, 60};
            options.pixel_aspect = aspect;
            write_exr(frame_path(frame), channels, options);
        }
    }
    void expect_same_pixels(const std::string& a, const std::string& b) const {
        const Image left = color(a), right = color(b);
        ASSERT_EQ(left.floats().size(), right.floats().size()) << a << ", " << b;
        EXPECT_EQ(std::memcmp(left.floats().data(), right.floats().data(), left.floats().size_bytes()), 0)
            << a << ", " << b;
    }
};

TEST_F(PixelShape, OfARegionIsThatOfTheWholeFrame) {
    for (const float aspect : {2.0f, 1.5f, 0.75f, 1.0926f}) {
        write_frames(1, aspect);
        const std::vector<std::string> line{"sharpen.json", "in_0001.exr", "-o"};
        auto region = line, whole = line;
        region.insert(region.end(), {"part.exr", "--region", "31,22,61,50"});
        whole.insert(whole.end(), {"whole.exr", "--region", "31,22,61,50", "--region-margin", "200"});
        const std::string note = run(region, 0).err;
        EXPECT_NE(note.find("note: step 'sharpen' works on "), std::string::npos) << note;
        EXPECT_EQ(run(whole, 0).err.find(note.substr(note.find("works on"), 16)), std::string::npos) << note;
        expect_same_pixels("part.exr", "whole.exr");
    }
}

TEST_F(PixelShape, IsSaidBeforeTheRunAndLeftAsItIsInTheFiles) {
    write_frames(1, 1.5f);
    const std::string explained = run({"sharpen.json", "in_0001.exr", "-o", "out.exr", "--explain"}, 0).out;
    EXPECT_NE(explained.find(
                  "step 'sharpen' works on 151 x 71 square pixels (the capture's pixel aspect is 1.5)\n"),
              std::string::npos)
        << explained;
    run({"sharpen.json", "in_0001.exr", "-o", "out.exr", "--tap", "sharpen.color=tap.exr"}, 0);
    expect_same_pixels("tap.exr", "out.exr");
    const ExrPart in = ExrFile(frame_path(1)).parts()[0], out = ExrFile(folder_ / "out.exr").parts()[0];
    EXPECT_EQ(out.data_window, in.data_window);
    EXPECT_EQ(out.display_window, in.display_window);
    EXPECT_EQ(out.pixel_aspect, 1.5f);
}

TEST_F(PixelShape, OfChunksThatHandHistoryOnIsThatOfOneRun) {
    write_frames(4, 1.5f);
    run({"trail.json", "in_####.exr", "-o", "one_####.exr"}, 0);
    run({"trail.json", "in_####.exr", "--frames", "1-2", "-o", "two_####.exr", "--history-out", "h"}, 0);
    run({"trail.json", "in_####.exr", "--frames", "3-4", "-o", "two_####.exr", "--history-in", "h"}, 0);
    for (const char* frame : {"0001", "0002", "0003", "0004"})
        expect_same_pixels(std::string("one_") + frame + ".exr", std::string("two_") + frame + ".exr");
}

TEST_F(PixelShape, IsRefusedWhereNoTextureIsAsWide) {
    write_frames(1, 3000);
    const std::string error =
        run({"sharpen.json", "in_0001.exr", "-o", "out.exr"}, int(ExitCode::capture)).err;
    EXPECT_NE(error.find("in_0001.exr: step 'sharpen' works on 303000 x 71 square pixels"), std::string::npos)
        << error;
    EXPECT_NE(error.find("a side may have at most "), std::string::npos) << error;
}

}  // namespace
}  // namespace aftershade::test
