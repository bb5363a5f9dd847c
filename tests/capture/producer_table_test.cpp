// What a person who knows the producer would say of each real file in producers and blender-versions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

using Names = std::vector<std::string>;

struct Expected {
    std::string file;  ///< in $AFTERSHADE_CAPTURES
    std::string profile;
    Names roles;
    Names cryptomattes = {};
    Names objects = {};  ///< some that the first Cryptomatte has
    std::map<std::string, double> camera = {};
    std::string lens_model = {};
    std::string layer = {};
    std::string view = {};                               ///< to ask for
    std::string chosen = "auto";                         ///< the profile to ask for
    std::map<std::string, std::string> role_files = {};  ///< to give beside it
};

/// Falcor writes a file for each pass, and none names its producer.
std::string falcor_pass(const std::string& pass) {
    return "producers/falcor/" + pass + ".0.exr";
}

Expected falcors_frame(const std::string& main, Names roles, std::map<std::string, std::string> role_files) {
    Expected row{falcor_pass(main), "falcor", std::move(roles)};
    row.chosen = "falcor";
    row.role_files = std::move(role_files);
    return row;
}

/// Nothing but its name says what a lone pass is: R, G and B are a colour until a role is named for them.
Expected of_one_pass(const std::string& pass) {
    return {falcor_pass(pass), "native", {"color"}};
}

const Names kCyclesPasses = {"albedo", "color",     "depth",    "emission", "irradiance",
                             "normal", "object_id", "position", "velocity", "velocity_next"};
const Names kCyclesMattes = {"ViewLayer.CryptoObject", "ViewLayer.CryptoMaterial"};
const Names kLayerMattes = {"Near objects.CryptoObject", "Far.CryptoMaterial", "Far.CryptoObject",
                            "Near objects.CryptoMaterial"};
const Names kSuzanneObjects = {"Suzanne", "Ball", "Floor", "Cube"};

