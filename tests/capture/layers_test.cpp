// Which channels the roles of a file with layers are taken from: files of the shapes that producers write.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <initializer_list>

#include "tests/capture/capture_files.h"
#include "tests/capture/part_files.h"

namespace aftershade::test {
namespace {

const std::vector<Profile>& shipped_profiles() {
    static const std::vector<Profile> profiles = [] {
        Diagnostics diagnostics;
        return read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    }();
    return profiles;
}

using Attributes = std::map<std::string, ExrValue>;
const Attributes kBlender = {{"BlenderMultiChannel", std::string("Blender V2.55.1 and newer")}};

/// A file of one pixel row whose channels hold 1, 2, 3 ... in the order given.
class LayeredFile : public testing::Test {
protected:
    void write(const std::vector<std::string>& channels, const Attributes& attributes = {}) {
        std::vector<StoredChannel> stored;
        for (const std::string& name : channels)
            stored.push_back({name, std::vector<float>(2, float(stored.size() + 1))});
        write_channels(path(), 2, stored, attributes);
    }
    std::filesystem::path path() const { return folder_ / "f.exr"; }
    CaptureReader reader() {
        sequence_.files = FramePattern(path().string());
        return CaptureReader(sequence_, shipped_profiles(), {});
    }
    CaptureHeader header() { return reader().read_header(1); }
    Image image(const std::string& role) {
        return reader().read(1, std::vector<std::string>{role}).images.at(role);
    }
    std::vector<std::string> channels_of(const std::string& role) {
        const CaptureHeader found = header();
        const auto channels = found.role_channels.find(role);
        return channels == found.role_channels.end() ? std::vector<std::string>{} : channels->second;
    }
    using Names = std::vector<std::string>;

