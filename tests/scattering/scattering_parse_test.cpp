// Scattering profiles and values of their parameter type as documents write them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "framework/base/data_path.h"
#include "framework/document/param_type.h"
#include "framework/scattering/param_scattering.h"
#include "tests/document/param_specs.h"
#include "tests/scattering/scattering_profiles.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

using test::Lines;
using test::profile_of;
using test::value_faults;
using test::value_of;
using Type = ScatteringProfile::Type;

/// The parameter "p" where scattering_profile is a type.
const ParamType kTypes[] = {kScatteringParam};
ParamSpec spec_of(const std::string& declaration) {
    return test::spec_of(declaration, "p", kTypes);
}
Lines spec_faults(const std::string& declaration) {
    return test::spec_faults(declaration, kTypes);
}
ScatteringValue scattering_value_of(const ParamSpec& spec, const std::string& value) {
    return *scattering_of(value_of(spec, value));
}

const std::string kThree = R"({"type": "gaussians", "gaussians": [
    {"variance_mm2": 0.25, "weight": [0.5, 1, 0.25]}, {"variance_mm2": [4, 5, 6], "weight": [0.5, 0, 0.75]}]})";

Lines profile_faults(const std::string& text, const std::filesystem::path& folder = ".") {
    return test::faults_of(text, [&](const Node& node, Diagnostics& diagnostics) {
        EXPECT_FALSE(parse_scattering_profile(node, "p", folder, diagnostics).has_value()) << text;
    });
}

TEST(ScatteringProfileDocument, TakesEveryForm) {
    EXPECT_EQ(profile_of(R"({"type": "burley", "d_mm": [1, 2, 3]})").d_mm, (Rgb{1, 2, 3}));
    EXPECT_EQ(profile_of(R"({"type": "burley", "d_mm": 0.5})").d_mm, (Rgb{0.5, 0.5, 0.5}));
    const std::string path = R"({"type": "burley", "albedo": [0.1, 0.5, 1], "mean_free_path_mm": [2, 3, 4])";
    for (const auto& [mapping, kind] : std::vector<std::pair<std::string, BurleyMapping>>{
             {R"(, "mapping": "searchlight")", BurleyMapping::searchlight},
             {R"(, "mapping": "diffuse")", BurleyMapping::diffuse},
             {R"(, "mapping": "dmfp")", BurleyMapping::dmfp},
             {"", BurleyMapping::dmfp}}) {
        const Rgb d = {burley_d_mm(kind, 0.1, 2), burley_d_mm(kind, 0.5, 3), burley_d_mm(kind, 1, 4)};
        EXPECT_EQ(profile_of(path + mapping + "}").d_mm, d) << mapping;
    }
    const ScatteringProfile gaussians = profile_of(kThree);
    EXPECT_EQ(gaussians.type, Type::gaussians);
    EXPECT_EQ(gaussians.gaussians, (std::vector<ScatteringGaussian>{{{0.25, 0.25, 0.25}, {0.5, 1, 0.25}},
                                                                    {{4, 5, 6}, {0.5, 0, 0.75}}}));
    const ScatteringProfile dipole =
        profile_of(R"({"type": "dipole", "absorption_per_mm": 0.5, "reduced_scattering_per_mm": [1, 2, 3]})");
    EXPECT_EQ(dipole.type, Type::dipole);
    EXPECT_EQ(dipole.absorption, (Rgb{0.5, 0.5, 0.5}));
    EXPECT_EQ(dipole.scattering, (Rgb{1, 2, 3}));
    EXPECT_EQ(dipole.ior, 1.3);
    const ScatteringProfile artist =
        profile_of(R"({"type": "artist", "falloff": [0, 0.5, 1], "strength": 0.25, "width_mm": 4})");
    EXPECT_EQ(artist.type, Type::artist);
    EXPECT_EQ(artist.falloff_mm, (Rgb{0.004, 4 * 0.501, 4 * 1.001}));
    EXPECT_EQ(artist.direct, (Rgb{0.75, 0.75, 0.75}));
}

