// Irradiance as the light that a surface reflects over its albedo.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "framework/capture/capture_writer.h"
#include "tests/capture/capture_files.h"
#include "tests/not_finite.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

using test::profile_of_roles;
using test::StoredChannel;

std::vector<StoredChannel> rgb_layer(const std::string& name, const std::vector<std::vector<float>>& pixels,
                                     PixelType type = PixelType::float32) {
    std::vector<StoredChannel> channels;
    for (std::size_t c = 0; c < 3; ++c) {
        channels.push_back({name.empty() ? std::string(1, "RGB"[c]) : name + "." + "RGB" [c], {}, type});
        for (const auto& pixel : pixels) channels.back().values.push_back(pixel[c]);
    }
    return channels;
}

std::vector<StoredChannel> in_one_file(std::vector<std::vector<StoredChannel>> layers) {
    std::vector<StoredChannel> all;
    for (auto& one : layers) all.insert(all.end(), one.begin(), one.end());
    return all;
}

const std::vector<Profile>& profiles_as_shipped() {
    static const std::vector<Profile> profiles = [] {
        Diagnostics diagnostics;
        return read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    }();
    return profiles;
}

const char* const kOverAlbedo =
    R"("albedo": {"channels": ["k.R", "k.G", "k.B"]},
       "irradiance": {"sum": [["d.R", "d.G", "d.B"], ["i.R", "i.G", "i.B"]], "times_albedo": true}})";

/// A capture of one row in a folder that it needs while it is read.
struct Read {
    explicit Read(const std::vector<StoredChannel>& channels, const std::string& profile = "t",
                  const std::string& roles = "", const std::string& channels_of_capture = "") {
        test::write_channels(folder / "f.exr", int(channels.front().values.size()), channels);
        sequence = test::sequence_of(folder / "f.exr", profile);
        if (!channels_of_capture.empty())
            sequence.channels = read_decodings(test::parsed(channels_of_capture));
        profiles = profiles_as_shipped();
        if (!roles.empty()) profiles.push_back(profile_of_roles(roles));
    }
    Capture read() const {
        const std::vector<std::string> roles = {"irradiance"};
        return CaptureReader(sequence, profiles, {}).read(1, roles);
    }
    std::vector<float> irradiance() const {
        const auto values = capture_values(read());
        return values;
    }
    static std::vector<float> capture_values(const Capture& capture) {
        const auto found = capture.images.find("irradiance");
        if (found == capture.images.end()) return {};
        return {found->second.floats().begin(), found->second.floats().end()};
    }
    test::TemporaryFolder folder;
    Sequence sequence;
    std::vector<Profile> profiles;
};

std::string over_albedo(const std::string& more = "") {
    std::string roles = kOverAlbedo;
    roles.pop_back();
    roles.insert(roles.rfind('}'), more);
    return roles;
}

void expect_values(const std::vector<float>& found, const std::vector<float>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-6f * std::abs(expected[i])) << i;
}

TEST(Irradiance, IsTheSumOfDiffuseLightOverTheAlbedoChannelByChannel) {
    const Read file(
        in_one_file({rgb_layer("", {{0, 0, 0}, {0, 0, 0}}), rgb_layer("d", {{0.3f, 0.2f, 0.1f}, {2, 0, 1}}),
                     rgb_layer("i", {{0.1f, 0.2f, 0.3f}, {0, 0.5f, 1}}),
                     rgb_layer("k", {{0.8f, 0.5f, 0.25f}, {1, 0.125f, 0.01f}})}),
        "t", over_albedo());
    const Capture capture = file.read();
    expect_values(Read::capture_values(capture), {0.5f, 0.8f, 1.6f, 2, 4, 200});
    EXPECT_EQ(capture.pixels_below_albedo_floor, 0u);
    EXPECT_TRUE(capture.header.warnings.empty());
}

