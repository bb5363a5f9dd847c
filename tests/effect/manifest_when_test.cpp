// Conditions on reads, writes and textures, and of groups of passes.
#include "framework/effect/shader_source.h"
#include "tests/effect/assembly.h"
#include "tests/effect/broken_manifests.h"

namespace aftershade {
namespace {

using test::Assembly;
using test::demo_manifest;
using test::EffectFolder;
using test::has_line;
using test::Lines;

/// A texture that is there only with mode good, and passes that read and write under conditions.
std::string conditional_manifest() {
    return demo_manifest({{test::kTextures, R"("textures": {
            "small": {"format": "rgba16f", "doc": "."},
            "fine": {"format": "rgba16f", "history": true, "when": {"mode": "good"}, "doc": "."}})"},
                          {test::kPasses, R"("passes": [
            {"name": "make", "shader": "a.frag", "reads": ["color", {"depth": {"when": {"flag": true}}}], "writes": ["small", "fine"]},
            {"name": "refine", "shader": "a.frag", "reads": ["fine.prev"], "writes": ["fine"]},
            {"name": "last", "shader": "b.frag", "writes": ["color"],
             "reads": ["fine", {"small": {"filter": "linear", "when": {"mode": ["fast", "good"], "taps": [3, 4]}}}]}])"}});
}

std::vector<std::string> names_of(const std::vector<WriteSpec>& writes) {
    std::vector<std::string> names;
    for (const WriteSpec& write : writes) names.push_back(write.name);
    return names;
}
std::vector<std::string> names_of(const std::vector<ReadSpec>& reads) {
    std::vector<std::string> names;
    for (const ReadSpec& read : reads) names.push_back(read.glsl_name());
    return names;
}

TEST(Conditions, DecideWhichReadsAndWritesAreThere) {
    const EffectFolder folder(conditional_manifest());
    Assembly make(folder, 0);
    const auto reads = [&](const Assembly& pass) {
        return names_of(
            present_reads(pass.manifest, pass.manifest.passes[pass.pass_index], pass.params, {"depth"}));
    };
    const PassSpec& pass = make.manifest.passes[0];
    EXPECT_EQ(names_of(present_writes(pass, make.params, {})), (std::vector<std::string>{"small"}));
    EXPECT_EQ(reads(make), (std::vector<std::string>{"color"}));
    make.params.set("mode", std::string("good"));
    make.params.set("flag", true);
    EXPECT_EQ(names_of(present_writes(pass, make.params, {})), (std::vector<std::string>{"small", "fine"}));
    EXPECT_EQ(reads(make), (std::vector<std::string>{"color", "depth"}));
    Assembly last(folder, 2);
    EXPECT_EQ(reads(last), (std::vector<std::string>{"small"}));
    last.params.set("taps", std::int64_t(5));
    EXPECT_EQ(reads(last), (std::vector<std::string>{}));
}

/// A manifest whose first pass has these conditions.
test::Sections with(const std::string& conditions) {
    return {
        {test::kTextures, R"("textures": {"small": {"format": "rgba16f", "doc": "."}})"},
        {test::kPasses,
         R"("passes": [{"name": "make", "shader": "a.frag", "writes": ["small"], "when": )" + conditions +
             R"(}, {"name": "last", "shader": "b.frag", "reads": ["color", "depth"], "writes": ["color", "small"]}])"}};
}

TEST(Conditions, MayAskWhetherANumberIs0) {
    const EffectFolder folder(demo_manifest(with(R"({"nonzero.gain": true, "nonzero.taps": [true]})")));
    Assembly make(folder, 0);
    const auto runs = [&](double gain, std::int64_t taps) {
        make.params.set("gain", gain);
        make.params.set("taps", taps);
        return pass_enabled(make.manifest.passes[0], make.params, {});
    };
    EXPECT_TRUE(runs(0.5, 3));
    EXPECT_TRUE(runs(-1e-300, -3));
    EXPECT_FALSE(runs(0, 3));
    EXPECT_FALSE(runs(-0.0, 3));
    EXPECT_FALSE(runs(0.5, 0));
    test::expect_faults(
        with(R"({"nonzero.gian": true})"),
        {"6: pass 'make': the condition 'nonzero.gian' is not a parameter; did you mean 'gain'?"});
    test::expect_faults(with(R"({"nonzero.mode": true})"),
                        {"6: pass 'make': the condition 'nonzero.mode' is not on a number"});
    test::expect_faults(with(R"({"nonzero.gain": 1})"),
                        {"6: whether a number is not 0 compares with true or false"});
}

TEST(Conditions, MayAskWhetherAParameterIsAtItsIdentity) {
    test::Sections sections = with(R"({"changes.gamma": [true], "changes.tint": false})");
    sections[test::kParams] = R"("params": {
        "gamma": {"type": "float", "default": 1, "min": 0.1, "identity": 1, "doc": "."},
        "tint": {"type": "color", "default": [1, 0, 0], "identity": [1, 1, 1], "doc": "."}})";
    sections[test::kPresets] = R"("presets": {})";
    const EffectFolder folder(demo_manifest(sections));
    Assembly make(folder, 0);
    const auto runs = [&](double gamma, std::vector<double> tint) {
        make.params.set("gamma", gamma);
        make.params.set("tint", std::move(tint));
        return pass_enabled(make.manifest.passes[0], make.params, {});
    };
    EXPECT_TRUE(runs(2.2, {1, 1, 1}));
    EXPECT_TRUE(runs(0.1, {1, 1, 1}));
    EXPECT_FALSE(runs(1, {1, 1, 1}));
    EXPECT_FALSE(runs(2.2, {1, 1, 0.5}));
    test::expect_faults(
        with(R"({"changes.gain": true})"),
        {"6: pass 'make': the condition 'changes.gain' is on a parameter without an 'identity'"});
    test::expect_faults(
        with(R"({"changes.gian": true})"),
        {"6: pass 'make': the condition 'changes.gian' is not a parameter; did you mean 'gain'?"});
    sections[test::kPasses] = with(R"({"changes.gamma": 1, "changes.tint": true})")[test::kPasses];
    test::expect_faults(sections, {"6: whether a parameter changes the image compares with true or false"});
}

