// Nothing of a file drops out of a comparison: subsampled channels, parts, views, large integers.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>

#include "framework/compare/compare_files.h"
#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 8, kHeight = 4;

struct Channel {
    float value = 0;  ///< of every sample, but for the last one's
    int sampling = 1;
    float last = -1;  ///< of the last sample; below 0: as the others
    Imf::PixelType type = Imf::FLOAT;
};
using PartChannels = std::map<std::string, Channel>;
struct Part {
    std::string name, view;
    PartChannels channels;
};

/// The samples of one part, and where the library finds them.
struct Samples {
    std::vector<std::vector<float>> floats;
    std::vector<std::vector<std::uint32_t>> uints;
    Imf::FrameBuffer frame;
    Imf::Header header{kWidth, kHeight};

    explicit Samples(const Part& part) {
        if (!part.name.empty()) header.setName(part.name);
        if (!part.view.empty()) header.setView(part.view);
        header.setType(Imf::SCANLINEIMAGE);
        for (const auto& [name, channel] : part.channels) {
            const int across = kWidth / channel.sampling;
            const auto count = std::size_t(across * (kHeight / channel.sampling));
            char* pixels = nullptr;
            if (channel.type == Imf::UINT) {
                uints.emplace_back(count, std::uint32_t(channel.value));
                if (channel.last >= 0) uints.back().back() += std::uint32_t(channel.last);
                pixels = reinterpret_cast<char*>(uints.back().data());
            } else {
                floats.emplace_back(count, channel.value);
                if (channel.last >= 0) floats.back().back() = channel.last;
                pixels = reinterpret_cast<char*>(floats.back().data());
            }
            header.channels().insert(name, Imf::Channel(channel.type, channel.sampling, channel.sampling));
            frame.insert(name, Imf::Slice(channel.type, pixels, 4, std::size_t(4 * across), channel.sampling,
                                          channel.sampling));
        }
    }
};

class EveryLayer : public testing::Test {
protected:
    void write(const char* name, const std::vector<Part>& parts) {
        std::deque<Samples> samples;  // which stay where the library finds them
        std::vector<Imf::Header> headers;
        for (const Part& part : parts) headers.push_back(samples.emplace_back(part).header);
        const std::string path = (folder_ / name).string();
        if (parts.size() == 1) {
            Imf::OutputFile file(path.c_str(), headers[0]);
            file.setFrameBuffer(samples[0].frame);
            file.writePixels(kHeight);
            return;
        }
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
        for (std::size_t i = 0; i < parts.size(); ++i) {
            Imf::OutputPart part(file, int(i));
            part.setFrameBuffer(samples[i].frame);
            part.writePixels(kHeight);
        }
    }
    void write(const char* name, const PartChannels& channels) { write(name, {Part{"", "", channels}}); }
    Comparison compared(const CompareRules& rules = {}) {
        return compare_files(folder_ / "r.exr", folder_ / "t.exr", rules);
    }
    /// Labels of the layers that were compared, sorted.
    static std::vector<std::string> labels(const Comparison& comparison) {
        std::vector<std::string> result;
        for (const LayerComparison& layer : comparison.layers) result.push_back(layer.label);
        std::ranges::sort(result);
        return result;
    }
    test::TemporaryFolder folder_;
};

using Texts = std::vector<std::string>;

TEST_F(EveryLayer, OfALuminanceChromaFileIsComparedAsItIsStored) {
    const PartChannels picture = {{"Y", {0.5f}}, {"RY", {0.1f, 2}}, {"BY", {0.2f, 2}}};
    for (const auto& [name, change] :
         std::map<std::string, Channel>{{"Z", {3}}, {"velocity.X", {2}}, {"RY", {0.1f, 2, 0.1001f}}}) {
        PartChannels reference = picture, test = picture;
        reference["Z"] = {2}, reference["velocity.X"] = reference["velocity.Y"] = {1};
        test = reference;
        test[name] = change;
        write("r.exr", reference), write("t.exr", test);
        const Comparison comparison = compared();
        EXPECT_EQ(comparison.verdict, Verdict::failure) << name;
        EXPECT_EQ(labels(comparison), (Texts{"BY", "RGB", "RY", "Y", "Z", "velocity.XY"}));
    }
    // Half precision, in which the colours are converted, has no digit for this.
    PartChannels brighter = picture;
    brighter["Y"] = {0.50002f};
    write("r.exr", picture), write("t.exr", brighter);
    EXPECT_EQ(compared().verdict, Verdict::failure);
}

