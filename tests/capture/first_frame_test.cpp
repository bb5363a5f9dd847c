// A run is read as its first frame is: frames of other channels, layers, profiles and colour spaces.
#include <gtest/gtest.h>

#include "framework/image/role.h"
#include "tests/capture/capture_files.h"
#include "tests/capture/part_files.h"

namespace aftershade::test {
namespace {

using Names = std::vector<std::string>;
const std::vector<RoleId> kColorAndDepth = {"color", "depth"};

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
        sequence_.whole = files_;
        return {sequence_, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {}};
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
    const std::string message = error_of(ErrorKind::capture, [&] { color_of(3); });
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

TEST_F(FirstFrame, DecidesForAPartOfTheCaptureToo) {
    write(1, {"R", "G", "B"});
    write(2, {"R", "G", "B", "A"});
    sequence_.frames = {2};
    EXPECT_EQ(color_of(2), (Values{1, 2, 3, 1}));
    sequence_.frames = {2, 3};  // beyond what is there
    EXPECT_EQ(color_of(2), (Values{1, 2, 3, 1}));
}

TEST_F(FirstFrame, DecidesOnTheViewThatIsRead) {
    const auto views = [&](int number, const Names& names) {
        std::vector<TestPart> parts;
        for (const std::string& name : names)
            parts.push_back(
                {"rgba_" + name, name, {"R", "G", "B"}, kWholePart, name == "left" ? 1.0f : 2.0f});
        write_parts(folder_ / ("f" + std::to_string(number) + ".exr"), parts);
        files_.push_back(number);
    };
    views(1, {"left", "right"});
    views(2, {"right", "left"});
    views(3, {"right", "middle"});
    write(4, {"R", "G", "B"});
    EXPECT_FLOAT_EQ(color_of(2)[0], 1);
    EXPECT_EQ(differences_of_second()[0], "it has the views 'right' and 'left'; 'left' is read, as in 1");
    const std::string other = error_of(ErrorKind::capture, [&] { color_of(3); });
    EXPECT_NE(other.find("has no view 'left', which the first frame, "), std::string::npos) << other;
    EXPECT_NE(other.find("it has 'right' and 'middle' (choose"), std::string::npos) << other;
    const std::string none = error_of(ErrorKind::capture, [&] { color_of(4); });
    EXPECT_NE(none.find("is read in; it has none"), std::string::npos) << none;
    sequence_.view = "right";
    EXPECT_FLOAT_EQ(color_of(3)[0], 2);
}

TEST_F(FirstFrame, SaysWhereTheLightIsOfOtherChannels) {
    write(1, {"R", "G", "B"});
    write(2, {"Y"});
    EXPECT_EQ(color_of(2), (Values{1, 1, 1, 1}));
    EXPECT_EQ(differences_of_second(), (Names{"color is read from 'Y', in 1 from 'R', 'G' and 'B'"}));
}

/// A compositor's result beside the layer that it was made from, whose data are the picture's.
TEST_F(FirstFrame, DecidesOnChannelsThatTheFrameAloneWouldNotShow) {
    const Names result = {"Comp.Combined.R", "Comp.Combined.G", "Comp.Combined.B", "Comp.Combined.A"};
    Names with_data = result, with_two = result;
    for (const char* name :
         {"View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Combined.A", "View.Depth.Z"})
        with_data.push_back(name), with_two.push_back(name);
    for (const char* name : {"Zoo.Combined.R", "Zoo.Combined.G", "Zoo.Combined.B", "Zoo.Combined.A"})
        with_two.push_back(name);
    write(1, with_data);
    write(2, with_two);
    sequence_.profile = "blender";
    EXPECT_FLOAT_EQ(reader().read(2, kColorAndDepth).images.at("depth").at(0, 0, 0), 9);
    files_ = {2};
    EXPECT_FALSE(reader().read(2, kColorAndDepth).images.contains("depth")) << "of three layers by itself";
}

TEST_F(FirstFrame, DecidesForEachLayerOfACapture) {
    write(1, {"R", "G", "B", "A"});
    write(2, {"R", "G", "B", "A"});
    const auto plate = [&](int number, const Names& channels) {
        std::vector<StoredChannel> stored;
        for (const std::string& name : channels)
            stored.push_back({name, std::vector<float>(2, float(stored.size() + 1))});
        write_channels(folder_ / ("b" + std::to_string(number) + ".exr"), 2, stored);
    };
    const auto blender = [](const std::string& layer) {
        return Names{layer + ".Combined.R", layer + ".Combined.G", layer + ".Combined.B",
                     layer + ".Combined.A"};
    };
    plate(1, blender("Zeta"));
    Names both = blender("Beta");
    for (const std::string& name : blender("Zeta")) both.push_back(name);
    plate(2, both);
    sequence_.layers.resize(2);
    sequence_.layers[1].files = FramePattern((folder_ / "b%d.exr").string());
    const std::vector<RoleId> back = {"color", RoleId::of_layer(1, "color")};
    EXPECT_FLOAT_EQ(reader().read(2, back).images.at(RoleId::of_layer(1, "color")).at(0, 0, 0), 5);
    EXPECT_EQ(reader().read_header(2).differences,
              (Names{"layer 2: it has the layers 'Beta' and 'Zeta'; 'Zeta' is read, as in " +
                     (folder_ / "b1.exr").string()}));
    EXPECT_TRUE(reader().read_header(2).keeps_alpha);
}

TEST_F(FirstFrame, OfAnotherCaptureCanDecide) {
    write(1, {"R", "G", "B"});
    write(2, {"R", "G", "B", "A"});
    Diagnostics diagnostics;
    const auto profiles = read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    const Sequence first = sequence_of(folder_ / "f1.exr", "auto");
    const Sequence second = sequence_of(folder_ / "f2.exr", "auto");
    const CaptureReader one(first, profiles, {});
    CaptureReader other(second, profiles, {});
    other.hold_to_first_of(one);
    EXPECT_FLOAT_EQ(other.read(1, kColorAndDepth).images.at("color").at(0, 0, 3), 1);
}

TEST_F(FirstFrame, IsNoOtherForALookThatNamesObjects) {
    for (const int number : {1, 2})
        write(number,
              {"R", "G", "B", "A", "object_id.I", "CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B",
               "CryptoObject00.A"},
              {{"cryptomatte/1234567/name", std::string("CryptoObject")},
               {"cryptomatte/1234567/hash", std::string("MurmurHash3_32")},
               {"cryptomatte/1234567/conversion", std::string("uint32_to_float32")}});
    sequence_.object_names = {"Wheel"};
    const CaptureReader held = reader();
    EXPECT_FALSE(held.read_header(2).role_channels.contains("object_id")) << "of the Cryptomatte";
    const std::string before = held.decision(kColorAndDepth);
    EXPECT_EQ(held.read_header(2).differences, Names{});
    sequence_.object_names.clear();
    EXPECT_EQ(held.read_header(2).differences, Names{});
    EXPECT_EQ(reader().decision(kColorAndDepth), before);
}

TEST_F(FirstFrame, HasADecisionThatChangesWithWhatItDecides) {
    const Names four = {"R", "G", "B", "A"};
    write(1, four);
    EXPECT_EQ(reader().decision(kColorAndDepth), "") << "one frame decides nothing";
    write(2, {"R", "G", "B", "A"});
    const std::string before = reader().decision(kColorAndDepth);
    EXPECT_NE(before, "");
    const auto decision_with = [&](const Names& channels,
                                   const std::map<std::string, ExrValue>& attributes = {}) {
        write(1, channels, attributes);
        return reader().decision(kColorAndDepth);
    };
    EXPECT_EQ(decision_with(four, {{"comments", std::string("again")}}), before);
    EXPECT_EQ(decision_with({"R", "G", "B", "A", "normal.X", "normal.Y", "normal.Z"}), before)
        << "a role that is not read";
    EXPECT_NE(decision_with({"R", "G", "B"}), before);
    EXPECT_NE(decision_with({"R", "G", "B", "A", "Z"}), before);
    EXPECT_NE(decision_with({"Z.Combined.R", "Z.Combined.G", "Z.Combined.B", "Z.Combined.A"}), before);
    const std::vector<float> acescg = {.713f, .293f, .165f, .83f, .128f, .044f, .32168f, .33767f};
    EXPECT_NE(decision_with(four, {{"chromaticities", acescg}}), before);
    EXPECT_NE(decision_with(four, {{"nuke/version", std::string("14.0")}}), before);
}

}  // namespace
}  // namespace aftershade::test