TEST(Irradiance, CountsThePixelsWithLightWhoseAlbedoIsBelowTheFloorAndSaysSoOnce) {
    // Light on an albedo below the floor, none on a black one, light on one that is no number, and a sound
    // one.
    const auto channels =
        in_one_file({rgb_layer("", {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}),
                     rgb_layer("d", {{0.001f, 1, 1}, {0, 0, 0}, {3, 1, 1}, {1, 1, 1}}),
                     rgb_layer("i", {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}),
                     rgb_layer("k", {{0.005f, 1, 1}, {0, 0, 0}, {test::kNan, 1, 1}, {0.5f, 0.5f, 0.5f}})});
    const Capture capture = Read(channels, "t", over_albedo()).read();
    expect_values(Read::capture_values(capture), {0.1f, 1, 1, 0, 0, 0, 300, 1, 1, 2, 2, 2});
    EXPECT_EQ(capture.pixels_below_albedo_floor, 2u);
    ASSERT_EQ(capture.header.warnings.size(), 1u);
    EXPECT_EQ(capture.header.warnings.front(),
              "irradiance is less than the light over the albedo where the albedo is below 0.01 "
              "(\"albedo_floor\" next to the role's channels in capture.json)");
    const Capture lower = Read(channels, "t", over_albedo(R"(, "albedo_floor": 0.001)")).read();
    EXPECT_NEAR(Read::capture_values(lower)[0], 0.2f, 1e-6f);
    EXPECT_EQ(lower.pixels_below_albedo_floor, 1u);
}

TEST(Irradiance, IsMultipliedByItsScale) {
    const Read file(in_one_file({rgb_layer("", {{0, 0, 0}}), rgb_layer("g", {{0.3f, 0.6f, 0}})}), "t",
                    R"("irradiance": {"channels": ["g.R", "g.G", "g.B"], "scale": 0.25})");
    expect_values(file.irradiance(), {0.075f, 0.15f, 0});
}

TEST(Irradiance, WithoutAnAlbedoIsNotReadAndTheReasonIsKept) {
    const auto channels =
        in_one_file({rgb_layer("", {{0, 0, 0}}), rgb_layer("d", {{1, 1, 1}}), rgb_layer("i", {{1, 1, 1}})});
    const CaptureHeader header = Read(channels, "t", over_albedo()).read().header;
    EXPECT_EQ(std::ranges::find(header.roles, "irradiance"), header.roles.end());
    ASSERT_TRUE(header.half_there.contains("irradiance"));
    EXPECT_EQ(
        header.half_there.at("irradiance"),
        "irradiance is 'd.R', 'd.G', 'd.B', 'i.R', 'i.G' and 'i.B' over the albedo, and the profile 't' "
        "finds no albedo (render it too, or name its channels or its file as for any role)");
    // What capture.json asks for is an error instead.
    const Read asked(channels, "native", "",
                     R"({"irradiance": {"channels": ["d.R", "d.G", "d.B"], "times_albedo": true}})");
    EXPECT_NE(
        test::capture_error([&] { asked.read(); }).find("over the albedo, and the profile 'native' finds"),
        std::string::npos);
}

TEST(Irradiance, OfFilesOfItsOwnIsTheirSumOverTheAlbedo) {
    Read file(rgb_layer("", {{1, 1, 1}}), "luxcore");
    test::write_channels(file.folder / "direct.exr", 1, rgb_layer("", {{0.4f, 0.2f, 0.1f}}));
    test::write_channels(file.folder / "indirect.exr", 1, rgb_layer("", {{0.4f, 0, 0.1f}}));
    test::write_channels(file.folder / "albedo.exr", 1, rgb_layer("", {{0.8f, 0.4f, 0.05f}}));
    const auto name = [&](const char* role, const char* path) {
        file.sequence.role_files.insert_or_assign(role, FramePattern((file.folder / path).string()));
    };
    name("irradiance", "direct.exr");
    EXPECT_NE(test::capture_error([&] { file.read(); }).find("finds no albedo"), std::string::npos);
    name("albedo", "albedo.exr");
    expect_values(file.irradiance(), {0.5f, 0.5f, 2});
    name("aov:indirect_diffuse", "indirect.exr");
    expect_values(file.irradiance(), {1, 0.5f, 4});
}

struct ProducerCase {
    const char* profile;
    std::vector<std::string> light;  ///< layers that hold a half of the diffuse light each, or all of it
    std::string albedo;
    std::vector<std::string> ignored = {};  ///< layers that must not be added
};

