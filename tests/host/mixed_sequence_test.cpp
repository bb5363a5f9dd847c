// Sequences of the API whose frames differ from the first one.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "aftershade/host.h"
#include "framework/image/color_space.h"
#include "tests/host/host_setup.h"
#include "tests/mixed_frames.h"
#include "tests/temporary_folder.h"

namespace {

using namespace aftershade::host;
using namespace aftershade::test;
using Names = std::vector<std::string>;

constexpr const char* kNothing = R"({"aftershade": 1, "steps": []})";

class HostMixedSequence : public testing::Test {
protected:
    void write(int frame, const Names& channels,
               const std::map<std::string, aftershade::ExrValue>& attributes = {}) {
        write_tenths(path(frame), channels, attributes);
    }
    std::filesystem::path path(int frame) const {
        return folder_ / ("in_000" + std::to_string(frame) + ".exr");
    }
    Sequence sequence() const { return Sequence::open(host_, folder_ / "in_####.exr"); }
    static std::vector<float> first_pixel(const Image& image) {
        const std::span<const float> values = image.floats().first(4);
        return {values.begin(), values.end()};
    }
    /// Of the frame that is read, and of the one that a session renders.
    void expect_color(int frame, const std::vector<float>& expected, const std::string& note) {
        const Sequence all = sequence();
        const Capture capture = all.read(frame);
        Look look = host_.parse_look(kNothing);
        Session session = look.session();
        const Result result = session.render(all, frame, {.roles = {"color"}});
        EXPECT_EQ(first_pixel(result.image("color")), first_pixel(capture.image("color")));
        for (std::size_t c = 0; c < 4; ++c)
            EXPECT_NEAR(first_pixel(capture.image("color"))[c], expected[c], 1e-5f) << c;
        for (const Names& notes : {capture.notes(), result.notes()})
            EXPECT_EQ(
                std::ranges::count_if(notes, [&](const std::string& one) { return one.starts_with(note); }),
                1)
                << testing::PrintToString(notes);
    }
    TemporaryFolder folder_;
    Host host_{on_software()};
};

TEST_F(HostMixedSequence, IsReadFromTheFirstFramesLayer) {
    write(1, view_layers({"Zeta"}));
    write(2, view_layers({"Beta", "Zeta"}));
    write(3, view_layers({"alpha"}));
    expect_color(2, {0.5f, 0.6f, 0.7f, 0.8f}, "it has the layers 'Beta' and 'Zeta'; 'Zeta' is read, as in ");
    try {
        sequence().read(3);
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        EXPECT_NE(std::string(error.what()).find("has no layer 'Zeta'"), std::string::npos) << error.what();
    }
    const Capture alone = Capture::read(host_, path(2));
    EXPECT_EQ(first_pixel(alone.image("color"))[0], 0.1f) << "a file by itself";
}

TEST_F(HostMixedSequence, HasAnAlphaWhereTheFirstFrameHas) {
    write(1, {"R", "G", "B"});
    write(2, {"R", "G", "B", "A"});
    expect_color(2, {0.1f, 0.2f, 0.3f, 1}, "color is read from 'R', 'G' and 'B', as in ");
}

TEST_F(HostMixedSequence, HasTheColorSpaceOfTheFirstFrame) {
    write(1, {"R", "G", "B", "A"});
    write(2, {"R", "G", "B", "A"}, {{"chromaticities", kAcescgPrimaries}});
    aftershade::Chromaticities stored{};
    std::ranges::copy(kAcescgPrimaries, stored.begin());
    aftershade::Image expected(1, 1, 4);
    for (int c = 0; c < 4; ++c) expected.at(0, 0, c) = float(c + 1) / 10;
    convert_colors(expected, aftershade::conversion_matrix(stored, aftershade::kRec709));
    const auto values = expected.floats();
    expect_color(2, {values.begin(), values.end()}, "its colours have other primaries than those of ");
    EXPECT_EQ(sequence().read(2).color_space(), "rec709");
}

TEST_F(HostMixedSequence, IsAsTheProgramRunsIt) {
    write(1, {"R", "G", "B", "A", "Z"});
    write(2, {"R", "G", "B", "A", "depth.Z", "Z"}, {{"nuke/version", std::string("14.0")}});
    write_file(folder_ / "look.json", kNothing);
    ASSERT_EQ(std::system(("\"" AFTERSHADE_EXECUTABLE "\" run " + (folder_ / "look.json").string() + " " +
                           (folder_ / "in_####.exr").string() + " -o " + (folder_ / "out_####.exr").string() +
                           " --frames 2 --output-roles color,depth --backend software --progress none")
                              .c_str()),
              0);
    const aftershade::ExrFile ran(folder_ / "out_0002.exr");
    const Capture capture = sequence().read(2);
    EXPECT_EQ(capture.profile(), "native");
    EXPECT_EQ(capture.image("depth").floats()[0], 0.6f);
    EXPECT_EQ(ran.read_floats(0, Names{"Z"}).floats()[0], 0.6f);
}

}  // namespace