TEST(ScatteringProfileDocument, MakesWeightsThatNearlySumToOneSumToOne) {
    const auto profile = profile_of(R"({"type": "gaussians", "gaussians": [
        {"variance_mm2": 1, "weight": 0.333}, {"variance_mm2": 2, "weight": 0.66}]})");
    EXPECT_DOUBLE_EQ(profile.gaussians[0].weight[1], 0.333 / 0.993);
    EXPECT_DOUBLE_EQ(profile.within(0, 1e3), 1);
}

TEST(ScatteringProfileDocument, OfNoKnownTypeSaysWhichThereAre) {
    EXPECT_EQ(profile_faults("[]"),
              Lines{"doc.json:1:1: error: p: expected the name of a scattering profile, the path "
                    "of its file or an object with 'type', not an array"});
    EXPECT_EQ(profile_faults("{}"), Lines{"doc.json:1:1: error: p has no 'type'"});
    EXPECT_EQ(profile_faults(R"({"type": "burly"})"),
              Lines{"doc.json:1:10: error: 'type' is 'burly' but must be 'burley', 'gaussians', 'dipole' or "
                    "'artist'; "
                    "did you mean 'burley'?"});
    EXPECT_EQ(profile_faults(R"({"type": 3})"),
              Lines{"doc.json:1:10: error: 'type' must be a string, not an integer"});
}

TEST(ScatteringProfileDocument, OfBurleySaysWhatIsWrong) {
    EXPECT_EQ(profile_faults(R"({"type": "burley"})"),
              Lines{"doc.json:1:1: error: p has one of 'd_mm' and 'mean_free_path_mm'"});
    EXPECT_EQ(profile_faults(R"({"type": "burley", "mean_free_path_mm": 1})"),
              Lines{"doc.json:1:1: error: p has all or none of 'albedo' and 'mean_free_path_mm'"});
    EXPECT_EQ(profile_faults(R"({"type": "burley", "d_mm": [1, 2],
"albedo": 0.5, "mean_free_path_mm": 1, "mapping": "diffuse", "d": 3})"),
              (Lines{"doc.json:1:28: error: p.d_mm: expected an array of 3 numbers, or one number for all",
                     "doc.json:1:1: error: p has one of 'd_mm' and 'mean_free_path_mm'",
                     "doc.json:2:62: error: p has no key 'd'"}));
    EXPECT_EQ(
        profile_faults(
            R"({"type": "burley", "albedo": [1.5, "x", -1], "mean_free_path_mm": 0, "mapping": "mfp"})"),
        (Lines{"doc.json:1:31: error: p.albedo: 1.5 is above the maximum 1",
               "doc.json:1:36: error: p.albedo: 'x' is not a number",
               "doc.json:1:41: error: p.albedo: -1 is below the minimum 0",
               "doc.json:1:67: error: p.mean_free_path_mm: 0 is below the minimum 1e-06",
               "doc.json:1:81: error: 'mapping' is 'mfp' but must be 'searchlight', 'diffuse' or 'dmfp'; did "
               "you mean "
               "'dmfp'?"}));
}

