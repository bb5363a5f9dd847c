#include "framework/capture/profile.h"

#include <algorithm>
#include <map>

#include "tests/capture/capture_files.h"

namespace aftershade {
namespace {

using test::faults_of;
using test::Lines;
using test::profile_from;

const std::string kHead = R"({"aftershade": 1, "id": "x", "summary": ".", "detect": {}, "roles": {)";

ExrPart part_with(const std::vector<std::string>& channels) {
    ExrPart part;
    for (const std::string& name : channels) part.channels.push_back({name, PixelType::half, 1, 1});
    return part;
}

/// The header of a written file, for attributes.
ExrPart part_with_attribute(const std::vector<std::string>& channels, const std::string& attribute) {
    const test::TemporaryFolder folder;
    std::vector<test::StoredChannel> stored;
    for (const std::string& name : channels) stored.push_back({name, {0}});
    test::write_channels(folder / "f.exr", 1, stored, {{attribute, std::string("yes")}});
    return ExrFile(folder / "f.exr").parts().front();
}

Profile detecting(const std::string& id, const std::string& rule) {
    return profile_from(
        R"({"aftershade": 1, "summary": ".", "id": ")" + id + R"(", "detect": )" + rule +
        R"(, "roles": {"color": {"channels": ["{layer}.R|R", "{layer}.G|G", "{layer}.B|B", "A?"]}}})");
}

std::vector<Profile> shipped() {
    Diagnostics diagnostics;
    auto profiles = read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    EXPECT_EQ(test::lines_of(diagnostics), Lines{});
    return profiles;
}

const Profile& by_id(const std::vector<Profile>& profiles, const std::string& id) {
    return *std::find_if(profiles.begin(), profiles.end(), [&](const Profile& p) { return p.id == id; });
}

TEST(Profile, IsDetectedByAnAttributeFirst) {
    const std::vector<Profile> profiles = {detecting("plain", R"({"channels": ["R", "G", "B"]})"),
                                           detecting("marked", R"({"attributes": ["no", "mark"]})")};
    const ProfileChoice choice =
        detect_profile(profiles, part_with_attribute({"R", "G", "B"}, "mark"), "f.exr");
    EXPECT_EQ(choice.profile->id, "marked");
    EXPECT_EQ(choice.reason, "attribute mark");
}

TEST(Profile, IsDetectedByAllOfItsChannels) {
    const std::vector<Profile> profiles = {detecting("one", R"({"channels": ["R", "special"]})"),
                                           detecting("two", R"({"channels": ["R", "G"]})")};
    const ProfileChoice choice = detect_profile(profiles, part_with({"R", "G", "B"}), "f.exr");
    EXPECT_EQ(choice.profile->id, "two");
    EXPECT_TRUE(choice.reason.starts_with("channel ")) << choice.reason;
}

TEST(Profile, ThatFitsAlikeWithAnotherIsTheUsersChoice) {
    const std::vector<Profile> profiles = {detecting("one", R"({"channels": ["R"]})"),
                                           detecting("two", R"({"channels": ["G"]})")};
    const std::string message = test::error_of(ErrorKind::usage, [&] {
        detect_profile(profiles, part_with({"R", "G", "B"}), "f.exr");
    });
    EXPECT_EQ(message,
              "f.exr: the profiles 'one' and 'two' fit alike (name one with profile, or as 'profile' in "
              "capture.json)");
    const std::vector<Profile> marked = {detecting("a", R"({"attributes": ["mark"]})"),
                                         detecting("b", R"({"attributes": ["mark"]})")};
    test::error_of(ErrorKind::usage,
                   [&] { detect_profile(marked, part_with_attribute({"R"}, "mark"), "f.exr"); });
}

TEST(Profile, ThatFitsIsAskedForWhereNoneDoes) {
    const std::string message =
        test::error_of(ErrorKind::capture, [&] { detect_profile(shipped(), part_with({"foo"}), "f.exr"); });
    EXPECT_EQ(message,
              "f.exr: no profile fits its channels, 'foo' (name one with profile, or name the channels of "
              "each role as \"channels\": {\"color\": {\"channels\": [\"NAME\", \"NAME\", \"NAME\"]}} in "
              "capture.json)");
    // A profile without a rule fits nothing of itself.
    const std::vector<Profile> without_rule = {detecting("quiet", "{}")};
    test::error_of(ErrorKind::capture, [&] {
        detect_profile(without_rule, part_with({"R", "G", "B"}), "f.exr");
    });
}

TEST(Profile, OfTheShippedOnesIsFoundByWhatFilesReallyHold) {
    const auto profiles = shipped();
    EXPECT_EQ(detect_profile(profiles, part_with({"B", "G", "R"}), "f").profile->id, "native");
    const auto blender = part_with({"View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Depth.Z"});
    EXPECT_EQ(detect_profile(profiles, blender, "f").profile->id, "blender");
    // Each beside an R, G and B that native reads, too.
    for (const auto& [id, channels] : std::map<std::string, std::vector<std::string>>{
             {"unreal", {"R", "G", "B", "A", "FinalImageMovieRenderQueue_WorldDepth.R"}},
             {"unity", {"R", "G", "B", "Beauty.R", "Depth.R", "Motion Vectors.R"}},
             {"falcor", {"R", "G", "B", "mvec.R", "mvec.G", "linearZ.R"}},
             {"arnold", {"R", "G", "B", "Z", "motionvector.R"}}})
        EXPECT_EQ(detect_profile(profiles, part_with(channels), "f").profile->id, id);
    const ExrFile real(AFTERSHADE_SOURCE_DIR "/scenes/suzanne/gbuffer_0004.exr");
    const ProfileChoice choice = detect_profile(profiles, real.parts().front(), "f");
    EXPECT_EQ(choice.profile->id, "blender");
    EXPECT_EQ(choice.reason, "attribute BlenderMultiChannel");
}

TEST(Profile, FindsTheLayerThatItsColourLiesIn) {
    const Profile blender = by_id(shipped(), "blender");
    EXPECT_EQ(find_layer(blender, part_with({"My.Layer.Combined.R", "My.Layer.Depth.Z"})), "My.Layer");
    EXPECT_EQ(find_layer(blender, part_with({"R", "G", "B"})), "");
    EXPECT_EQ(find_layer(by_id(shipped(), "native"), part_with({"x.R", "R"})), "");
}

TEST(Profile, TakesTheFirstAlternativeThatTheFileHas) {
    const RoleDecoding depth = by_id(shipped(), "blender").roles.at("depth");
    EXPECT_EQ(find_channels(depth, "L", part_with({"L.Depth.Z"})), (FoundChannels{{"L.Depth.Z"}}));
    EXPECT_EQ(find_channels(depth, "L", part_with({"L.Depth.V"})), (FoundChannels{{"L.Depth.V"}}));
    EXPECT_EQ(find_channels(depth, "L", part_with({"L.Depth.V", "L.Depth.Z"})),
              (FoundChannels{{"L.Depth.Z"}}));
    EXPECT_EQ(find_channels(depth, "L", part_with({"M.Depth.Z", "Depth.Z"})), std::nullopt);
}

TEST(Profile, DoesWithoutOptionalChannelsOnly) {
    const RoleDecoding color = by_id(shipped(), "native").roles.at("color");
    EXPECT_EQ(find_channels(color, "", part_with({"A", "B", "G", "R"})),
              (FoundChannels{{"R", "G", "B", "A"}}));
    EXPECT_EQ(find_channels(color, "", part_with({"B", "G", "R"})), (FoundChannels{{"R", "G", "B", ""}}));
    EXPECT_EQ(find_channels(color, "", part_with({"A", "G", "R"})), std::nullopt);
}

struct BrokenDecoding {
    std::string roles;
    std::string message;
};

const std::vector<BrokenDecoding> kBroken = {
    {R"("velocity": {"channels": ["u", "v"], "delta": "next-cur"})",
     "role 'velocity' cannot be decoded from 'next-cur': 'next' vectors fill velocity_next and no other "
     "role"},
    {R"("velocity": {"channels": ["u", "v"], "delta": "cur-next"})",
     "role 'velocity' cannot be decoded from 'cur-next': 'next' vectors fill velocity_next and no other "
     "role"},
    {R"("velocity_next": {"channels": ["u", "v"], "delta": "cur-prev"})",
     "role 'velocity_next' cannot be decoded from 'cur-prev': 'next' vectors fill velocity_next and no other "
     "role"},
    {R"("velocity_next": {"channels": ["u", "v"], "delta": "prev-cur"})",
     "role 'velocity_next' cannot be decoded from 'prev-cur': 'next' vectors fill velocity_next and no other "
     "role"},
    {R"("velocity": {"channels": ["u", "v"], "delta": "cur-prv"})",
     "'delta' is 'cur-prv' but must be 'cur-prev', 'prev-cur', 'next-cur' or 'cur-next'; did you mean "
     "'cur-prev'?"},
    {R"("velocity": {"channels": ["u", "v"], "y_axis": "sideways"})",
     "'y_axis' is 'sideways' but must be 'up' or 'down'"},
    {R"("velocity": {"channels": ["u"]})", "role 'velocity' has 2 channels, not 1"},
    {R"("irradiance": {"sum": [["r", "g", "b"], ["r"]]})", "role 'irradiance' has 3 channels, not 1"},
    {R"("mask": {"channels": [1]})", "'channels' holds strings, not an integer"},
    {R"("depht": {"channels": ["Z"]})", "'depht' is not a role; did you mean 'depth'?"},
    {R"("depth": {"channels": ["Z"], "no_hti": 1})",
     "the decoding of 'depth' has no key 'no_hti'; did you mean 'no_hit'?"},
    {R"("albedo": {"channels": ["r", "g", "b"], "no_hit": 2})",
     "the decoding of 'albedo' has no key 'no_hit'"},
    {R"("color": {"channels": ["r", "g", "b", "a"], "delta": "cur-prev"})",
     "the decoding of 'color' has no key 'delta'"},
};

TEST(Profile, SaysWhatIsWrongWithADecoding) {
    for (const BrokenDecoding& broken : kBroken) {
        const Lines lines = faults_of("\n" + kHead + "\n" + broken.roles + "}}",
                                      [](const Node& node, Diagnostics& d) { parse_profile(node, d); });
        const auto found = std::find_if(lines.begin(), lines.end(), [&](const std::string& line) {
            return line.find(broken.message) != std::string::npos;
        });
        ASSERT_NE(found, lines.end()) << broken.message << "\n"
                                      << (lines.empty() ? "no fault" : lines.front());
        EXPECT_TRUE(found->starts_with("doc.json:3:")) << *found;
    }
}

TEST(Profile, NeedsIdSummaryDetectAndRoles) {
    const auto read = [](const Node& node, Diagnostics& diagnostics) { parse_profile(node, diagnostics); };
    EXPECT_EQ(faults_of(R"({"aftershade": 1, "rolls": {}})", read),
              (Lines{"doc.json:1:1: error: the profile has no 'id'",
                     "doc.json:1:1: error: the profile has no 'summary'",
                     "doc.json:1:1: error: the profile has no 'detect'",
                     "doc.json:1:1: error: the profile has no 'roles'",
                     "doc.json:1:19: error: the profile has no key 'rolls'; did you mean 'roles'?"}));
}

TEST(Profile, OfBlenderSaysForEachRoleThatItDecodesWhichPassToTick) {
    const std::vector<Profile> profiles = shipped();
    const Profile& blender = by_id(profiles, "blender");
    for (const auto& [role, decoding] : blender.roles)
        if (role != "color") {
            EXPECT_TRUE(blender.remedies.contains(role)) << role;
        }
    for (const auto& [role, remedy] : blender.remedies)
        EXPECT_NE(remedy.find(" ticked in View Layer Properties > Passes > "), std::string::npos) << remedy;
}

TEST(Profile, FolderListsTheFaultsOfAllItsFiles) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "a.json", "{");
    test::write_text(folder / "b.json", kHead + "}}");
    test::write_text(folder / "c.json", "[]");
    test::write_text(folder / "notes.txt", "not a profile");
    Diagnostics diagnostics;
    const auto profiles = read_profiles(folder.path(), diagnostics);
    ASSERT_EQ(profiles.size(), 1U);
    EXPECT_EQ(profiles[0].id, "x");
    ASSERT_EQ(diagnostics.error_count(), 2);
    EXPECT_EQ(diagnostics.all()[0].place.file, (folder / "a.json").string());
    EXPECT_EQ(diagnostics.all()[1].place.file, (folder / "c.json").string());

    Diagnostics no_folder;
    EXPECT_TRUE(read_profiles(folder / "none", no_folder).empty());
    EXPECT_TRUE(no_folder.has_errors());
}

}  // namespace
}  // namespace aftershade