TEST(Conditions, LeaveAPassOutThatWouldWriteNothing) {
    const EffectFolder folder(conditional_manifest());
    Assembly refine(folder, 1);
    EXPECT_FALSE(pass_enabled(refine.manifest.passes[1], refine.params, {}));
    EXPECT_TRUE(pass_enabled(refine.manifest.passes[0], refine.params, {}));
    refine.params.set("mode", std::string("good"));
    EXPECT_TRUE(pass_enabled(refine.manifest.passes[1], refine.params, {}));
}

TEST(Conditions, TellTheShaderWhatIsThere) {
    const EffectFolder folder(conditional_manifest());
    Assembly make(folder, 0);
    make.present = {"depth"};
    std::string text = make.sound().text;
    EXPECT_EQ(text.find("HAS_"), std::string::npos) << "the pass does not read the depth that is there";
    EXPECT_EQ(text.find("out_fine"), std::string::npos);
    EXPECT_EQ(text.find("sampler2D depth"), std::string::npos);
    make.params.set("mode", std::string("good"));
    make.params.set("flag", true);
    EXPECT_TRUE(has_line(make.sound(), "#define HAS_DEPTH 1"));
    EXPECT_TRUE(has_line(make.sound(), "#define HAS_OUT_FINE 1"));
    EXPECT_TRUE(has_line(make.sound(), "layout(location = 1) out vec4 out_fine;"));
    EXPECT_EQ(make.sound().text.find("HAS_OUT_SMALL"), std::string::npos) << "it is always there";

    Assembly refine(folder, 1);
    refine.params.set("mode", std::string("good"));
    EXPECT_TRUE(has_line(refine.sound(), "#define HAS_FINE_PREV 1"));
    Assembly last(folder, 2);
    EXPECT_TRUE(has_line(last.sound(), "#define HAS_SMALL 1"));
    EXPECT_TRUE(has_line(last.sound(), "layout(binding = 0) uniform sampler2D small;"));
    EXPECT_EQ(last.sound().text.find("HAS_FINE"), std::string::npos);
}