TEST(ScatteringProfileDocument, OfGaussiansSaysWhatIsWrong) {
    EXPECT_EQ(profile_faults(R"({"type": "gaussians"})"), Lines{"doc.json:1:1: error: p has no 'gaussians'"});
    EXPECT_EQ(profile_faults(R"({"type": "gaussians", "gaussians": []})"),
              Lines{"doc.json:1:36: error: 'gaussians' holds 1 to 8 items, not 0"});
    EXPECT_EQ(
        profile_faults(R"({"type": "gaussians", "gaussians": [
{"variance_mm2": 1, "weight": [0.5, 0.5, 0.25]},
{"variance_mm2": 2, "weight": [0.5, 0.375, 0.25]}]})"),
        (Lines{
            "doc.json:1:36: error: p: the weights of green sum to 0.875 but must sum to 1: a profile has no "
            "albedo",
            "doc.json:1:36: error: p: the weights of blue sum to 0.5 but must sum to 1: a profile has no "
            "albedo"}));
    EXPECT_EQ(profile_faults(R"({"type": "gaussians", "gaussians": [3,
{"variance_mm2": 0, "weight": 2, "mean": 1}, {"weight": 1}]})"),
              (Lines{"doc.json:1:37: error: p.gaussians[0] must be an object, not an integer",
                     "doc.json:2:18: error: p.gaussians[1].variance_mm2: 0 is below the minimum 1e-12",
                     "doc.json:2:31: error: p.gaussians[1].weight: 2 is above the maximum 1",
                     "doc.json:2:34: error: p.gaussians[1] has no key 'mean'",
                     "doc.json:2:46: error: p.gaussians[2] has no 'variance_mm2'"}));
}

TEST(ScatteringProfileDocument, OfADipoleOrAnArtistSaysWhatIsWrong) {
    EXPECT_EQ(profile_faults(R"({"type": "dipole", "ior": 0.5, "d_mm": 1})"),
              (Lines{"doc.json:1:1: error: p has no 'absorption_per_mm'",
                     "doc.json:1:1: error: p has no 'reduced_scattering_per_mm'",
                     "doc.json:1:27: error: 'ior' must be from 1 to 3, not 0.5",
                     "doc.json:1:32: error: p has no key 'd_mm'; it is a key of type 'burley'"}));
    EXPECT_EQ(profile_faults(R"({"type": "dipole", "absorption_per_mm": 0, "reduced_scattering_per_mm": 1})"),
              Lines{"doc.json:1:41: error: p.absorption_per_mm: 0 is below the minimum 1e-05"});
    EXPECT_EQ(
        profile_faults(
            R"({"type": "artist", "falloff": 2, "strength": [0, 1, 1], "width_mm": "3 mm", "width": 1})"),
        (Lines{"doc.json:1:31: error: p.falloff: 2 is above the maximum 1",
               "doc.json:1:47: error: p.strength: 0 is below the minimum 0.001",
               "doc.json:1:69: error: 'width_mm' must be a number, not a string",
               "doc.json:1:77: error: p has no key 'width'; did you mean 'width_mm'?"}));
}

/// Profiles of a data folder of the test's own, and a folder of a user's files.
class ScatteringProfileFiles : public testing::Test {
protected:
    void SetUp() override {
        std::filesystem::create_directories(data_ / "effects");
        std::filesystem::create_directories(data_ / "profiles/scattering");
        for (const char* name : {"skin", "marble", "milk"})
            test::write_text(data_ / "profiles/scattering" / (std::string(name) + ".json"),
                             R"({"aftershade": 1, "summary": ".", "type": "burley", "d_mm": 2})");
        setenv("AFTERSHADE_DATA", data_.path().c_str(), 1);
    }
    void TearDown() override { unsetenv("AFTERSHADE_DATA"); }

    test::TemporaryFolder data_, user_;
};

TEST_F(ScatteringProfileFiles, AreFoundByNameAndByPath) {
    EXPECT_EQ(scattering_profile_names(), (std::vector<std::string>{"marble", "milk", "skin"}));
    EXPECT_EQ(profile_of("\"marble\"").name, "marble");
    test::write_text(user_ / "wax.json",
                     R"({"$schema": "x", "aftershade": 1, "summary": "Wax.", "sources": ["me"],
        "type": "burley", "d_mm": [3, 4, 5]})");
    Diagnostics diagnostics;
    const auto wax = parse_scattering_profile(test::parsed("\"wax.json\""), "p", user_.path(), diagnostics);
    ASSERT_TRUE(wax.has_value());
    EXPECT_EQ(wax->name, "wax.json");
    EXPECT_EQ(wax->d_mm, (Rgb{3, 4, 5}));
    const auto absolute = parse_scattering_profile(test::parsed("\"" + (user_ / "wax.json").string() + "\""),
                                                   "p", "elsewhere", diagnostics);
    ASSERT_TRUE(absolute.has_value());
    EXPECT_EQ(absolute->d_mm, wax->d_mm);
    EXPECT_FALSE(diagnostics.has_errors());
}

