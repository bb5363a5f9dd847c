// Captures whose layers lie in several files, parts or layers of a file.
#include <gtest/gtest.h>

#include <algorithm>

#include "framework/image/role.h"
#include "tests/capture/capture_files.h"
#include "tests/capture/part_files.h"
#include "tests/not_finite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

class LayeredCapture : public testing::Test {
protected:
    /// Three pixels of a picture: their grey, alpha and depth.
    void write_plate(const std::string& name, std::vector<float> grey, std::vector<float> alpha,
                     std::vector<float> depth, std::vector<float> id = {}) {
        std::vector<StoredChannel> channels = {
            {"R", grey}, {"G", grey}, {"B", grey}, {"A", std::move(alpha)}, {"Z", std::move(depth)}};
        if (!id.empty()) channels.push_back({"object_id.I", std::move(id), PixelType::uint32});
        write_channels(folder_ / name, 3, channels);
    }
    Sequence sequence(const std::string& json) {
        write_text(folder_ / "capture.json", json);
        Diagnostics diagnostics;
        auto sequence = open_sequence((folder_ / "capture.json").string(), diagnostics);
        EXPECT_EQ(lines_of(diagnostics), Lines{});
        return sequence.value_or(Sequence{});
    }
    Capture read(const std::string& json, const std::vector<RoleId>& roles) {
        sequence_ = sequence(json);
        Diagnostics diagnostics;
        return CaptureReader(sequence_, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {})
            .read(1, roles);
    }
    static std::vector<float> first_channel(const Capture& capture, const RoleId& role) {
        const Image& image = capture.images.at(role);
        std::vector<float> values;
        for (int x = 0; x < image.width(); ++x) values.push_back(image.at(x, 0, 0));
        return values;
    }
    static float alpha(const Capture& capture, const RoleId& role, int x) {
        return capture.images.at(role).at(x, 0, 3);
    }
    TemporaryFolder folder_;
    Sequence sequence_;
};

constexpr const char* kPlates =
    R"({"aftershade": 1, "layers": [{"frames": "front.exr"}, {"frames": "back.exr"}]})";

TEST_F(LayeredCapture, PutsPlatesOverOneAnother) {
    write_plate("front.exr", {0.25f, 0.5f, 0}, {0.25f, 1, 0}, {2, 2, kInfinity}, {7, 7, 0});
    write_plate("back.exr", {0.5f, 0.125f, 0.75f}, {1, 1, 1}, {9, 8, 7}, {3, 4, 5});
    const Capture capture = read(kPlates, {"color", "depth", "object_id", RoleId::of_layer(0, "color"),
                                           RoleId::of_layer(1, "color"), RoleId::of_layer(1, "depth"),
                                           RoleId::of_layer(1, "object_id"), RoleId::of_layer(2, "color")});
    EXPECT_EQ(first_channel(capture, "color"), (std::vector<float>{0.25f + 0.75f * 0.5f, 0.5f, 0.75f}));
    EXPECT_EQ(first_channel(capture, "depth"),
              (std::vector<float>{9, 2, 7}));  // 0.75 of the first shows the back
    EXPECT_EQ(capture.images.at("object_id").uint_at(0, 0, 0), 3u);
    EXPECT_EQ(capture.images.at("object_id").uint_at(1, 0, 0), 7u);
    EXPECT_EQ(first_channel(capture, RoleId::of_layer(0, "color")), (std::vector<float>{0.25f, 0.5f, 0}));
    EXPECT_EQ(alpha(capture, RoleId::of_layer(0, "color"), 0), 0.25f);
    EXPECT_EQ(first_channel(capture, RoleId::of_layer(1, "depth")), (std::vector<float>{9, 8, 7}));
    EXPECT_EQ(capture.images.at(RoleId::of_layer(1, "object_id")).uint_at(1, 0, 0), 4u);
    EXPECT_FALSE(capture.images.contains(RoleId::of_layer(2, "color")));
    EXPECT_EQ(capture.header.layer_count, 2);
    EXPECT_EQ(capture.header.roles, (Names{"color", "depth", "object_id"}));
}