TEST_F(EveryLayer, BesideASubsampledOneIsCompared) {
    const PartChannels reference = {{"R", {1}}, {"G", {1}}, {"B", {1}}, {"Z", {2}}, {"mask.V", {1, 2}}};
    write("r.exr", reference);
    for (const char* name : {"R", "Z", "mask.V"}) {
        PartChannels test = reference;
        test[name].last = 7;
        write("t.exr", test);
        const Comparison comparison = compared();
        EXPECT_EQ(comparison.verdict, Verdict::failure) << name;
        EXPECT_EQ(comparison.layers.size(), 3u) << name;
        // One sample of a mask of half the size stands for four pixels.
        const auto mask = std::ranges::find(comparison.layers, "mask.V", &LayerComparison::label);
        const Window quad{kWidth - 2, kHeight - 2, kWidth - 1, kHeight - 1};
        if (mask->label == name) {
            EXPECT_EQ(mask->differences.failing.box, quad);
        }
        test.erase(name);
        write("t.exr", test);
        EXPECT_EQ(compared().verdict, Verdict::different_size) << name << " is missing";
    }
}

TEST_F(EveryLayer, OfColoursIsComparedWhereOneOfThemIsSubsampled) {
    const PartChannels reference = {{"R", {1, 2}}, {"G", {1}}, {"B", {1, 4}}};
    write("r.exr", reference);
    for (const auto& [name, channel] : reference) {
        PartChannels test = reference;
        test[name].last = 0.5f;
        write("t.exr", test);
        const Comparison comparison = compared();
        ASSERT_EQ(labels(comparison), Texts{"RGB"});
        EXPECT_EQ(comparison.verdict, Verdict::failure);
        EXPECT_EQ(comparison.layers[0].differences.failing.count,
                  std::uint64_t(channel.sampling * channel.sampling));
    }
}

TEST_F(EveryLayer, OfAnyPartIsComparedWhereOneIsSubsampled) {
    const std::vector<Part> reference = {{"a", "", {{"R", {1}}, {"Z", {1}}}},
                                         {"b", "", {{"V", {1, 2}}, {"W", {1}}}}};
    write("r.exr", reference);
    for (const auto& [part, name] : {std::pair{0, "Z"}, {1, "V"}, {1, "W"}}) {
        std::vector<Part> test = reference;
        test[std::size_t(part)].channels[name].last = 5;
        write("t.exr", test);
        EXPECT_EQ(compared().verdict, Verdict::failure) << name;
    }
}

TEST_F(EveryLayer, OfLargeIntegersIsComparedToTheBitBesideFloats) {
    // 2^24 and 2^24 + 1 are one float.
    const PartChannels reference = {
        {"crypto.r", {0.5f}}, {"crypto.g", {16777216, 1, -1, Imf::UINT}}, {"id.a", {1, 1, -1, Imf::UINT}}};
    PartChannels test = reference;
    write("r.exr", reference), write("t.exr", test);
    EXPECT_EQ(compared().verdict, Verdict::same);
    test["crypto.g"].last = 1;
    write("t.exr", test);
    EXPECT_EQ(compared().verdict, Verdict::failure);
}