TEST_F(ScatteringProfileFiles, ThatAreNotThereAreNamedWithThoseThatAre) {
    EXPECT_EQ(profile_faults("\"marbel\""), Lines{"doc.json:1:1: error: p: no scattering profile 'marbel'; "
                                                  "did you mean 'marble'?; shipped: 'marble', "
                                                  "'milk' and 'skin'; a file's name ends in .json"});
    EXPECT_EQ(profile_faults("\"wax.json\"", user_.path()),
              Lines{"doc.json:1:1: error: p: no file '" + (user_ / "wax.json").string() + "'"});
    EXPECT_EQ(profile_faults("\"../effects\"").size(), 1u);
}

TEST_F(ScatteringProfileFiles, OfAParameterLieBesideItsDocumentOrFromWhereTheProgramRuns) {
    test::write_text(user_ / "wax.json", R"({"aftershade": 1, "summary": ".", "type": "burley", "d_mm": 3})");
    const ParamSpec spec = spec_of(R"({"type": "scattering_profile", "default": "skin", "doc": "."})");
    const auto read = [&](const std::string& path, const Place& place) {
        Node node = test::parsed("\"" + path + "\"");
        node.place = place;
        Diagnostics diagnostics;
        return parse_param_value(spec, node, "p", diagnostics).has_value();
    };
    const std::string document = (user_ / "look.json").string(),
                      set = "--set sss.p=" + (user_ / "x").string();
    EXPECT_TRUE(read("wax.json", {document, 3, 1}));
    EXPECT_FALSE(read("wax.json", {set}));
    EXPECT_TRUE(read(std::filesystem::proximate(user_ / "wax.json").string(), {set}));
}

TEST_F(ScatteringProfileFiles, SayWhatIsWrongAtTheirOwnPlace) {
    const std::string file = (user_ / "wax.json").string();
    const auto faults = [&](const std::string& text) {
        test::write_text(file, text);
        return profile_faults("\"wax.json\"", user_.path());
    };
    EXPECT_EQ(faults(R"({"type": "burley", "d_mm": 1})"),
              (Lines{file + ":1:1: error: the scattering profile has no 'aftershade'",
                     file + ":1:1: error: the scattering profile has no 'summary'"}));
    EXPECT_EQ(faults(R"({"aftershade": 2, "summary": ".",
"type": "burley", "d_mm": -1, "name": "wax"})"),
              (Lines{file + ":1:16: error: document version 2 is not known; this program reads version 1",
                     file + ":2:27: error: d_mm: -1 is below the minimum 1e-06",
                     file + ":2:31: error: the scattering profile has no key 'name'"}));
    EXPECT_EQ(faults("[]"),
              Lines{file + ":1:1: error: the scattering profile must be an object, not an array"});
    EXPECT_EQ(faults("{").size(), 1u);
}

TEST(ScatteringProfileText, ReadsBackAsItself) {
    for (
        const std::string& text :
        {std::string(R"({"type": "burley", "d_mm": [1, 0.25, 3e-05]})"), std::string("\"skin\""),
         std::string(
             R"({"type": "gaussians", "gaussians": [{"variance_mm2": [0.25, 1, 2], "weight": [0.5, 1, 0.25]}, )"
             R"({"variance_mm2": [4, 5, 6], "weight": [0.5, 0, 0.75]}]})"),
         std::string(R"({"type": "dipole", "absorption_per_mm": [0.1, 0.2, 0.3], )"
                     R"("reduced_scattering_per_mm": [1, 2, 3], "ior": 1.5})"),
         std::string(
             R"({"type": "artist", "falloff": [1, 0.37, 0.3], "strength": [0.48, 0.41, 0.28], "width_mm": 2.5})")}) {
        EXPECT_EQ(format_scattering_profile(profile_of(text)), text);
        EXPECT_EQ(profile_of(format_scattering_profile(profile_of(text))), profile_of(text));
    }
}