const std::vector<Expected>& table() {
    static const std::vector<Expected> rows = {
        {"blender-versions/4.2.23/multi_0003.exr",
         "blender",
         kCyclesPasses,
         kCyclesMattes,
         kSuzanneObjects,
         {},
         "pinhole",
         "ViewLayer"},
        {"blender-versions/4.2.23/layers.exr",
         "blender",
         kCyclesPasses,
         kLayerMattes,
         {"Cylinder.016"},
         {},
         "pinhole",
         "Far"},
        {"blender-versions/4.2.23/multi_0004.exr",
         "blender",
         kCyclesPasses,
         kCyclesMattes,
         kSuzanneObjects,
         {},
         "pinhole",
         "ViewLayer"},
        {"blender-versions/5.2.3/multi_0003.exr",
         "blender",
         kCyclesPasses,
         kCyclesMattes,
         kSuzanneObjects,
         {},
         "pinhole",
         "ViewLayer"},
        {"blender-versions/5.2.3/multi_0004.exr",
         "blender",
         kCyclesPasses,
         kCyclesMattes,
         kSuzanneObjects,
         {},
         "pinhole",
         "ViewLayer"},
        {"blender-versions/5.2.3/layers.exr",
         "blender",
         kCyclesPasses,
         kLayerMattes,
         {"Cylinder.016"},
         {},
         "pinhole",
         "Far"},
        {"blender-versions/5.2.3/single.exr", "blender", {"color"}, {}, {}, {}, "pinhole"},
        {"producers/arnold/arnold75_N_P_aovs.exr", "arnold", {"color", "normal", "position", "specular"}},
        {"producers/arnold/arnold51_beauty_3crypto.exr",
         "arnold",
         {"color"},
         {"crypto_asset", "crypto_material", "crypto_object"},
         {"ball_asset", "toroidal_asset"}},
        {"producers/arnold/arnold75_deep.exr", "arnold", {"color", "depth"}},
        {"producers/arnold/arnold_three_crypto.exr",
         "arnold",
         {},
         {"crypto_asset", "crypto_material", "crypto_object"}},
        {"producers/vray/vray36_maya_crypto_normals.exr",
         "vray",
         {"albedo", "color", "emission", "normal", "specular"},
         {"uCryptoWildcard"},
         {"has_*_asterisk", "sphere_?_2"},
         {{"focal_length", 35}, {"sensor_width", 35.99992752}, {"f_number", 8}}},
        {"producers/karma/karma_cpu_solaris_one_crypto.exr",
         "karma",
         {"color"},
         {"CryptoObject"},
         {"/sphere1", "/cube1", "/grid1/mesh_0"}},
        {"producers/clarisse/clarisse_two_crypto.exr",
         "clarisse",
         {"color"},
         {"cryptomatte_material", "cryptomatte_asset"}},
        {"producers/nuke/channelTestNukeSinglePart.exr", "nuke", {"color", "depth"}},
        {"producers/nuke/channelTestNukePartPerLayer.exr", "nuke", {"color", "depth"}},
        {"producers/nuke/channelTestMultiViewNukePartPerView.exr", "nuke", {"color", "depth"}},
        {"producers/nuke/channelTestMultiViewNukePartPerView.exr",
         "nuke",
         {"color", "depth"},
         {},
         {},
         {},
         "",
         "",
         "left"},
        {"producers/nuke/channelTestMultiViewNukeSinglePart.exr", "nuke", {"color", "depth"}},
        {"producers/nuke/special_chars.exr",
         "arnold",
         {"color"},
         {"special_chars"},
         {"name, with, comma", "name_containing/slash", "\u0440\u0430\u0432\u043d\u0438\u043d\u0430"}},
        {falcor_pass("svgf.PathTracer.color"), "native", {"color"}},
        falcors_frame("svgf.PathTracer.color", {"color"}, {}),
        falcors_frame("svgf.PathTracer.color", {"color", "depth", "normal", "velocity"},
                      {{"depth", falcor_pass("svgf.GBufferRT.linearZ")},
                       {"normal", falcor_pass("svgf.GBufferRT.guideNormalW")},
                       {"velocity", falcor_pass("svgf.GBufferRT.mvec")}}),
        falcors_frame("arcade.GBufferRT.diffuseOpacity",
                      {"albedo", "color", "depth", "emission", "normal", "position", "velocity"},
                      {{"albedo", falcor_pass("arcade.GBufferRT.diffuseOpacity")},
                       {"depth", falcor_pass("arcade.GBufferRT.linearZ")},
                       {"emission", falcor_pass("arcade.GBufferRT.emissive")},
                       {"normal", falcor_pass("arcade.GBufferRT.normW")},
                       {"position", falcor_pass("arcade.GBufferRT.posW")},
                       {"velocity", falcor_pass("arcade.GBufferRT.mvec")}}),
        of_one_pass("arcade.GBufferRT.diffuseOpacity"),
        of_one_pass("arcade.GBufferRT.emissive"),
        of_one_pass("arcade.GBufferRT.linearZ"),
        of_one_pass("arcade.GBufferRT.mvec"),
        of_one_pass("arcade.GBufferRT.normW"),
        of_one_pass("arcade.GBufferRT.posW"),
        of_one_pass("arcade.GBufferRT.viewW"),
        of_one_pass("svgf.GBufferRT.guideNormalW"),
        of_one_pass("svgf.GBufferRT.linearZ"),
        of_one_pass("svgf.GBufferRT.mvec"),
        {"producers/gaffer/zero_offset_table.exr", "native", {"color"}},
        {"producers/gaffer/multipart_depth.Z.exr", "native", {"color", "depth"}},
    };
    return rows;
}