TEST_F(EveryLayer, OfSeveralPartsIsFoundInOnePart) {
    const PartChannels colors = {{"R", {1}}, {"G", {2}}, {"B", {3}}, {"A", {1}}};
    PartChannels one = colors;
    one["depth.Z"] = {4}, one["velocity.X"] = {5}, one["velocity.Y"] = {6}, one["diffuse.R"] = {7};
    write("r.exr", one);
    for (const bool whole_names : {false, true}) {
        const std::string depth = whole_names ? "depth.Z" : "Z", x = whole_names ? "velocity.X" : "X",
                          y = whole_names ? "velocity.Y" : "Y", red = whole_names ? "diffuse.R" : "R";
        std::vector<Part> parts = {{"rgba", "", colors},
                                   {"depth", "", {{depth, {4}}}},
                                   {"velocity", "", {{x, {5}}, {y, {6}}}},
                                   {"diffuse", "", {{red, {7}}}}};
        write("t.exr", parts);
        const Comparison same = compared();
        EXPECT_EQ(same.verdict, Verdict::same) << (same.faults.empty() ? "" : same.faults[0]);
        EXPECT_EQ(labels(same), (Texts{"A", "RGB", "depth.Z", "diffuse.R", "velocity.XY"}));
        for (Part& part : parts) {
            const float value = std::exchange(part.channels.begin()->second.value, 99.0f);
            write("t.exr", parts);
            EXPECT_EQ(compared().verdict, Verdict::failure) << part.name;
            part.channels.begin()->second.value = value;
        }
        parts.pop_back();
        write("t.exr", parts);
        EXPECT_EQ(compared().verdict, Verdict::different_size);
        EXPECT_EQ(compared().faults, Texts{"layer 'diffuse.R' is only in the reference"});
    }
}

TEST_F(EveryLayer, OfTwoViewsIsFoundInOnePart) {
    const auto colors = [](float value) { return PartChannels{{"R", {value}}, {"G", {1}}, {"B", {1}}}; };
    write("r.exr", {{"rgb.left", "left", colors(1)},
                    {"rgb.right", "right", colors(2)},
                    {"depth_left", "left", {{"Z", {3}}}},
                    {"depth_right", "right", {{"Z", {4}}}}});
    PartChannels one = colors(1);
    for (const auto& [name, channel] : colors(2)) one["right." + name] = channel;
    one["Z"] = {3}, one["right.Z"] = {4};
    write("t.exr", one);
    EXPECT_EQ(compared().verdict, Verdict::same);
    EXPECT_EQ(compared().layers.size(), 4u);
    one["right.Z"] = {3}, one["Z"] = {4};
    write("t.exr", one);
    EXPECT_EQ(compared().verdict, Verdict::failure) << "the views are exchanged";
}

TEST_F(EveryLayer, ThatFitsTwoOthersIsNamedAndNotTheSame) {
    write("r.exr", {{"a", "", {{"R", {1}}}}, {"b", "", {{"R", {1}}}}});
    write("t.exr", PartChannels{{"R", {1}}});
    const Comparison comparison = compared();
    EXPECT_EQ(comparison.verdict, Verdict::different_size);
    EXPECT_EQ(comparison.faults,
              (Texts{"part 'a' is only in the reference", "part 'b' is only in the reference",
                     "the test image has one part, the other has 2"}));
}

TEST_F(EveryLayer, OfAPartHasTheLimitsOfEitherFilesName) {
    write("r.exr", {{"rgb", "", {{"R", {1}}}}, {"depth", "", {{"Z", {1}}}}});
    write("t.exr", PartChannels{{"R", {1}}, {"depth.Z", {1.05f}}});
    CompareRules rules;
    for (const char* label : {"depth:Z", "depth.Z"}) {
        EXPECT_EQ(compared().verdict, Verdict::failure);
        Levels levels;
        levels.fail.limit = 0.1;
        rules.layers = {{label, levels}};
        EXPECT_EQ(compared(rules).verdict, Verdict::same) << label;
        rules.layers.clear();
        rules.roles = {{label, std::nullopt}};
        EXPECT_EQ(labels(compared(rules)), Texts{"rgb:R"}) << label;
        rules.roles.clear();
    }
}

