// Sequences whose frames differ from the first one: in their layers, alpha, shape of pixels.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "framework/file/png_file.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

class MixedSequence : public BatchWork {
protected:
    /// The n-th channel of each frame holds n / 10.
    void write(int frame, const std::vector<std::string>& channels, float pixel_aspect = 1) {
        Image image(16, 9, int(channels.size()));
        for (std::size_t i = 0; i < image.floats().size(); ++i)
            image.floats()[i] = float(i % channels.size() + 1) / 10;
        std::vector<ExrOutputChannel> stored;
        for (std::size_t c = 0; c < channels.size(); ++c)
            stored.push_back({channels[c], PixelType::float32, &image, int(c)});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 15, 8};
        options.pixel_aspect = pixel_aspect;
        write_exr(frame_path(frame), stored, options);
    }
    static std::vector<std::string> layers(const std::vector<std::string>& names) {
        std::vector<std::string> channels;
        for (const std::string& name : names)
            for (const char* end : {".Combined.R", ".Combined.G", ".Combined.B", ".Combined.A"})
                channels.push_back(name + end);
        return channels;
    }
    float red(const std::string& name) const { return color(name).at(0, 0, 0); }
    static void expect_text(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
};

TEST_F(MixedSequence, IsReadFromTheFirstFramesLayerByWorkersAndChunksToo) {
    write(1, layers({"Zeta"}));
    write(2, layers({"Beta", "Zeta"}));
    write(3, layers({"Beta", "alpha", "Zeta"}));
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

TEST_F(MixedSequence, FailsInAFrameWithoutTheFirstFramesLayer) {
    write(1, layers({"Zeta"}));
    write(2, layers({"alpha"}));
    write(3, layers({"Zeta"}));
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

}  // namespace
}  // namespace aftershade::test