TEST_F(LayeredCapture, PutsWhatLiesBehindIntoTheLastLayerThatIsAskedFor) {
    write_plate("front.exr", {0.25f, 0, 0}, {0.5f, 0, 0}, {2, kInfinity, kInfinity});
    write_plate("middle.exr", {0.125f, 0.25f, 0}, {0.25f, 0.5f, 0}, {4, 4, kInfinity});
    write_plate("back.exr", {0.5f, 0.5f, 0.5f}, {1, 1, 1}, {9, 9, 9});
    const Capture capture =
        read(R"({"aftershade": 1, "layers": [{"frames": "front.exr"}, {"frames": "middle.exr"},
                                     {"frames": "back.exr"}]})",
             {"color", RoleId::of_layer(1, "color"), RoleId::of_layer(1, "depth")});
    EXPECT_EQ(first_channel(capture, RoleId::of_layer(1, "color")),
              (std::vector<float>{0.125f + 0.75f * 0.5f, 0.25f + 0.5f * 0.5f, 0.5f}));
    EXPECT_EQ(first_channel(capture, RoleId::of_layer(1, "depth")), (std::vector<float>{9, 4, 9}));
    EXPECT_EQ(first_channel(capture, "color")[0], 0.25f + 0.5f * 0.5f);
}

/// A renderer with a holdout leaves behind a front of alpha 0.75 a quarter of the wall, and nothing behind
/// one of 1.
TEST_F(LayeredCapture, FillsWhatAHoldoutCutOut) {
    write_plate("front.exr", {0.5f, 0.5f, 0}, {0.75f, 1, 0}, {2, 2, kInfinity});
    write_plate("back.exr", {0.125f, 0, 0.5f}, {0.25f, 0, 1}, {9, 9, 9});
    const Capture capture = read(R"({"aftershade": 1, "layers": [{"frames": "front.exr"},
                                     {"frames": "back.exr", "holdout": true}]})",
                                 {"color", RoleId::of_layer(1, "color")});
    EXPECT_EQ(first_channel(capture, "color"), (std::vector<float>{0.625f, 0.5f, 0.5f}));
    EXPECT_EQ(first_channel(capture, RoleId::of_layer(1, "color")), (std::vector<float>{0.5f, 0, 0.5f}));
    EXPECT_EQ(alpha(capture, RoleId::of_layer(1, "color"), 0), 1);
    EXPECT_EQ(alpha(capture, RoleId::of_layer(1, "color"), 1), 0);
}

TEST_F(LayeredCapture, TakesPartsOfOneFile) {
    write_parts(folder_ / "f.exr", {{"rgba", "", {"R", "G", "B", "A", "Z"}, kWholePart, 1},
                                    {"behind", "", {"R", "G", "B", "A", "Z"}, kWholePart, 3}});
    const Capture capture = read(
        R"({"aftershade": 1, "frames": "f.exr", "profile": "native", "layers": [{}, {"layer": "behind"}]})",
        {"color", "depth", RoleId::of_layer(1, "color"), RoleId::of_layer(1, "depth")});
    EXPECT_EQ(first_channel(capture, "color")[0], 1);
    EXPECT_EQ(first_channel(capture, RoleId::of_layer(1, "color"))[0], 3);
    EXPECT_NEAR(first_channel(capture, RoleId::of_layer(1, "depth"))[0], 3.4, 1e-6);
}

