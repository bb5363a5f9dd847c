// Deep files as captures: flat for whoever knows nothing of layers, and as layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "framework/capture/capture.h"
#include "framework/image/role.h"
#include "tests/capture/capture_files.h"
#include "tests/capture/deep_twin.h"
#include "tests/file/deep_files.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;
using Roles = std::vector<RoleId>;

const std::vector<Profile>& profiles_of_deep() {
    static const std::vector<Profile> profiles = [] {
        Diagnostics diagnostics;
        return read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    }();
    return profiles;
}

Capture read_deep_capture(const fs::path& file, const Roles& roles, int layers = kDefaultDeepLayers) {
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
    const Roles roles = {"color", RoleId::of_layer(0, "color"), RoleId::of_layer(0, "depth"),
                         RoleId::of_layer(1, "color"), RoleId::of_layer(1, "depth")};
    const Capture capture = read_deep_capture(folder / "a.exr", roles);
    EXPECT_EQ(capture.deep_layers, 2);  // as many as are asked for
    const auto value = [&](int layer, const char* role, int x, int channel) {
        return capture.images.at(RoleId::of_layer(layer, role)).at(x, 0, channel);
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
    const Capture capture = read_deep_capture(folder / "a.exr", {RoleId::of_layer(1, "color")});
    const Image& back = capture.images.at(RoleId::of_layer(1, "color"));
    EXPECT_EQ(back.at(0, 0, 1), 0.2f);
    EXPECT_NEAR(back.at(0, 0, 2), 0.5f * 0.3f, 1e-6);
    EXPECT_EQ(back.at(0, 0, 3), 1);
    const Capture one = read_deep_capture(folder / "a.exr", {RoleId::of_layer(1, "color")}, 1);
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

/// Frames of one sequence, deep and flat in turn, read by the first.
TEST(DeepCapture, AmongFlatFramesIsReadAsTheyAreAndSaysIt) {
    const Names roles = {"color", "depth", "layer0:color", "layer1:color"};
    for (const bool begins_deep : {false, true}) {
        const TemporaryFolder folder;
        const auto path = [&](int frame) { return folder / (std::to_string(frame) + ".exr"); };
        write_deep(path(begins_deep ? 1 : 2), glass_before_wall());
        std::vector<StoredChannel> flat;
        for (const std::string& name : kChannels) flat.push_back({name, {0.5f, 1, 2}});
        write_channels(path(begins_deep ? 2 : 1), 3, flat);
        Sequence sequence;
        sequence.files = FramePattern((folder / "%d.exr").string());
        sequence.frames = sequence.whole = {1, 2};
        const CaptureReader reader(sequence, profiles_of_deep(), {});
        const Capture second = reader.read(2, roles);
        ASSERT_EQ(second.header.differences.size(), 1u) << begins_deep;
        EXPECT_EQ(second.header.differences[0],
                  begins_deep
                      ? "it is flat and " + path(1).string() + " is deep: it has no layers behind its picture"
                      : "it is deep and " + path(1).string() +
                            " is flat: its samples are read as one flat picture");
        EXPECT_EQ(second.header.layer_count, 1);
        EXPECT_FALSE(second.images.contains("layer1:color"));
        const Capture first = reader.read(1, roles);
        EXPECT_EQ(first.images.contains("layer1:color"), begins_deep);
        EXPECT_EQ(first.header.differences, Names{});
        if (!begins_deep) {
            EXPECT_NEAR(second.images.at("color").at(0, 0, 0), 0.1f + 0.6f * 0.5f, 1e-6);
            EXPECT_EQ(second.images.at("depth").at(0, 0, 0), 10);
        }
    }
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
    const Capture capture =
        read_deep_capture(folder / "a.exr", {"velocity", "object_id", RoleId::of_layer(0, "velocity"),
                                             RoleId::of_layer(0, "object_id"), RoleId::of_layer(0, "depth"),
                                             RoleId::of_layer(1, "object_id")});
    EXPECT_EQ(capture.images.at("velocity").at(0, 0, 0), -4);
    EXPECT_EQ(capture.images.at("object_id").uint_at(0, 0, 0), 3u);
    EXPECT_EQ(capture.images.at(RoleId::of_layer(0, "velocity")).at(0, 0, 0), 8);
    EXPECT_EQ(capture.images.at(RoleId::of_layer(0, "object_id")).uint_at(0, 0, 0), (1u << 30) + 7);
    EXPECT_EQ(capture.images.at(RoleId::of_layer(0, "depth")).at(0, 0, 0), 3);  // the middle of a volume
}

TEST(DeepCapture, IsPutInOrderByItsDepthInAnySpelling) {
    for (const Names& spelled : {Names{"R", "G", "B", "alpha", "z"}, Names{"R", "G", "B", "A", "depth.z"}}) {
        const TemporaryFolder folder;
        DeepImage image = glass_before_wall();
        for (std::size_t c = 0; c < spelled.size(); ++c) image.channels[c].name = spelled[c];
        write_deep(folder / "a.exr", image);
        const Capture capture = read_deep_capture(folder / "a.exr", {"color"});
        EXPECT_NEAR(capture.images.at("color").at(0, 0, 0), 0.1f + 0.6f * 0.5f, 1e-6) << spelled.back();
    }
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

/// The samples of each pixel, with the values of one channel.
std::vector<std::vector<OneSample>> samples_of(const fs::path& path, const std::string& channel) {
    const ExrFile file(path);
    const auto has_back = std::ranges::any_of(file.parts()[0].channels,
                                              [](const ExrChannel& one) { return one.name == "ZBack"; });
    Names names = {"A", "Z", channel};
    if (has_back) names.emplace_back("ZBack");
    const DeepImage image = file.read_deep(0, names);
    std::vector<std::vector<OneSample>> pixels(image.pixel_count());
    for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel)
        for (std::uint32_t i = image.first[pixel]; i < image.first[pixel + 1]; ++i) {
            const auto value = [&](const char* name) { return double(image.find(name)->floats[i]); };
            pixels[pixel].push_back(
                {value("Z"), has_back ? value("ZBack") : value("Z"), value("A"), value(channel.c_str())});
        }
    return pixels;
}

class DeepFileOfAProducer : public testing::TestWithParam<const char*> {};

TEST_P(DeepFileOfAProducer, IsFlattenedAsOpenExrsDocumentSays) {
    AFTERSHADE_REQUIRE_CAPTURE(file, GetParam());
    const auto pixels = samples_of(*file, "G");
    for (const Roles& roles : {Roles{"color"}, Roles{"color", RoleId::of_layer(3, "color")}}) {
        const Capture capture = read_deep_capture(*file, roles);
        const auto color = capture.images.at("color").floats();
        ASSERT_EQ(color.size(), 4 * pixels.size());
        double worst = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            double alpha = 0;
            const double value = Kainz::value_in_front(pixels[i], alpha);
            worst = std::max({worst, std::abs(double(color[4 * i + 1]) - value),
                              std::abs(double(color[4 * i + 3]) - alpha)});
        }
        EXPECT_LT(worst, 2e-6);
    }
}

/// Which merges no samples that overlap or lie at one depth: pixels that have such are held against the
/// document alone.
TEST_P(DeepFileOfAProducer, IsFlattenedAsOpenImageIoDoesWhereNothingOverlaps) {
    AFTERSHADE_REQUIRE_CAPTURE(file, GetParam());
    if (std::system("oiiotool --help >/dev/null 2>&1") != 0) GTEST_SKIP() << "SKIPPED: no oiiotool";
    const TemporaryFolder folder;
    const std::vector<float> expected = flattened_by_oiiotool(*file, folder / "flat.tif");
    std::vector<bool> overlaps;
    for (std::vector<OneSample>& pixel : samples_of(*file, "G")) {
        std::ranges::sort(pixel, {}, &OneSample::front);
        overlaps.push_back(false);
        for (std::size_t i = 1; i < pixel.size(); ++i)
            if (pixel[i].front <= std::max(pixel[i - 1].front, pixel[i - 1].back)) overlaps.back() = true;
    }
    EXPECT_LT(std::ranges::count(overlaps, true), std::ptrdiff_t(overlaps.size() / 2));
    for (const Roles& roles : {Roles{"color"}, Roles{"color", RoleId::of_layer(3, "color")}}) {
        const Capture capture = read_deep_capture(*file, roles);
        const auto color = capture.images.at("color").floats();
        ASSERT_EQ(color.size(), expected.size());
        double worst = 0, sum = 0;
        for (std::size_t i = 0; i < color.size(); ++i) {
            if (overlaps[i / 4]) continue;
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
