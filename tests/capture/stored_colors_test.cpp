// In which space a file's colours are: by its attributes, held against matrices and curves worked out here.
#include <cmath>

#include <gtest/gtest.h>

#include "framework/image/color_space.h"
#include "tests/capture/capture_files.h"

namespace aftershade::test {
namespace {

using Attributes = std::map<std::string, ExrValue>;
using Rgb = std::array<double, 3>;

const std::vector<float> kAp1 = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
const std::vector<float> kSrgb = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

/// The pixel (0.4, 0.1, 0.05, 0.5), read from a file with these attributes.
struct Read {
    CaptureHeader header;
    std::vector<float> pixel;
    std::string warnings;
};

Read read_with(const Attributes& attributes, const std::string& declared = "auto") {
    const TemporaryFolder folder;
    write_channels(folder / "f.exr", 1, {{"R", {0.4f}}, {"G", {0.1f}}, {"B", {0.05f}}, {"A", {0.5f}}},
                   attributes);
    Sequence sequence = sequence_of(folder / "f.exr", "t");
    sequence.color_space = declared;
    const CaptureReader reader(sequence, {profile_of_roles("")}, {});
    const std::vector<std::string> roles = {"color"};
    Capture capture = reader.read(1, roles);
    Read result{capture.header, {}, ""};
    const auto values = capture.images.at("color").floats();
    result.pixel.assign(values.begin(), values.end());
    for (const std::string& warning : capture.header.warnings) result.warnings += warning + "\n";
    return result;
}

/// Light in Rec. 709, by the matrices that are published for each space.
Rgb in_rec709(const Read& read) {
    const ColorMatrix m = conversion_matrix(read.header.primaries, kRec709);
    Rgb rgb{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t k = 0; k < 3; ++k) rgb[row] += m[row * 3 + k] * double(read.pixel[k]);
    return rgb;
}

Rgb times(const ColorMatrix& m, const Rgb& v) {
    return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
            m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

void expect_rgb(const Rgb& found, const Rgb& expected, double tolerance, const std::string& what) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << what << ", " << c;
}

/// To Rec. 709 by Bradford's method, in double precision by numpy.linalg.solve from the published xy of each.
const ColorMatrix kAp1ToRec709 = {1.7050510,  -0.6217921, -0.0832590, -0.1302564, 1.1408048,
                                  -0.0105485, -0.0240033, -0.1289690, 1.1529723};
const ColorMatrix kAp0ToRec709 = {2.5216862,  -1.1341310, -0.3875552, -0.2764799, 1.3727191,
                                  -0.0962392, -0.0153781, -0.1529753, 1.1683534};
const ColorMatrix kP3ToRec709 = {1.2249402, -0.2249402, 0,          -0.0420570, 1.0420570,
                                 0,         -0.0196376, -0.0786361, 1.0982736};
const ColorMatrix kRec2020ToRec709 = {1.6604910,  -0.5876411, -0.0728499, -0.1245505, 1.1328999,
                                      -0.0083494, -0.0181508, -0.1005789, 1.1187297};
const Rgb kStored = {0.4, 0.1, 0.05};

TEST(StoredColors, AreConvertedByTheIdOfTheirSpace) {
    for (const auto& [id, matrix] :
         std::map<std::string, ColorMatrix>{{"lin_ap1_scene", kAp1ToRec709},
                                            {"lin_ap0_scene", kAp0ToRec709},
                                            {"lin_p3d65_scene", kP3ToRec709},
                                            {"lin_rec2020_scene", kRec2020ToRec709},
                                            {"lin_rec709_scene", {1, 0, 0, 0, 1, 0, 0, 0, 1}}}) {
        const Read read = read_with({{"colorInteropID", id}});
        expect_rgb(in_rec709(read), times(matrix, kStored), 2e-4, id);
        EXPECT_EQ(read.header.stored_colors.source, "colorInteropID");
        EXPECT_EQ(read.warnings, "");
    }
}

TEST(StoredColors, AreAp0InAnAcesContainer) {
    const Read read = read_with({{"acesImageContainerFlag", 1}});
    expect_rgb(in_rec709(read), times(kAp0ToRec709, kStored), 2e-4, "flag");
    EXPECT_EQ(read.header.stored_colors.text(), "ap0 (acesImageContainerFlag)");
    EXPECT_EQ(read_with({{"acesImageContainerFlag", 0}}).header.stored_colors.text(), "rec709 (assumed)");
}

TEST(StoredColors, AreKnownByOpenImageIOsNames) {
    for (const char* name : {"ACEScg", "lin_ap1", "lin_ap1_scene", "ACES - ACEScg"})
        expect_rgb(in_rec709(read_with({{"oiio:ColorSpace", name}})), times(kAp1ToRec709, kStored), 2e-4,
                   name);
    expect_rgb(in_rec709(read_with({{"oiio:ColorSpace", "Linear P3-D65"}})), times(kP3ToRec709, kStored),
               2e-4, "P3");
    const auto text_of = [](const char* name) {
        return read_with({{"oiio:ColorSpace", name}}).header.stored_colors.text();
    };
    EXPECT_EQ(text_of("lin_srgb"), "rec709 (oiio:ColorSpace)");
    for (const char* name : {"Linear", "scene_linear"}) EXPECT_EQ(text_of(name), "rec709 (assumed)");
}

/// Premultiplied by 0.5: the curve is that of the colour itself.
TEST(StoredColors, BecomeLightByTheCurveOfTheirSpace) {
    const auto through = [](double (*curve)(double)) {
        Rgb rgb{};
        for (std::size_t c = 0; c < 3; ++c) rgb[c] = 0.5 * curve(kStored[c] / 0.5);
        return rgb;
    };
    const auto srgb = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    for (const char* id : {"srgb_rec709_scene", "srgb_rec709_display"})
        expect_rgb(in_rec709(read_with({{"colorInteropID", id}})), through(srgb), 1e-6, id);
    expect_rgb(in_rec709(read_with({{"oiio:ColorSpace", "sRGB"}})), through(srgb), 1e-6, "sRGB");
    expect_rgb(in_rec709(read_with({{"colorInteropID", "g22_rec709_scene"}})),
               through([](double v) { return std::pow(v, 2.2); }), 1e-6, "g22");
    expect_rgb(in_rec709(read_with({{"oiio:ColorSpace", "Rec709"}})), through([](double v) {
                   return v < 0.081 ? v / 4.5 : std::pow((v + 0.099) / 1.099, 1 / 0.45);
               }),
               1e-6, "Rec709");
    expect_rgb(in_rec709(read_with({{"colorInteropID", "srgb_ap1_scene"}})),
               times(kAp1ToRec709, through(srgb)), 2e-4, "srgb_ap1_scene");
}

TEST(StoredColors, OfACurveThatIsNotKnownAreRefused) {
    for (const Attributes& attributes : {Attributes{{"colorInteropID", "pq_rec2020_display"}},
                                         Attributes{{"colorInteropID", "hlg_rec2020_display"}},
                                         Attributes{{"oiio:ColorSpace", "ACEScct"}}}) {
        const std::string refusal = capture_error([&] { read_with(attributes); });
        EXPECT_NE(refusal.find(std::get<std::string>(attributes.begin()->second)), std::string::npos)
            << refusal;
        EXPECT_NE(refusal.find("with color_space, or"), std::string::npos) << refusal;
        EXPECT_EQ(read_with(attributes, "rec2020").header.stored_colors.name, "rec2020");
    }
}

TEST(StoredColors, WarnWhereAttributesContradictOneAnother) {
    const Read id = read_with({{"colorInteropID", "lin_ap1_scene"}, {"chromaticities", kSrgb}});
    expect_rgb(in_rec709(id), times(kAp1ToRec709, kStored), 2e-4, "id and chromaticities");
    EXPECT_NE(id.warnings.find("colorInteropID is 'lin_ap1_scene', but chromaticities is 'rec709'; "
                               "colorInteropID counts"),
              std::string::npos)
        << id.warnings;
    const Read flag = read_with({{"acesImageContainerFlag", 1}, {"chromaticities", kAp1}});
    EXPECT_EQ(flag.header.stored_colors.name, "ap0");
    EXPECT_NE(flag.warnings.find("acesImageContainerFlag counts"), std::string::npos) << flag.warnings;
    const Read curve = read_with({{"oiio:ColorSpace", "sRGB"}, {"chromaticities", kSrgb}});
    EXPECT_EQ(curve.pixel[0], 0.4f);
    EXPECT_NE(curve.warnings.find("chromaticities counts"), std::string::npos) << curve.warnings;
    EXPECT_EQ(read_with({{"colorInteropID", "lin_ap1_scene"}, {"chromaticities", kAp1}}).warnings, "");
    EXPECT_EQ(read_with({{"colorInteropID", "lin_ap1_scene"}, {"chromaticities", kSrgb}}, "ap0").warnings,
              "");
}

TEST(StoredColors, WarnOfAnIdThatIsNotKnown) {
    for (const char* id : {"studio:my_space", "unknown", "lin_e-gamut_scene"}) {
        const Read read = read_with({{"colorInteropID", id}});
        EXPECT_EQ(read.pixel[0], 0.4f);
        EXPECT_EQ(read.header.stored_colors.text(), "rec709 (assumed)");
        EXPECT_NE(read.warnings.find(id), std::string::npos) << read.warnings;
        EXPECT_EQ(read_with({{"colorInteropID", id}, {"chromaticities", kAp1}}).header.stored_colors.text(),
                  "acescg (chromaticities)");
    }
    EXPECT_NE(read_with({{"colorInteropID", "data"}}).warnings.find("hold no colours"), std::string::npos);
}

TEST(StoredColors, AreWhatIsDeclaredWhateverTheFileSays) {
    const Read read = read_with({{"colorInteropID", "srgb_rec709_scene"}}, "acescg");
    expect_rgb(in_rec709(read), times(kAp1ToRec709, kStored), 2e-4, "declared");
    EXPECT_EQ(read.header.stored_colors.text(), "acescg (declared by the user)");
}

/// Each role's file has an attribute of its own; one without any is in the space of color.
TEST(StoredColors, OfARoleFromAnotherFileAreItsOwn) {
    const TemporaryFolder folder;
    write_channels(folder / "f.exr", 1, {{"R", {0.4f}}, {"G", {0.1f}}, {"B", {0.05f}}});
    write_channels(folder / "a.exr", 1, {{"R", {0.4f}}, {"G", {0.1f}}, {"B", {0.05f}}},
                   {{"colorInteropID", "lin_ap1_scene"}});
    Sequence sequence = sequence_of(folder / "f.exr", "t");
    sequence.role_files.insert_or_assign("albedo", FramePattern((folder / "a.exr").string()));
    const CaptureReader reader(sequence, {profile_of_roles("")}, {});
    const std::vector<std::string> roles = {"color", "albedo"};
    const Capture capture = reader.read(1, roles);
    EXPECT_EQ(capture.images.at("color").floats()[0], 0.4f);
    const auto albedo = capture.images.at("albedo").floats();
    expect_rgb({albedo[0], albedo[1], albedo[2]}, times(kAp1ToRec709, kStored), 2e-4, "albedo");
}

/// A step's result goes back into the space that the file's channels are in.
TEST(StoredColors, OfChangedChannelsAreTheFilesOwn) {
    const TemporaryFolder folder;
    write_channels(folder / "f.exr", 1, {{"R", {0.4f}}, {"G", {0.1f}}, {"B", {0.05f}}},
                   {{"colorInteropID", "srgb_ap1_scene"}});
    const Sequence sequence = sequence_of(folder / "f.exr", "t");
    const CaptureReader reader(sequence, {profile_of_roles("")}, {});
    const std::vector<std::string> roles = {"color"};
    const Capture capture = reader.read(1, roles);
    const auto stored = reader.read_stored_channels(1, {{"color", &capture.images.at("color")}});
    const std::map<std::string, float> expected = {{"R", 0.4f}, {"G", 0.1f}, {"B", 0.05f}};
    for (const auto& channel : stored)
        EXPECT_NEAR(channel.image.floats()[0], expected.at(channel.name), 1e-6) << channel.name;
}

TEST(StoredColors, WarnOfNamesOfOpenImageIOThatAreNotKnown) {
    for (const char* name : {"Filmic Log", "AgX Base sRGB"}) {
        const Read read = read_with({{"oiio:ColorSpace", name}});
        EXPECT_EQ(read.pixel[0], 0.4f);
        EXPECT_EQ(read.warnings,
                  "oiio:ColorSpace is '" + std::string(name) +
                      "', which is not a known colour space; the numbers are assumed to be Rec. 709 "
                      "(choose with color_space, or \"color_space\" in capture.json)\n");
    }
}

TEST(StoredColors, OfPrimariesThatSpanNothingAreAssumedAndSayIt) {
    const float nan = std::nanf("");
    for (const std::vector<float>& xy :
         {std::vector<float>(8, 0), std::vector<float>(8, nan),
          std::vector<float>{0.1f, 0.1f, 0.2f, 0.2f, 0.3f, 0.3f, 0.3127f, 0.3290f}}) {
        const Read read = read_with({{"chromaticities", xy}});
        EXPECT_EQ(read.pixel[0], 0.4f);
        EXPECT_EQ(read.header.stored_colors.text(), "rec709 (assumed)");
        EXPECT_NE(read.warnings.find("chromaticities is '"), std::string::npos) << read.warnings;
    }
}

}  // namespace
}  // namespace aftershade::test
