// Deep files as captures: flat for whoever knows nothing of layers, and as layers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "framework/capture/capture.h"
#include "framework/image/role.h"
#include "tests/capture/capture_files.h"
#include "tests/file/deep_files.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

const std::vector<Profile>& profiles_of_deep() {
    static const std::vector<Profile> profiles = [] {
        Diagnostics diagnostics;
        return read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    }();
    return profiles;
}

Capture read_deep_capture(const fs::path& file, const Names& roles, int layers = kDefaultDeepLayers) {
    Sequence sequence;
    sequence.files = FramePattern(file.string());
    sequence.deep_layers = layers;
    return CaptureReader(sequence, profiles_of_deep(), {}).read(1, roles);
}

const Names kChannels = {"R", "G", "B", "A", "Z"};

/// A glass at 2 m before a wall at 10 m; beside it the wall alone, and nothing.
DeepImage glass_before_wall() {
    return deep_image(
        3, kChannels,
        {{{0.1f, 0.2f, 0.3f, 0.4f, 2}, {0.5f, 0.6f, 0.7f, 1, 10}}, {{0.5f, 0.6f, 0.7f, 1, 10}}, {}});
}

TEST(DeepCapture, IsAFlatPictureForWhoeverAsksForNoLayer) {
    const TemporaryFolder folder;
    write_deep(folder / "a.exr", glass_before_wall());
    const Capture capture = read_deep_capture(folder / "a.exr", {"color", "depth"});
    EXPECT_EQ(capture.header.roles, (Names{"color", "depth"}));
    EXPECT_EQ(capture.header.layer_count, 4);
    const Image& color = capture.images.at("color");
    EXPECT_NEAR(color.at(0, 0, 0), 0.1f + 0.6f * 0.5f, 1e-6);
    EXPECT_NEAR(color.at(0, 0, 3), 1, 1e-6);
    EXPECT_EQ(color.at(1, 0, 2), 0.7f);
    EXPECT_EQ(color.at(2, 0, 3), 0);
    const Image& depth = capture.images.at("depth");
    EXPECT_EQ(depth.at(0, 0, 0), 10);  // 0.6 of the pixel shows the wall
    EXPECT_EQ(depth.at(2, 0, 0), std::numeric_limits<float>::infinity());
}

TEST(DeepCapture, HasTheWallBehindTheGlassInItsSecondLayer) {
    const TemporaryFolder folder;
    write_deep(folder / "a.exr", glass_before_wall(), {2});
    const Names roles = {"color", layer_role(0, "color"), layer_role(0, "depth"), layer_role(1, "color"),
                         layer_role(1, "depth")};
    const Capture capture = read_deep_capture(folder / "a.exr", roles);
    EXPECT_EQ(capture.deep_layers, 2);  // as many as are asked for
    const auto value = [&](int layer, const char* role, int x, int channel) {
        return capture.images.at(layer_role(layer, role)).at(x, 0, channel);
    };
    EXPECT_EQ(value(0, "color", 0, 3), 0.4f);
    EXPECT_EQ(value(0, "depth", 0, 0), 2);
    EXPECT_EQ(value(1, "color", 0, 1), 0.6f);
    EXPECT_EQ(value(1, "depth", 0, 0), 10);
    EXPECT_EQ(value(0, "depth", 1, 0), 10);
    EXPECT_EQ(value(1, "color", 1, 3), 0);
    EXPECT_EQ(value(1, "depth", 1, 0), std::numeric_limits<float>::infinity());
    EXPECT_FALSE(capture.images.contains("depth"));
}

TEST(DeepCapture, PutsWhatLiesBehindIntoTheLastLayerThatIsAskedFor) {
    const TemporaryFolder folder;
    write_deep(
        folder / "a.exr",
        deep_image(1, kChannels, {{{0.1f, 0, 0, 0.5f, 1}, {0, 0.2f, 0, 0.5f, 20}, {0, 0, 0.3f, 1, 30}}}));
    const Capture capture = read_deep_capture(folder / "a.exr", {layer_role(1, "color")});
    const Image& back = capture.images.at(layer_role(1, "color"));
    EXPECT_EQ(back.at(0, 0, 1), 0.2f);
    EXPECT_NEAR(back.at(0, 0, 2), 0.5f * 0.3f, 1e-6);
    EXPECT_EQ(back.at(0, 0, 3), 1);
    const Capture one = read_deep_capture(folder / "a.exr", {layer_role(1, "color")}, 1);
    EXPECT_TRUE(one.images.empty());  // past what the capture has
}