TEST(Conditions, OfAGroupComeBeforeThoseOfItsPasses) {
    const EffectFolder folder(demo_manifest({{test::kPasses, R"("passes": [
        {"when": {"mode": "good"}, "passes": [
            {"name": "one", "shader": "a.frag", "reads": ["color"], "writes": ["small"]},
            {"when": {"flag": true}, "passes": [
                {"name": "two", "shader": "a.frag", "reads": ["small"], "writes": ["small"], "when": {"has.depth": true}}]}]},
        {"name": "three", "shader": "b.frag", "reads": ["small", "color", "depth"], "writes": ["color"]}])"}}));
    const EffectManifest manifest = folder.sound_manifest();
    ASSERT_EQ(manifest.passes.size(), 3U);
    const auto subjects = [&](std::size_t pass) {
        Lines all;
        for (const WhenSpec& condition : manifest.passes[pass].when) all.push_back(condition.subject);
        return all;
    };
    EXPECT_EQ(subjects(0), Lines{"mode"});
    EXPECT_EQ(subjects(1), (Lines{"mode", "flag", "has.depth"}));
    EXPECT_EQ(subjects(2), Lines{});
}

TEST(Conditions, SayOnceWhatIsWrongWithThem) {
    const std::string last =
        R"(, {"name": "last", "shader": "b.frag", "reads": ["color", "depth"], "writes": ["color", "small"]}])";
    const auto with = [&](const std::string& pass) {
        return test::Sections{
            {test::kTextures, R"("textures": {"small": {"format": "rgba16f", "doc": "."}})"},
            {test::kPasses, "\"passes\": [" + pass + last}};
    };
    const std::string two = R"("passes": [{"name": "a", "shader": "a.frag", "writes": ["small"]},
        {"name": "b", "shader": "a.frag", "writes": ["small"]}]})";
    test::expect_faults(with(R"({"when": {"mod": "good"}, )" + two),
                        {"6: pass 'a': the condition 'mod' is not a parameter; did you mean 'mode'?"});
    test::expect_faults(with(R"({"when": {"mode": "best"}, )" + two),
                        {"6: pass 'a': \"best\" is not a value of 'mode'"});
    test::expect_faults(with(R"({"when": {"flag": true}, "passes": []})"), {"6: the group has no passes"});
    test::expect_faults(with(R"({"when": {"flag": true}, "name": "x", )" + two),
                        {"6: a group has no 'name': its passes have"});
    test::expect_faults(
        with(
            R"({"name": "x", "shader": "a.frag", "reads": [{"color": {"when": {"has.small": true}}}], "writes": [{"small": {"when": {"taps": 1.5}}}]})"),
        {"6: a condition compares with true, false, an integer or a name",
         "6: pass 'x': 'has.small' does not name an optional input"});
    test::Sections sections = with(R"({"name": "x", "shader": "a.frag", "writes": ["small"]})");
    sections[test::kTextures] =
        R"("textures": {"small": {"format": "rgba16f", "when": {"gain": 1}, "doc": "."}})";
    test::expect_faults(sections, {"5: 1 is not a value of 'gain'"});
}

TEST(Conditions, ClaimTheNamesOfTheirDefines) {
    test::expect_faults(
        {{test::kParams, R"("params": {
            "has_small": {"type": "bool", "default": false, "bind": "define", "doc": "."},
            "taps": {"type": "int", "default": 3, "doc": "."}})"},
         {test::kPresets, R"("presets": {})"},
         {test::kPasses, R"("passes": [
            {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"]},
            {"name": "two", "shader": "b.frag", "reads": [{"small": {"when": {"taps": 3}}}], "writes": ["color"]}])"}},
        {"6: texture 'small' needs the GLSL name 'HAS_SMALL', which the parameter 'has_small' has"});
}

}  // namespace
}  // namespace aftershade