/// Every file that is there has a row, so that a new one cannot go unread.
TEST(ProducerTable, HasARowForEveryRealFile) {
    for (const char* folder : {"producers", "blender-versions"}) {
        AFTERSHADE_REQUIRE_CAPTURE(path, folder);
        for (const auto& entry : std::filesystem::recursive_directory_iterator(*path)) {
            if (entry.path().extension() != ".exr") continue;
            const std::string file =
                (std::filesystem::path(folder) / entry.path().lexically_relative(*path)).string();
            EXPECT_TRUE(std::any_of(table().begin(), table().end(), [&](const Expected& row) {
                return row.file == file;
            })) << file;
        }
    }
}

class ProducerTableOf : public testing::TestWithParam<Expected> {};

TEST_P(ProducerTableOf, SaysWhatTheFileHolds) {
    const Expected& row = GetParam();
    AFTERSHADE_REQUIRE_CAPTURE(path, row.file);
    Sequence sequence;
    sequence.files = FramePattern(path->string());
    sequence.view = row.view;
    sequence.profile = row.chosen;
    for (const auto& [role, file] : row.role_files) {
        AFTERSHADE_REQUIRE_CAPTURE(role_path, file);
        sequence.role_files.insert_or_assign(role, FramePattern(role_path->string()));
    }
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    const CaptureHeader header = reader.read_header(1);
    EXPECT_EQ(header.profile, row.profile) << header.profile_reason;
    EXPECT_EQ(header.roles, row.roles);
    EXPECT_EQ(header.layer, row.layer);
    EXPECT_EQ(header.camera.lens_model, row.lens_model);
    for (const auto& [field, value] : row.camera)
        EXPECT_NEAR(header.camera.get(field).value_or(-1), value, 1e-4) << field;

    Names mattes;
    for (const CryptomatteLayer& matte : reader.cryptomattes(1)) mattes.push_back(matte.name);
    EXPECT_EQ(mattes, row.cryptomattes);
    if (mattes.empty()) return;
    const auto objects = reader.cryptomatte_coverage(1, mattes.front());
    for (const std::string& name : row.objects)
        EXPECT_TRUE(std::any_of(objects.begin(), objects.end(), [&](const auto& o) {
            return o.name == name;
        })) << name;
    // Every pixel is covered once at most, and what the manifest names is what the pixels have.
    double covered_px = 0;
    for (const ObjectCoverage& object : objects) covered_px += object.coverage_px;
    const double pixels = double(header.data_window.width()) * header.data_window.height();
    EXPECT_GT(covered_px, 0);
    EXPECT_LE(covered_px, pixels * 1.001);
}

INSTANTIATE_TEST_SUITE_P(RealFiles, ProducerTableOf, testing::ValuesIn(table()), [](const auto& row) {
    std::string name =
        row.param.file + row.param.view + row.param.chosen + std::to_string(row.param.role_files.size());
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
    return name;
});

TEST(ShippedProfiles, ClaimOnlyRealFilesThatTestsCanRead) {
    Diagnostics diagnostics;
    for (const Profile& profile : read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics)) {
        const auto is_verified = [](const ProfileFact& fact) { return !fact.verified.empty(); };
        EXPECT_EQ(std::any_of(profile.facts.begin(), profile.facts.end(), is_verified),
                  !profile.seen_on.empty())
            << profile.id;
        for (const std::string& file : profile.seen_on) {
            AFTERSHADE_REQUIRE_CAPTURE(path, file);
            EXPECT_TRUE(std::filesystem::exists(*path)) << profile.id << ": " << file;
        }
    }
}

/// 16 x 16 px of a constant each, by Gaffer's own tests: the layer depth has 0.09998, character's Z 0.5.
TEST(NukesPartPerLayer, HasTheDepthOfThePartThatIsCalledDepth) {
    AFTERSHADE_REQUIRE_CAPTURE(path, "producers/nuke/channelTestNukePartPerLayer.exr");
    Sequence sequence;
    sequence.files = FramePattern(path->string());
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    const Capture capture = reader.read(1, Names{"depth"});
    EXPECT_NEAR(capture.images.at("depth").at(3, 3, 0), 0.09998, 1e-5);
}

}  // namespace
}  // namespace aftershade::test
