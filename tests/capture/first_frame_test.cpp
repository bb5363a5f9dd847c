// A run is read as its first frame is: frames of other channels, layers, profiles and colour spaces.
#include <gtest/gtest.h>

#include "tests/capture/capture_files.h"

namespace aftershade::test {
namespace {

using Names = std::vector<std::string>;
const Names kColorAndDepth = {"color", "depth"};

class FirstFrame : public testing::Test {
protected:
    /// Frame `number`, whose channels hold 1, 2, 3 ... in the order given.
    void write(int number, const Names& channels, const std::map<std::string, ExrValue>& attributes = {}) {
        std::vector<StoredChannel> stored;
        for (const std::string& name : channels)
            stored.push_back({name, std::vector<float>(2, float(stored.size() + 1))});
        write_channels(folder_ / ("f" + std::to_string(number) + ".exr"), 2, stored, attributes);
        files_.push_back(number);
    }
    CaptureReader reader() {
        sequence_.files = FramePattern((folder_ / "f%d.exr").string());
        Diagnostics diagnostics;
        CaptureReader made(sequence_, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
        made.hold_to_first_of(files_);
        return made;
    }
    /// What the second frame's header says is otherwise, with "1" for the first frame's path.
    Names differences_of_second() {
        Names all = reader().read(2, kColorAndDepth).header.differences;
        const std::string path = (folder_ / "f1.exr").string();
        for (std::string& one : all)
            for (std::size_t at; (at = one.find(path)) != std::string::npos;)
                one.replace(at, path.size(), "1");
        return all;
    }
    std::vector<float> color_of(int number) {
        const Capture capture = reader().read(number, kColorAndDepth);
        const auto values = capture.images.at("color").floats();
        return {values.begin(), values.begin() + 4};
    }
    using Values = std::vector<float>;

    TemporaryFolder folder_;
    Sequence sequence_;
    std::vector<int> files_;
};

TEST_F(FirstFrame, DecidesNothingThatFramesHaveAlike) {
    for (int i = 1; i <= 3; ++i) write(i, {"R", "G", "B", "A", "Z"});
    EXPECT_EQ(differences_of_second(), Names{});
    EXPECT_EQ(reader().read_header(1).differences, Names{});
}

TEST_F(FirstFrame, DecidesWhichLayerIsRead) {
    const auto layer = [](const std::string& name) {
        return Names{name + ".Combined.R", name + ".Combined.G", name + ".Combined.B", name + ".Combined.A"};
    };
    const auto both = [&](const std::string& a, const std::string& b) {
        Names all = layer(a);
        const Names rest = layer(b);
        all.insert(all.end(), rest.begin(), rest.end());
        return all;
    };
    write(1, layer("Zeta"));
    write(2, both("Beta", "Zeta"));
    write(3, layer("alpha"));
    EXPECT_EQ(color_of(2), (Values{5, 6, 7, 8}));
    EXPECT_EQ(differences_of_second(),
              (Names{"it has the layers 'Beta' and 'Zeta'; 'Zeta' is read, as in 1"}));
    const std::string message = error_of(ExitCode::capture, [&] { color_of(3); });
    EXPECT_NE(message.find("has no layer 'Zeta'"), std::string::npos) << message;
    EXPECT_NE(message.find("it has 'alpha'"), std::string::npos) << message;
    sequence_.layer = "alpha";
    EXPECT_EQ(color_of(3), (Values{1, 2, 3, 4}));
}

TEST_F(FirstFrame, DecidesWhetherThereIsAnAlpha) {
    write(1, {"R", "G", "B", "A"});
    write(2, {"R", "G", "B"});
    EXPECT_EQ(color_of(2), (Values{1, 2, 3, 1}));
    EXPECT_EQ(differences_of_second(),
              (Names{"color is read from 'R', 'G' and 'B', in 1 from 'R', 'G', 'B' and 'A'; "
                     "its alpha is 1"}));
    EXPECT_TRUE(reader().read_header(2).keeps_alpha);
    files_ = {2, 1};
    EXPECT_EQ(color_of(1), (Values{1, 2, 3, 1})) << "an alpha that the first frame does not have";
    EXPECT_FALSE(reader().read_header(1).keeps_alpha);
}

TEST_F(FirstFrame, DecidesOnTheProfile) {
    write(1, {"R", "G", "B", "A", "Z"});
    write(2, {"R", "G", "B", "A", "depth.Z", "Z"}, {{"nuke/version", std::string("14.0")}});
    const CaptureHeader second = reader().read_header(2);
    EXPECT_EQ(second.profile, "native");
    EXPECT_EQ(second.role_channels.at("depth"), (Names{"Z"}));
    EXPECT_EQ(differences_of_second(),
              (Names{"it fits the profile 'nuke' (attribute nuke/version), and is read by 'native', as 1"}));
}

TEST_F(FirstFrame, DecidesOnTheColorSpaceThatOthersAreConvertedTo) {
    const std::vector<float> acescg = {.713f, .293f, .165f, .83f, .128f, .044f, .32168f, .33767f};
    write(1, {"R", "G", "B", "A"});
    write(2, {"R", "G", "B", "A"}, {{"chromaticities", acescg}});
    Chromaticities stored{};
    std::copy(acescg.begin(), acescg.end(), stored.begin());
    Image expected(1, 1, 4);
    for (int c = 0; c < 4; ++c) expected.at(0, 0, c) = float(c + 1);
    convert_colors(expected, conversion_matrix(stored, kRec709));
    const Values color = color_of(2);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(color[c], expected.floats()[c], 1e-5f);
    EXPECT_EQ(reader().read_header(2).primaries, kRec709);
    EXPECT_EQ(differences_of_second(),
              (Names{"its colours have other primaries than those of 1, and are converted to these"}));
}

TEST_F(FirstFrame, IsComparedInTheRolesThatAreRead) {
    write(1, {"R", "G", "B", "A", "Z"});
    write(2, {"R", "G", "B", "A", "normal.X", "normal.Y", "normal.Z"});
    EXPECT_EQ(differences_of_second(), (Names{"it has no depth, which 1 has"}));
}

TEST_F(FirstFrame, IsTheFirstThatCanBeRead) {
    files_ = {7};  // is not there
    write(1, {"R", "G", "B", "A", "Z"});
    write(2, {"R", "G", "B", "A"});
    EXPECT_EQ(differences_of_second(), (Names{"it has no depth, which 1 has"}));
}

}  // namespace
}  // namespace aftershade::test