/// A tiled picture of one colour, with or without smaller levels.
void write_tiles(const fs::path& path, Imf::LevelMode mode,
                 const std::map<std::string, float>& numbers = {}) {
    Imf::Header header(kWidth, kHeight);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(4, 4, mode));
    if (numbers.contains("aspect")) header.pixelAspectRatio() = numbers.at("aspect");
    if (numbers.contains("red x")) {
        Imf::Chromaticities primaries;
        primaries.red.x = numbers.at("red x");
        Imf::addChromaticities(header, primaries);
    }
    Imf::TiledOutputFile file(path.c_str(), header);
    const std::vector<float> pixels(std::size_t(kWidth) * kHeight, 0.5f);
    Imf::FrameBuffer frame;
    frame.insert("R", Imf::Slice(Imf::FLOAT, const_cast<char*>(reinterpret_cast<const char*>(pixels.data())),
                                 4, 4 * kWidth));
    file.setFrameBuffer(frame);
    for (int level = 0; level < file.numLevels(); ++level)
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
}

TEST_F(EveryLayer, OfTheSmallerLevelsOfTilesIsNamedAsNotCompared) {
    write_tiles(folder_ / "r.exr", Imf::ONE_LEVEL);
    write_tiles(folder_ / "t.exr", Imf::ONE_LEVEL);
    EXPECT_EQ(compared().verdict, Verdict::same);
    write_tiles(folder_ / "t.exr", Imf::MIPMAP_LEVELS);
    const Comparison comparison = compared();
    EXPECT_EQ(comparison.verdict, Verdict::warning);
    EXPECT_EQ(comparison.warnings, Texts{"not compared: smaller levels of the tiles in the test image"});
}

TEST_F(EveryLayer, WithEqualNumbersIsNotTheSameInOtherPrimariesOrPixels) {
    write_tiles(folder_ / "r.exr", Imf::ONE_LEVEL);
    write_tiles(folder_ / "t.exr", Imf::ONE_LEVEL, {{"red x", 0.64f}});
    EXPECT_EQ(compared().verdict, Verdict::same) << "Rec. 709 is what a file without an attribute means";
    write_tiles(folder_ / "t.exr", Imf::ONE_LEVEL, {{"red x", 0.7f}});
    EXPECT_EQ(compared().verdict, Verdict::warning);
    EXPECT_NE(compared().warnings.at(0).find("rec709 in the reference, primaries 0.7000 0.3300"),
              std::string::npos)
        << compared().warnings.at(0);
    write_tiles(folder_ / "t.exr", Imf::ONE_LEVEL, {{"aspect", 2.0f}});
    EXPECT_EQ(compared().warnings, Texts{"another pixel aspect: 1 in the reference, 2 in the test image"});
}

TEST_F(EveryLayer, OfEqualNumbersIsNotTheSameWhereAnAttributeNamesAnotherSpace) {
    const auto write_with = [&](const char* name, const std::map<std::string, std::string>& texts) {
        Samples samples(Part{"", "", {{"R", {0.5f}}, {"G", {0.25f}}, {"B", {0.125f}}}});
        for (const auto& [key, text] : texts) samples.header.insert(key, Imf::StringAttribute(text));
        Imf::OutputFile file((folder_ / name).string().c_str(), samples.header);
        file.setFrameBuffer(samples.frame);
        file.writePixels(kHeight);
    };
    write_with("r.exr", {{"colorInteropID", "lin_rec709_scene"}});
    for (const auto& [key, text] : std::map<std::string, std::string>{{"colorInteropID", "lin_ap1_scene"},
                                                                      {"colorInteropId", "srgb_rec709_scene"},
                                                                      {"oiio:ColorSpace", "AgX Base sRGB"}}) {
        write_with("t.exr", {{key, text}});
        const Comparison comparison = compared();
        EXPECT_EQ(comparison.verdict, Verdict::warning) << text;
        ASSERT_EQ(comparison.warnings.size(), 1u) << text;
        EXPECT_EQ(comparison.warnings[0].find("the same numbers are other colours: rec709 in the reference"),
                  0u)
            << comparison.warnings[0];
    }
    // Other words for the same.
    for (const char* space : {"lin_rec709", "Linear Rec.709 (sRGB)", "scene_linear"}) {
        write_with("t.exr", {{"oiio:ColorSpace", space}});
        EXPECT_EQ(compared().verdict, Verdict::same) << space;
    }
    write_with("r.exr", {{"colorInteropID", "srgb_rec709_display"}}),
        write_with("t.exr", {{"oiio:ColorSpace", "sRGB"}});
    EXPECT_EQ(compared().verdict, Verdict::same);
}