TEST(Irradiance, IsFoundUnderTheNamesThatEachProducerWrites) {
    const std::vector<ProducerCase> cases = {
        {"arnold", {"diffuse_direct", "diffuse_indirect"}, "diffuse_albedo", {"diffuse"}},
        {"arnold", {"diffuse"}, "diffuse_albedo", {"diffuse_indirect", "direct"}},
        {"arnold", {"diffuse_direct"}, "diffuse_albedo"},
        {"karma", {"combineddiffuse"}, "albedo", {"directdiffuse", "indirectdiffuse"}},
        {"karma", {"directdiffuse", "indirectdiffuse"}, "basecolor"},
        {"karma", {"diffuse", "indirectdiffuse"}, "albedo"},
        {"karma", {"diffuse_direct", "diffuse_indirect"}, "diffuse_albedo", {"diffuse"}},
        {"renderman", {"directDiffuse", "indirectDiffuse"}, "albedo", {"subsurface"}},
        {"renderman", {"directDiffuseLobe", "indirectDiffuseLobe"}, "albedo"},
        {"moonray", {"diffuse_direct", "diffuse_indirect"}, "diffuse_albedo", {"diffuse"}},
        {"moonray", {"diffuse"}, "albedo"},
        {"unity", {"Direct Diffuse", "Indirect Diffuse"}, "Albedo"},
        {"unity", {"Direct Diffuse"}, "Albedo"}};
    const std::vector<std::vector<float>> truth = {{0.5f, 2, 40}, {0, 1, 0.25f}},
                                          albedo = {{0.8f, 0.55f, 0.03f}, {0.02f, 0.9f, 1}};
    for (const ProducerCase& c : cases) {
        std::vector<std::vector<float>> light = truth;
        for (std::size_t i = 0; i < light.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) light[i][k] *= albedo[i][k] / float(c.light.size());
        std::vector<std::vector<StoredChannel>> layers = {
            rgb_layer(std::string(c.profile) == "unity" ? "Beauty" : "", {{1, 1, 1}, {1, 1, 1}}),
            rgb_layer(c.albedo, albedo)};
        for (const std::string& name : c.light) layers.push_back(rgb_layer(name, light));
        for (const std::string& name : c.ignored) layers.push_back(rgb_layer(name, {{7, 7, 7}, {7, 7, 7}}));
        const std::string what = std::string(c.profile) + " " + c.light.front();
        SCOPED_TRACE(what);
        expect_values(Read(in_one_file(layers), c.profile).irradiance(), {0.5f, 2, 40, 0, 1, 0.25f});
    }
}

TEST(Irradiance, ThatAStepChangedIsWrittenBackAsTheLightThatIsReflected) {
    const Read file(
        in_one_file({rgb_layer("", {{0, 0, 0}}), rgb_layer("d", {{0.3f, 0.2f, 0.1f}}),
                     rgb_layer("i", {{0.1f, 0.2f, 0.3f}}), rgb_layer("k", {{0.8f, 0.5f, 0.005f}})}),
        "t", over_albedo(R"(, "scale": 2)"));
    Image changed(1, 1, 3);
    for (int c = 0; c < 3; ++c) changed.at(0, 0, c) = 3;
    const auto stored =
        CaptureReader(file.sequence, file.profiles, {}).read_stored_channels(1, {{"irradiance", &changed}});
    std::map<std::string, float> values;
    for (const auto& channel : stored) values[channel.name] = channel.image.floats()[0];
    // 3 / 2 times the albedo, the last one's floor.
    EXPECT_NEAR(values.at("d.R"), 1.2f, 1e-6f);
    EXPECT_NEAR(values.at("d.G"), 0.75f, 1e-6f);
    EXPECT_NEAR(values.at("d.B"), 0.015f, 1e-8f);
    EXPECT_EQ(values.at("i.R"), 0);
    EXPECT_NEAR(values.at("k.B"), 0.005f, 1e-8f);
}

TEST(Irradiance, IsReadAsTheFirstFrameSaysWhereALaterOneHasMoreChannels) {
    Read file(in_one_file({rgb_layer("", {{0, 0, 0}}), rgb_layer("diffuse", {{0.2f, 0.2f, 0.2f}}),
                           rgb_layer("diffuse_albedo", {{0.5f, 0.5f, 0.5f}})}),
              "arnold");
    std::filesystem::rename(file.folder / "f.exr", file.folder / "f_0001.exr");
    test::write_channels(
        file.folder / "f_0002.exr", 1,
        in_one_file({rgb_layer("", {{0, 0, 0}}), rgb_layer("diffuse", {{0.2f, 0.2f, 0.2f}}),
                     rgb_layer("diffuse_albedo", {{0.5f, 0.5f, 0.5f}}),
                     rgb_layer("diffuse_direct", {{9, 9, 9}}), rgb_layer("diffuse_indirect", {{9, 9, 9}})}));
    file.sequence.files = FramePattern((file.folder / "f_####.exr").string());
    file.sequence.frames = {1, 2};
    const CaptureReader reader(file.sequence, file.profiles, {});
    const std::vector<std::string> roles = {"irradiance"};
    expect_values(Read::capture_values(reader.read(2, roles)), {0.4f, 0.4f, 0.4f});
}

}  // namespace
}  // namespace aftershade