TEST(DeepCapture, WithoutAlphaIsOpaqueWhereItHasSamples) {
    const TemporaryFolder folder;
    write_deep(folder / "a.exr", deep_image(2, {"R", "G", "B", "Z"}, {{{1, 1, 1, 4}, {2, 2, 2, 3}}, {}}));
    const Image color = read_deep_capture(folder / "a.exr", {"color"}).images.at("color");
    EXPECT_EQ(color.at(0, 0, 0), 2);
    EXPECT_EQ(color.at(0, 0, 3), 1);
    EXPECT_EQ(color.at(1, 0, 3), 0);
}

TEST(DeepCapture, PicksIdsAndVectorsOfWhatShowsMost) {
    const TemporaryFolder folder;
    DeepImage image =
        deep_image(1, {"R", "G", "B", "A", "Z", "ZBack", "velocity.X", "velocity.Y", "object_id.I"},
                   {{{0.1f, 0, 0, 0.25f, 2, 4, 8, 0, 7}, {0, 0.2f, 0, 1, 9, 9, -4, 2, 3}}});
    DeepImage::Channel& ids = image.channels.back();
    ids.uints = {(1u << 30) + 7, 3};
    ids.floats.clear();
    write_deep(folder / "a.exr", image);
    const Capture capture = read_deep_capture(
        folder / "a.exr", {"velocity", "object_id", layer_role(0, "velocity"), layer_role(0, "object_id"),
                           layer_role(0, "depth"), layer_role(1, "object_id")});
    EXPECT_EQ(capture.images.at("velocity").at(0, 0, 0), -4);
    EXPECT_EQ(capture.images.at("object_id").uint_at(0, 0, 0), 3u);
    EXPECT_EQ(capture.images.at(layer_role(0, "velocity")).at(0, 0, 0), 8);
    EXPECT_EQ(capture.images.at(layer_role(0, "object_id")).uint_at(0, 0, 0), (1u << 30) + 7);
    EXPECT_EQ(capture.images.at(layer_role(0, "depth")).at(0, 0, 0), 3);  // the middle of a volume
}

TEST(DeepCapture, WithoutDepthSaysThatItHasNoOrder) {
    const TemporaryFolder folder;
    write_deep(folder / "a.exr", deep_image(1, {"R", "G", "B"}, {{{1, 1, 1}}}));
    const std::string message = capture_error([&] { (void)read_deep_capture(folder / "a.exr", {"color"}); });
    EXPECT_NE(message.find("its deep part has no channel Z, by which samples are put in order"),
              std::string::npos)
        << message;
}

/// OpenImageIO's picture of the deep samples: an uncompressed TIFF ends with its pixels.
std::vector<float> flattened_by_oiiotool(const fs::path& deep, const fs::path& raw) {
    const std::string command =
        "oiiotool --noautocrop '" + deep.string() +
        "' --flatten --ch R,G,B,A --eraseattrib '.*' -d float --scanline --compression none "
        "-o '" +
        raw.string() + "' >/dev/null";
    if (std::system(command.c_str()) != 0) return {};
    const std::string bytes = read_text(raw);
    const Window window = ExrFile(deep).parts()[0].data_window;
    std::vector<float> pixels(std::size_t(window.width()) * std::size_t(window.height()) * 4);
    if (bytes.size() < pixels.size() * 4) return {};
    std::memcpy(pixels.data(), bytes.data() + bytes.size() - pixels.size() * 4, pixels.size() * 4);
    return pixels;
}

class DeepFileOfAProducer : public testing::TestWithParam<const char*> {};

TEST_P(DeepFileOfAProducer, IsFlattenedAsOpenImageIoDoes) {
    AFTERSHADE_REQUIRE_CAPTURE(file, GetParam());
    if (std::system("oiiotool --help >/dev/null 2>&1") != 0) GTEST_SKIP() << "SKIPPED: no oiiotool";
    const TemporaryFolder folder;
    const std::vector<float> expected = flattened_by_oiiotool(*file, folder / "flat.tif");
    for (const Names& roles : {Names{"color"}, Names{"color", layer_role(3, "color")}}) {
        const Capture capture = read_deep_capture(*file, roles);
        const auto color = capture.images.at("color").floats();
        ASSERT_EQ(color.size(), expected.size());
        double worst = 0, sum = 0;
        for (std::size_t i = 0; i < color.size(); ++i) {
            worst = std::max(worst, std::abs(double(color[i]) - double(expected[i])));
            sum += double(color[i]);
        }
        EXPECT_LT(worst, 1e-4);
        EXPECT_GT(sum, 100);
        ASSERT_TRUE(capture.deep);
        EXPECT_GT(capture.deep->most_samples, 1u);
    }
}
INSTANTIATE_TEST_SUITE_P(Real, DeepFileOfAProducer,
                         testing::Values("producers/arnold/arnold75_deep.exr",
                                         "exr-suite/v2/LowResLeftView/Trunks.exr"),
                         [](const auto& row) { return row.index == 0 ? "Arnold" : "Trunks"; });

}  // namespace
}  // namespace aftershade::test