TEST_F(EveryLayer, OfEqualIdsIsNotTheSameWhereManifestsNameOtherObjects) {
    const auto write_with = [&](const char* name, const std::map<std::string, std::string>& texts) {
        Samples samples(Part{"", "", {{"crypto00.R", {0.5f}}, {"crypto00.G", {1}}}});
        samples.header.insert("cryptomatte/1234567/name", Imf::StringAttribute("crypto"));
        for (const auto& [key, text] : texts)
            samples.header.insert("cryptomatte/1234567/" + key, Imf::StringAttribute(text));
        Imf::OutputFile file((folder_ / name).string().c_str(), samples.header);
        file.setFrameBuffer(samples.frame);
        file.writePixels(kHeight);
    };
    const std::string manifest = R"({"hero": "01020304", "sword": "0a0b0c0d"})";
    write_with("r.exr", {{"manifest", manifest}});
    for (const char* same : {R"({"sword": "0a0b0c0d", "hero": "01020304"})",
                             R"({"hero": "01020304", "sword": "0a0b0c0d", "shield": "0a0b0c0e"})", "{"}) {
        write_with("t.exr", {{"manifest", same}});
        EXPECT_EQ(compared().verdict, Verdict::same) << same;
    }
    const Texts renamed = {
        "the manifests of the Cryptomatte 'crypto' give one id other names: 01020304 is 'hero' in the "
        "reference, 'villain' in the test image"};
    const std::string other = R"({"villain": "01020304", "sword": "0a0b0c0d"})";
    write_with("t.exr", {{"manifest", other}});
    EXPECT_EQ(compared().verdict, Verdict::warning);
    EXPECT_EQ(compared().warnings, renamed);
    write_with("t.exr", {{"manif_file", "names.json"}});
    EXPECT_EQ(compared().verdict, Verdict::same) << "the manifest is not there";
    test::write_text(folder_ / "names.json", other);
    EXPECT_EQ(compared().warnings, renamed) << "of a file beside the EXR";
}

TEST_F(EveryLayer, OfEqualNumbersIsNotTheSameWhereViewsChangePlaces) {
    const PartChannels left = {{"R", {1}}, {"G", {1}}, {"B", {1}}},
                       right = {{"R", {2}}, {"G", {2}}, {"B", {2}}};
    write("r.exr", {{"a", "left", left}, {"b", "right", right}});
    write("t.exr", {{"a", "left", left}, {"b", "right", right}});
    EXPECT_EQ(compared().verdict, Verdict::same);
    write("t.exr", {{"a", "right", left}, {"b", "left", right}});
    EXPECT_EQ(compared().verdict, Verdict::warning);
    const auto write_views = [&](const char* name, const Imf::StringVector& views) {
        Samples samples(Part{"", "", left});
        Imf::addMultiView(samples.header, views);
        Imf::OutputFile file((folder_ / name).string().c_str(), samples.header);
        file.setFrameBuffer(samples.frame);
        file.writePixels(kHeight);
    };
    write_views("r.exr", {"left", "right"}), write_views("t.exr", {"right", "left"});
    const Comparison comparison = compared();
    EXPECT_EQ(comparison.verdict, Verdict::warning);
    ASSERT_EQ(comparison.warnings.size(), 1u);
    EXPECT_NE(comparison.warnings[0].find("'left' in the reference, 'right' in the test image"),
              std::string::npos);
}

}  // namespace
}  // namespace aftershade