    TemporaryFolder folder_;
    Sequence sequence_;
};

std::vector<std::string> below(const std::string& layer, std::initializer_list<const char*> passes) {
    std::vector<std::string> names;
    for (const char* pass : passes) names.push_back(layer + "." + pass);
    return names;
}

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

constexpr auto kShortPasses = {"Combined.R", "Combined.G", "Combined.B", "Combined.A", "Depth.Z",
                               "DiffDir.R",  "DiffDir.G",  "DiffDir.B",  "DiffInd.R",  "DiffInd.G",
                               "DiffInd.B",  "DiffCol.R",  "DiffCol.G",  "DiffCol.B",  "Emit.R",
                               "Emit.G",     "Emit.B",     "IndexOB.X"};

TEST_F(LayeredFile, OfBlender5HasAPartAndAFullNameForEachPass) {
    const auto part = [](const std::string& pass, const std::string& components, float value) {
        TestPart made{"ViewLayer." + pass, "", {}, kWholePart, value};
        for (const char c : components) made.channels.push_back(made.name + "." + c);
        return made;
    };
    std::vector<TestPart> parts = {part("Combined", "ABGR", 1),        part("Depth", "Z", 2),
                                   part("Object Index", "X", 3),       part("Diffuse Direct", "BGR", 4),
                                   part("Diffuse Indirect", "BGR", 5), part("Diffuse Color", "BGR", 6),
                                   part("Glossy Direct", "BGR", 7),    part("Emission", "BGR", 8)};
    parts[0].texts["BlenderMultiChannel"] = "Blender V2.55.1 and newer";
    write_parts(path(), parts);
    const CaptureHeader found = header();
    EXPECT_EQ(found.profile, "blender");
    EXPECT_EQ(found.roles, (Names{"albedo", "color", "depth", "emission", "irradiance", "object_id"}));
    EXPECT_EQ(channels_of("albedo"),
              below("ViewLayer", {"Diffuse Color.R", "Diffuse Color.G", "Diffuse Color.B"}));
    // Red is the third channel of its part: 4.2 direct and 5.2 indirect.
    EXPECT_FLOAT_EQ(image("irradiance").at(0, 0, 0), 4.2f + 5.2f);
    EXPECT_EQ(image("object_id").uint_at(0, 0, 0), 3u);
}

TEST_F(LayeredFile, HasItsFirstLayerReadAndSaysSo) {
    write(below("Far", kShortPasses) + below("Near objects", kShortPasses), kBlender);
    const CaptureHeader found = header();
    EXPECT_EQ(found.layer, "Far");
    EXPECT_EQ(found.layers, (Names{"Far", "Near objects"}));
    ASSERT_EQ(found.notes.size(), 1u);
    EXPECT_EQ(
        found.notes[0],
        "the file has the layers 'Far' and 'Near objects'; 'Far' is read (choose with layer, or 'layer' "
        "in capture.json)");
}

TEST_F(LayeredFile, HasEveryRoleOfTheLayerThatWasChosen) {
    write(below("Far", kShortPasses) + below("Near objects", kShortPasses), kBlender);
    sequence_.layer = "Near objects";
    const CaptureHeader found = header();
    EXPECT_EQ(found.notes, Names{});
    for (const auto& [role, channels] : found.role_channels)
        for (const std::string& channel : channels)
            EXPECT_TRUE(channel.starts_with("Near objects.")) << role << " " << channel;
    sequence_.layer = "Near";
    const std::string message = error_of(ErrorKind::usage, [&] { header(); });
    EXPECT_NE(message.find("has no layer 'Near'; did you mean"), std::string::npos) << message;
    EXPECT_NE(message.find("it has 'Far' and 'Near objects'"), std::string::npos) << message;
}

TEST_F(LayeredFile, HasTheCryptomatteOfTheLayerThatWasChosen) {
    Attributes attributes = kBlender;
    Names channels;
    for (const std::string layer : {"Far", "Near"}) {
        attributes["cryptomatte/" + layer + "/name"] = layer + ".CryptoObject";
        channels = channels + below(layer, {"Combined.R", "Combined.G", "Combined.B", "CryptoObject00.r",
                                            "CryptoObject00.g", "CryptoObject00.b", "CryptoObject00.a"});
    }
    write(channels, attributes);
    EXPECT_EQ(reader().cryptomatte_name(1, "CryptoObject"), "Far.CryptoObject");
    sequence_.layer = "Near";
    EXPECT_EQ(reader().cryptomatte_name(1, "CryptoObject"), "Near.CryptoObject");
    EXPECT_EQ(reader().cryptomatte_name(1, ""), "Near.CryptoObject");
}

TEST_F(LayeredFile, LacksWhatItsLayerLacksAlthoughAnotherHasIt) {
    write(below("A", {"Combined.R", "Combined.G", "Combined.B", "Depth.Z"}) + below("B", kShortPasses),
          kBlender);
    EXPECT_EQ(header().roles, (Names{"color", "depth"}));
}

TEST_F(LayeredFile, OfACompositorHasItsColourAndTheDataOfTheOtherLayer) {
    write(below("Composite", {"Combined.R", "Combined.G", "Combined.B", "Combined.A"}) +
              below("ViewLayer", kShortPasses),
          kBlender);
    const CaptureHeader found = header();
    EXPECT_EQ(found.role_channels.at("color")[0], "Composite.Combined.R");
    EXPECT_EQ(found.role_channels.at("depth")[0], "ViewLayer.Depth.Z");
    ASSERT_EQ(found.notes.size(), 1u);
    EXPECT_NE(found.notes[0].find("are read from the layer 'ViewLayer'"), std::string::npos)
        << found.notes[0];
}

TEST_F(LayeredFile, OfAFileOutputNodeHasRolesByTheNamesOfItsSockets) {
    write({"Depth.V", "Image.A", "Image.B", "Image.G", "Image.R", "Normal.X", "Normal.Y", "Normal.Z",
           "Vector.W", "Vector.X", "Vector.Y", "Vector.Z"},
          kBlender);
    EXPECT_EQ(header().roles, (Names{"color", "depth", "normal", "velocity", "velocity_next"}));
    EXPECT_EQ(channels_of("color"), (Names{"Image.R", "Image.G", "Image.B", "Image.A"}));
    EXPECT_EQ(channels_of("depth"), Names{"Depth.V"});
}

TEST_F(LayeredFile, HasAPlainColourUnderEveryProfile) {
    for (const Profile& profile : shipped_profiles()) {
        sequence_.profile = profile.id;
        for (const Names& names : {Names{"A", "B", "G", "R"}, Names{"b", "g", "r"},
                                   Names{"Layer 1.B", "Layer 1.G", "Layer 1.R"}}) {
            write(names);
            const Image color = image("color");
            // Blue is the first that was written but for alpha.
            const float blue = names.size() == 4 ? 2.0f : 1.0f;
            EXPECT_FLOAT_EQ(color.at(0, 0, 2), blue) << profile.id << " " << names.back();
            EXPECT_FLOAT_EQ(color.at(0, 0, 0), blue + 2) << profile.id << " " << names.back();
            EXPECT_FLOAT_EQ(color.at(0, 0, 3), 1) << profile.id << " " << names.back();
        }
        write({"Y"});
        EXPECT_EQ(channels_of("color"), Names{"Y"}) << profile.id;
    }
}

TEST_F(LayeredFile, HasNoColourOfDataOrOfACryptomattesPreview) {
    write({"N.B", "N.G", "N.R", "crypto_asset.B", "crypto_asset.G", "crypto_asset.R"},
          {{"arnold/version", std::string("7")}});
    EXPECT_EQ(channels_of("color"), Names{});
}

TEST_F(LayeredFile, WithSeveralColoursAndNoUsualNameHasNoneUntilOneIsNamed) {
    write({"key.B", "key.G", "key.R", "fill.B", "fill.G", "fill.R"}, {{"nuke/version", std::string("13")}});
    EXPECT_EQ(channels_of("color"), Names{});
    sequence_.layer = "fill";
    EXPECT_EQ(channels_of("color"), (Names{"fill.R", "fill.G", "fill.B"}));
}

TEST_F(LayeredFile, HasDepthByItsUsualNameUnderAnyProducer) {
    for (const char* name : {"depth.Z", "Depth.V", "depth", "Z"}) {
        write({"R", "G", "B", name}, {{"cycles.ViewLayer.samples", std::string("7")}});
        EXPECT_EQ(channels_of("depth"), Names{name});
    }
}

TEST_F(LayeredFile, ThatWeWroteUnderNativeNamesIsNativeWhoeverMadeItsSource) {
    Attributes attributes = kBlender;
    attributes["aftershade/channels"] = std::string("native");
    write({"R", "G", "B", "A", "Z", "velocity.X", "velocity.Y"}, attributes);
    EXPECT_EQ(header().profile, "native");
    EXPECT_EQ(header().roles, (Names{"color", "depth", "velocity"}));
    attributes["aftershade/channels"] = std::string("kept");
    write(below("ViewLayer", kShortPasses), attributes);
    EXPECT_EQ(header().profile, "blender");
}

TEST_F(LayeredFile, OfAProducerThatNukeWroteAgainIsTheProducers) {
    write({"R", "G", "B"}, {{"arnold/version", std::string("5")}, {"nuke/version", std::string("10")}});
    EXPECT_EQ(header().profile, "arnold");
}

TEST_F(LayeredFile, NamesTheProfilesAndLayersThatHaveARoleWhichIsMissing) {
    const auto elsewhere = [&](const std::string& role) { return reader().find_elsewhere(header(), role); };
    write(below("A", {"Combined.R", "Combined.G", "Combined.B", "Depth.V"}) +
              below("B", {"Combined.R", "Combined.G", "Combined.B", "Depth.V", "Vector.X", "Vector.Y"}),
          kBlender);
    EXPECT_EQ(header().layer, "A");
    EXPECT_EQ(elsewhere("velocity").layers, Names{"B"});
    EXPECT_EQ(elsewhere("velocity").profiles, Names{});
    EXPECT_EQ(elsewhere("normal").layers, Names{});
    write({"R", "G", "B", "ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
           "ViewLayer.Vector.X", "ViewLayer.Vector.Y"});
    sequence_.profile = "native";
    EXPECT_EQ(header().roles, Names{"color"});
    EXPECT_EQ(elsewhere("velocity").profiles, Names{"blender"});
    EXPECT_EQ(elsewhere("albedo").profiles, Names{});
    sequence_.profile = "blender";
    EXPECT_EQ(header().roles, (Names{"color", "velocity"})) << "what the hint says works";
}

TEST_F(LayeredFile, TakesThreeChannelsForAColourThatIsOpaque) {
    write({"x.R", "x.G", "x.B", "A"});
    Diagnostics diagnostics;
    sequence_.channels = read_decodings(parsed(R"({"color": {"channels": ["x.R", "x.G", "x.B"]}})"));
    sequence_.profile = "native";
    const Image color = image("color");
    EXPECT_FLOAT_EQ(color.at(0, 0, 1), 2);
    EXPECT_FLOAT_EQ(color.at(0, 0, 3), 1);
}

}  // namespace
}  // namespace aftershade::test