ParamSpec profile_spec() {
    return spec_of(R"({"type": "scattering_profile", "default": {"type": "burley", "d_mm": 1}, "doc": "."})");
}

TEST(ScatteringParam, IsOneProfileOrRowsByObject) {
    const ParamSpec spec = profile_spec();
    EXPECT_EQ(scattering_of(spec.default_value)->usual.d_mm, (Rgb{1, 1, 1}));
    const auto value = scattering_value_of(spec, R"({"default": "skin", "rows": [
        {"objects": "3-7,9", "profile": {"type": "burley", "d_mm": 2}},
        {"name": "Ear", "profile": {"type": "dipole", "absorption_per_mm": 1, "reduced_scattering_per_mm": 2}},
        {"object": 1, "profile": {"type": "burley", "d_mm": 2}}]})");
    EXPECT_EQ(value.usual.name, "skin");
    ASSERT_EQ(value.rows.size(), 4u);
    EXPECT_EQ(value.rows[0].first, (TableKey{3, 7, ""}));
    EXPECT_EQ(value.rows[1].first, (TableKey{9, 9, ""}));
    EXPECT_EQ(value.rows[2].first, (TableKey{0, 0, "Ear"}));
    EXPECT_EQ(value.rows[1].second.d_mm, (Rgb{2, 2, 2}));
    const auto profiles = scattering_profiles_of(value);
    ASSERT_EQ(profiles.size(), 3u) << "two rows have one";
    EXPECT_EQ(profiles[2].type, Type::dipole);
    EXPECT_FALSE(is_burley(value));
    EXPECT_TRUE(is_burley(*scattering_of(spec.default_value)));
}

