// Files of the shape that Mitsuba 3.9.1 writes: XYZ films, and averaged AOVs under the scene's own names.
#include <algorithm>
#include <cmath>

#include "framework/image/color_space.h"
#include "tests/capture/capture_files.h"

namespace aftershade::test {
namespace {

const std::vector<float> kXyzChromaticities = {1, 0, 0, 1, 0, 0, 1.0f / 3, 1.0f / 3};

std::vector<Profile> profiles_of_the_project() {
    Diagnostics diagnostics;
    return read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
}

/// One row under the shipped profiles.
class WrittenRow {
public:
    WrittenRow(const std::vector<StoredChannel>& channels, std::map<std::string, ExrValue> attributes)
        : sequence_(sequence_of(folder_ / "f.exr", "auto")),
          reader_(sequence_, profiles_of_the_project(), {}) {
        write_channels(folder_ / "f.exr", int(channels.front().values.size()), channels,
                       std::move(attributes));
    }
    CaptureHeader header() const { return reader_.read_header(1); }
    Image image(const std::string& role) const {
        return reader_.read(1, std::vector<std::string>{role}).images.at(role);
    }
    Sequence& sequence() { return sequence_; }

private:
    TemporaryFolder folder_;
    Sequence sequence_;
    CaptureReader reader_;
};

const ExrValue kGeneratedBy = std::string("Mitsuba version 3.9.1");

/// The white and the red of Rec. 709 as CIE XYZ (IEC 61966-2-1).
TEST(XyzFilm, IsAColourOfRec709) {
    const WrittenRow file({{"X", {0.9505f, 0.4124f}}, {"Y", {1, 0.2126f}}, {"Z", {1.0891f, 0.0193f}}},
                          {{"generatedBy", kGeneratedBy}, {"chromaticities", kXyzChromaticities}});
    EXPECT_EQ(file.header().profile, "mitsuba");
    EXPECT_EQ(file.header().roles, std::vector<std::string>{"color"});
    EXPECT_EQ(name_of_primaries(file.header().primaries), "rec709");
    const Image color = file.image("color");
    const float expected[2][4] = {{1, 1, 1, 1}, {1, 0, 0, 1}};
    for (int x = 0; x < 2; ++x)
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(color.at(x, 0, c), expected[x][c], 2e-3) << x << " " << c;
}

/// Beside the AOV integrator's images Mitsuba writes no chromaticities; Y alone would be a grey picture.
TEST(XyzFilm, IsAColourBesideAovsToo) {
    const WrittenRow file({{"X", {0.9505f, 0.4124f}},
                           {"Y", {1, 0.2126f}},
                           {"Z", {1.0891f, 0.0193f}},
                           {"A", {1, 0.5f}},
                           {"dd.T", {4, 5}},
                           {"albedo.R", {0.25f, 0.25f}},
                           {"albedo.G", {0.5f, 0.5f}},
                           {"albedo.B", {0.75f, 0.75f}}},
                          {{"generatedBy", kGeneratedBy}});
    EXPECT_EQ(file.header().role_channels.at("color"), (std::vector<std::string>{"X", "Y", "Z", "A"}));
    EXPECT_EQ(name_of_primaries(file.header().primaries), "rec709");
    const Image color = file.image("color");
    const float expected[2][4] = {{1, 1, 1, 1}, {1, 0, 0, 0.5f}};
    for (int x = 0; x < 2; ++x)
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(color.at(x, 0, c), expected[x][c], 2e-3) << x << " " << c;
    EXPECT_NEAR(file.image("albedo").at(0, 0, 0), 0.25, 1e-6) << "its primaries are not X, Y and Z";
}

/// Of an unknown producer they may be positions.
TEST(XAndYAndZ, HaveNoLuminanceAmongThem) {
    const WrittenRow file({{"X", {3}}, {"Y", {4}}, {"Z", {5}}}, {});
    EXPECT_FALSE(file.header().role_channels.contains("color"));
    const WrittenRow grey({{"Y", {4}}}, {});
    EXPECT_EQ(grey.header().role_channels.at("color"), std::vector<std::string>{"Y"});
}

TEST(XyzFilm, IsRecognisedByItsChromaticitiesAlone) {
    const WrittenRow file({{"X", {0.9505f}}, {"Y", {1}}, {"Z", {1.0891f}}, {"A", {0.5f}}},
                          {{"chromaticities", kXyzChromaticities}});
    EXPECT_EQ(file.header().roles, std::vector<std::string>{"color"});
    EXPECT_EQ(file.header().role_channels.at("color"), (std::vector<std::string>{"X", "Y", "Z", "A"}));
    EXPECT_EQ(file.image("color").at(0, 0, 3), 0.5f);
}

/// Positions and normals have such names, too; and what is called R, G and B beside them has its own
/// primaries.
TEST(XyzFilm, IsNoNameOfPositionsOrNormals) {
    const WrittenRow plain({{"X", {3}}, {"Y", {4}}, {"Z", {5}}, {"R", {1}}, {"G", {1}}, {"B", {1}}}, {});
    EXPECT_EQ(plain.header().role_channels.at("color"), (std::vector<std::string>{"R", "G", "B"}));
    const WrittenRow film({{"X", {0.9505f}},
                           {"Y", {1}},
                           {"Z", {1.0891f}},
                           {"pp.X", {3}},
                           {"pp.Y", {4}},
                           {"pp.Z", {5}},
                           {"albedo.R", {0.25f}},
                           {"albedo.G", {0.5f}},
                           {"albedo.B", {0.75f}}},
                          {{"generatedBy", kGeneratedBy}, {"chromaticities", kXyzChromaticities}});
    EXPECT_EQ(film.header().role_channels.at("color"), (std::vector<std::string>{"X", "Y", "Z"}));
    EXPECT_EQ(film.image("position").at(0, 0, 2), 5);
    EXPECT_NEAR(film.image("albedo").at(0, 0, 0), 0.25, 1e-6);
}

TEST(MitsubasAovs, AreRolesUnderTheScenesNames) {
    WrittenRow file({{"R", {1, 1, 1}},
                     {"G", {1, 1, 1}},
                     {"B", {1, 1, 1}},
                     {"far away.T", {4, 4, 0}},
                     {"nn.X", {0, 0, 0}},
                     {"nn.Y", {0, 0, 0}},
                     {"nn.Z", {1, 1, 0}},
                     {"si.I", {1, 1, 2.5f}}},
                    {{"generatedBy", kGeneratedBy}});
    EXPECT_EQ(file.header().roles, (std::vector<std::string>{"color", "depth", "normal", "object_id"}));
    EXPECT_EQ(file.header().role_channels.at("depth"), std::vector<std::string>{"far away.T"});
    file.sequence().camera.set("focal_length", 50);
    file.sequence().camera.set("sensor_width", 36);
    const Image depth = file.image("depth");
    EXPECT_NEAR(depth.at(1, 0, 0), 4.01, 1e-5);  // begins at the near plane, 1 cm ahead
    EXPECT_TRUE(std::isinf(depth.at(2, 0, 0)));
    const std::string message = capture_error([&] { file.image("object_id"); });
    EXPECT_NE(message.find("averaged over samples"), std::string::npos) << message;
}

TEST(DetectedAttributes, MayHaveToHoldAText) {
    const std::vector<StoredChannel> plain = {{"R", {1}}, {"G", {1}}, {"B", {1}}};
    EXPECT_EQ(WrittenRow(plain, {{"generatedBy", kGeneratedBy}}).header().profile, "mitsuba");
    EXPECT_EQ(WrittenRow(plain, {{"generatedBy", std::string("another program")}}).header().profile,
              "native");
}

TEST(PbrtsGBuffer, IsRecognisedInBothSpellings) {
    for (const bool is_old : {false, true}) {
        std::vector<StoredChannel> channels = {{"R", {1}},        {"G", {1}},       {"B", {1}},
                                               {"dzdx", {0}},     {"dzdy", {0}},    {"Albedo.R", {1}},
                                               {"Albedo.G", {1}}, {"Albedo.B", {1}}};
        for (const char* layer : {"P", "N", "Ns"})
            for (const char component : {'X', 'Y', 'Z'})
                channels.push_back({is_old ? std::string(layer) + char(std::tolower(component))
                                           : std::string(layer) + "." + component,
                                    {float(component - 'W')}});
        const WrittenRow file(channels, {});
        EXPECT_EQ(file.header().profile, "pbrt") << is_old;
        EXPECT_EQ(file.header().roles, (std::vector<std::string>{"albedo", "color", "normal", "position"}));
        EXPECT_EQ(file.image("position").at(0, 0, 2), 3);
    }
}

}  // namespace
}  // namespace aftershade::test