TEST_F(LayeredCapture, TakesBlendersViewLayers) {
    AFTERSHADE_REQUIRE_CAPTURE(file, "blender-versions/5.2.3/layers.exr");
    fs::create_symlink(fs::canonical(*file), folder_ / "f.exr");
    const Capture capture = read(
        R"({"aftershade": 1, "frames": "f.exr", "layers": [{"layer": "Near objects"}, {"layer": "Far"}]})",
        {"color", RoleId::of_layer(0, "color"), RoleId::of_layer(1, "color"), RoleId::of_layer(0, "depth"),
         RoleId::of_layer(1, "depth")});
    EXPECT_EQ(capture.header.profile, "blender");
    const auto flat = capture.images.at("color").floats();
    const auto front = capture.images.at(RoleId::of_layer(0, "color")).floats();
    const auto back = capture.images.at(RoleId::of_layer(1, "color")).floats();
    int different = 0;
    for (std::size_t i = 0; i < flat.size(); i += 4) {
        const float alpha = std::clamp(front[i + 3], 0.0f, 1.0f);
        for (std::size_t c = 0; c < 4; ++c)
            ASSERT_NEAR(flat[i + c], front[i + c] + (1 - alpha) * back[i + c], 1e-5) << i;
        different += front[i] != back[i];
    }
    EXPECT_GT(different, 10'000);
    EXPECT_FALSE(std::ranges::equal(capture.images.at(RoleId::of_layer(0, "depth")).floats(),
                                    capture.images.at(RoleId::of_layer(1, "depth")).floats()));
}

TEST_F(LayeredCapture, SaysWhichLayerDoesNotFit) {
    write_plate("front.exr", {1, 1, 1}, {1, 1, 1}, {2, 2, 2});
    write_channels(folder_ / "back.exr", 2, {{"R", {1, 1}}, {"G", {1, 1}}, {"B", {1, 1}}});
    const std::string size = capture_error([&] { (void)read(kPlates, {"color"}); });
    EXPECT_NE(size.find("back.exr: layer 2 has a display window of 2 x 1 px, but the first layer, "),
              std::string::npos)
        << size;
    write_channels(folder_ / "back.exr", 3, {{"Z", {1, 1, 1}}});
    const std::string color = capture_error([&] {
        (void)read(R"({"aftershade": 1, "profile": "native", "layers": [{"frames": "front.exr"},
                       {"frames": "back.exr"}]})",
                   {"color"});
    });
    EXPECT_NE(color.find("back.exr: layer 2 has no color"), std::string::npos) << color;
}

TEST_F(LayeredCapture, PlacesTheFaultsOfItsDocument) {
    write_text(folder_ / "capture.json", R"({"aftershade": 1,
  "layers": [{"frames": "front.exr"}, {"layer": "b", "depth": 1}, {"alpha": "none", "frames": "c.exr"}]})");
    Diagnostics diagnostics;
    (void)open_sequence((folder_ / "capture.json").string(), diagnostics);
    const Lines lines = lines_of(diagnostics);
    ASSERT_EQ(lines.size(), 3u);
    const std::string all = lines[0] + "\n" + lines[1] + "\n" + lines[2];
    EXPECT_NE(all.find("'frames'"), std::string::npos) << all;
    EXPECT_NE(all.find("no key 'depth'"), std::string::npos) << all;
    EXPECT_NE(all.find("must be 'keep' or 'opaque'"), std::string::npos) << all;
}

TEST_F(LayeredCapture, NamesEveryFileThatItReads) {
    write_plate("front.exr", {1, 1, 1}, {1, 1, 1}, {2, 2, 2});
    write_plate("back.exr", {1, 1, 1}, {1, 1, 1}, {2, 2, 2});
    std::vector<std::string> names;
    for (const fs::path& file : files_of_sequence(sequence(kPlates))) names.push_back(file.filename());
    EXPECT_EQ(names, (Names{"front.exr", "back.exr"}));
    fs::remove(folder_ / "back.exr");
    const Sequence gone = sequence(kPlates);
    EXPECT_FALSE(CaptureReader(gone, {}, {}).has_frame(1));
}

}  // namespace
}  // namespace aftershade::test