TEST(ScatteringParam, GivesShadersARowForEachKey) {
    const auto value = scattering_value_of(profile_spec(), R"({"default": {"type": "artist"}, "rows": [
        {"object": 4, "profile": {"type": "burley", "d_mm": [1, 2, 3]}}]})");
    const TableValue table = scattering_table(value);
    const ScatteringProfile artist = profile_of(R"({"type": "artist"})");
    EXPECT_EQ(table.default_row[0], std::vector<double>{0});
    EXPECT_EQ(table.default_row[2], (std::vector<double>{artist.direct.begin(), artist.direct.end()}));
    EXPECT_EQ(table.default_row[3],
              (std::vector<double>{artist.falloff_mm.begin(), artist.falloff_mm.end()}));
    ASSERT_EQ(table.rows.size(), 1u);
    EXPECT_EQ(table.rows[0].first, (TableKey{4, 4, ""}));
    EXPECT_EQ(table.rows[0].second[0], std::vector<double>{1});
    EXPECT_EQ(table.rows[0].second[1], (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(table.rows[0].second[2], (std::vector<double>{0, 0, 0}));
    EXPECT_NEAR(table.rows[0].second[4][0], 9 * std::log(0.75 / 1e-4), 1e-3) << "of the widest d, 3 mm";
}

TEST(ScatteringParam, SaysWhatIsWrongWithEachRow) {
    const ParamSpec spec = profile_spec();
    EXPECT_EQ(
        value_faults(spec, R"({"default": "skin", "rows": [{"object": 1, "profile": 4}, {"objects": "7-3"},
{"name": "a", "profile": {"type": "burley", "d_mm": 0}, "profil": 1},
{"object": 2, "name": "b", "profile": "skin"}]})",
                     "sss.profile"),
        (Lines{
            "doc.json:1:55: error: sss.profile.rows[0]: expected the name of a scattering profile, the "
            "path of "
            "its file or an object with 'type', not an integer",
            "doc.json:1:59: error: sss.profile.rows[1] has no 'profile'",
            "doc.json:1:71: error: sss.profile.rows[1]: '7-3' is not a range of ids; write \"3-7,9\", each "
            "from 0 "
            "to 4294967295 and rising",
            "doc.json:2:53: error: sss.profile.rows[2].d_mm: 0 is below the minimum 1e-06",
            "doc.json:2:57: error: sss.profile.rows[2] has no key 'profil'; did you mean 'profile'?",
            "doc.json:3:1: error: sss.profile.rows[3]: a row has one of 'object', 'objects' and 'name', "
            "not 2"}));
    EXPECT_EQ(
        value_faults(spec,
                     R"({"default": {"type": "burley", "d_mm": 0}, "rows": [{"object": 2}, 4], "row": []})",
                     "sss.profile"),
        (Lines{"doc.json:1:40: error: sss.profile.default.d_mm: 0 is below the minimum 1e-06",
               "doc.json:1:53: error: sss.profile.rows[0] has no 'profile'",
               "doc.json:1:68: error: sss.profile.rows[1] must be an object, not an integer",
               "doc.json:1:72: error: sss.profile has no key 'row'; did you mean 'rows'?"}));
    EXPECT_EQ(value_faults(spec, R"({"rows": []})"), Lines{"doc.json:1:1: error: p has no 'default'"});
    EXPECT_EQ(value_faults(spec, R"({"default": "skin", "rows": [{"object": 2, "profile": "skin"},
{"objects": "1-3", "profile": "skin"}]})"),
              Lines{"doc.json:2:1: error: p.rows[1]: objects 1-3 is taken already by object 2 of p.rows[0], "
                    "doc.json:1:30"});
}

TEST(ScatteringParam, HasNoMoreRowsThanItsLimit) {
    std::string rows;
    for (std::size_t i = 0; i <= kMaxScatteringRows; ++i)
        rows += (i ? ", " : "") + std::string("{\"object\": ") + std::to_string(i) +
                ", \"profile\": {\"type\": \"burley\", \"d_mm\": 1}}";
    EXPECT_EQ(value_faults(profile_spec(), R"({"default": "skin", "rows": [)" + rows + "]}"),
              Lines{"doc.json:1:1: error: p: 1025 rows are more than 1024"});
}

TEST(ScatteringParam, IsFormattedAsADocumentWritesIt) {
    const ParamSpec spec = profile_spec();
    for (
        const std::string text :
        {R"("skin")", R"({"type": "burley", "d_mm": [1, 2, 3]})",
         R"({"default": "skin", "rows": [{"objects": "3-7", "profile": {"type": "burley", "d_mm": [2, 2, 2]}}, )"
         R"({"object": 9, "profile": "skin"}, {"name": "Ear", "profile": "skin"}]})"})
        EXPECT_EQ(format_value(spec, value_of(spec, text)), text);
}

TEST(ScatteringParam, IsNoColumnAndHasNoRange) {
    EXPECT_EQ(
        spec_faults(
            R"({"type": "scattering_profile", "unit": "mm", "min": 1, "bind": "define", "default": "skin", "doc": "."})"),
        (Lines{"doc.json:1:64: error: a scattering_profile cannot be a define: it reaches a shader as a "
               "texture or a buffer",
               "doc.json:1:32: error: parameter 'p' has no key 'unit'",
               "doc.json:1:46: error: parameter 'p' has no key 'min'; did you mean 'bind'?"}));
    EXPECT_EQ(spec_faults(R"({"type": "scattering_profile", "doc": "."})"),
              Lines{"doc.json:1:1: error: parameter 'p' has no 'default'"});
}

}  // namespace
}  // namespace aftershade
