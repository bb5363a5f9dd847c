#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "framework/look/pipeline.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

class Compile : public testing::Test {
protected:
    Compile() {
        const std::string reads_both =
            R"("passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "depth"],
                                                       "writes": ["color"] } ])";
        const std::string color = R"("outputs": { "color": { "role": "color" } },)";
        effects_.add(
            "fog",
            R"("inputs": { "color": { "role": "color" }, "depth": { "role": "depth" } },)" + color +
                R"("params": { "reach": { "type": "float", "unit": "m", "default": 5, "min": 1, "max": 100,
                                                          "from": "camera.focus_distance", "doc": "Reach." },
                                               "density": { "type": "float", "default": 0.5,
                                                             "doc": "Density." } },
                                   "presets": { "thick": { "density": 2, "reach": 3 } },)" +
                reads_both,
            "void main() { out_color = vec4(param.reach, param.density, 0, 1); }\n");
        effects_.add(
            "mist",
            R"("inputs": { "color": { "role": "color" }, "depth": { "role": "depth", "optional": true } },)" +
                color + reads_both,
            "void main() { out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0); }\n");
        effects_.add(
            "flatten",
            R"("inputs": { "depth": { "role": "depth" } }, "outputs": { "flattened": { "role": "depth" } },
            "passes": [ { "name": "main", "shader": "main.frag", "reads": ["depth"], "writes": ["flattened"] } ])",
            "void main() { out_flattened = 1.0; }\n");
        effects_.add_color("tint", "source");
    }

    static std::string source(const Bound& bound, std::size_t step, const std::string& input) {
        const InputSource& from = bound.pipeline().steps.at(step).inputs.at(input);
        return (from.step < 0 ? "capture" : bound.pipeline().steps[std::size_t(from.step)].name) + "." +
               from.output;
    }

    EffectFolder effects_;
};

TEST_F(Compile, TakesARoleFromTheNearestEarlierStepElseFromTheCapture) {
    const Bound bound(
        effects_,
        look_of(R"({ "effect": "tint" }, { "effect": "flatten" }, { "effect": "tint", "name": "tint_b" },
                                           { "effect": "fog" })"));
    EXPECT_EQ(bound.faults(), "");
    EXPECT_EQ(source(bound, 0, "color"), "capture.color");
    EXPECT_EQ(source(bound, 1, "depth"), "capture.depth");
    EXPECT_EQ(source(bound, 2, "color"), "tint.color");
    EXPECT_EQ(source(bound, 3, "color"), "tint_b.color");
    EXPECT_EQ(source(bound, 3, "depth"), "flatten.flattened");
}

TEST_F(Compile, PutsInAboveTheNearestStep) {
    const Bound bound(
        effects_,
        look_of(R"({ "effect": "tint" }, { "effect": "flatten" }, { "effect": "tint", "name": "tint_b" },
                                           { "effect": "fog", "in": { "color": "tint.color",
                                                                    "depth": "capture.depth" } })"));
    EXPECT_EQ(bound.faults(), "");
    EXPECT_EQ(source(bound, 3, "color"), "tint.color");
    EXPECT_EQ(source(bound, 3, "depth"), "capture.depth");
}

TEST_F(Compile, LeavesDisabledStepsOutOfTheWiring) {
    const Bound bound(effects_, look_of(R"({ "effect": "tint", "enabled": false }, { "effect": "fog" })"));
    EXPECT_EQ(bound.faults(), "");
    ASSERT_EQ(bound.pipeline().steps.size(), 1u);
    EXPECT_EQ(source(bound, 0, "color"), "capture.color");
}

TEST_F(Compile, ChecksDisabledStepsToo) {
    const Bound bound(effects_,
                      look_of(R"({ "effect": "fog", "enabled": false, "params": { "reach": "3 kg" } })"));
    EXPECT_NE(bound.faults().find("fog.reach: '3 kg'"), std::string::npos) << bound.faults();
}

TEST_F(Compile, SaysThatAStepIsDisabledWhereItIsNamed) {
    const Bound bound(effects_,
                      look_of(R"({ "effect": "tint", "enabled": false }, )"
                              R"({ "effect": "fog", "in": { "color": "tint.color" } })"),
                      {{"tint.x=1"}, {"tint.color"}});
    const std::string message = ": error: the step 'tint' is disabled; remove its \"enabled\": false\n";
    EXPECT_EQ(bound.faults(),
              "look:1:107" + message + "set tint.x=1" + message + "taps tint.color" + message);
}

TEST_F(Compile, ToldOfAFaultyStepDoesNotComplainOfEveryMentionOfIt) {
    const Bound bound(
        effects_,
        look_of(R"({ "effect": "tinnt", "name": "a" }, { "effect": "fog", "in": { "color": "a.color" } })"),
        {{"a.x=1"}, {"a.color"}});
    EXPECT_EQ(bound.faults(), "look:1:43: error: no effect 'tinnt'; did you mean 'tint'?\n");
}

TEST_F(Compile, ListsTheRolesThatTheCaptureMustBring) {
    EXPECT_EQ(
        Bound(effects_, look_of(R"({ "effect": "tint" }, { "effect": "fog" })")).pipeline().capture_roles(),
        (std::vector<RoleId>{"color", "depth"}));
    EXPECT_EQ(Bound(effects_, look_of(R"({ "effect": "tint" })")).pipeline().capture_roles(),
              std::vector<RoleId>{"color"});
}

TEST_F(Compile, RefusesATapOfAnInputOrOfNothing) {
    EXPECT_EQ(Bound(effects_, look_of(R"({ "effect": "fog" })"), {{}, {"fog.depth"}}).faults(),
              "taps fog.depth: error: fog has no texture 'depth' (known: 'color')\n");
    EXPECT_EQ(Bound(effects_, look_of(R"({ "effect": "fog" })"), {{}, {"fog.color"}}).faults(), "");
    effects_.add(
        "pile",
        R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "textures": { "pages": { "format": "rgba16f", "layers": 3, "doc": "Pages." } },
        "passes": [ { "name": "blank", "kind": "clear", "writes": ["pages"], "value": [0] }, { "name": "main", "shader": "main.frag", "reads": ["color", "pages"], "writes": ["color"] } ])",
        "void main() { out_color = texelFetch(pages, ivec3(0), 0) + texelFetch(color, ivec2(0), 0); }\n");
    EXPECT_EQ(Bound(effects_, look_of(R"({ "effect": "pile" })"), {{}, {"pile.pages"}}).faults(),
              "taps pile.pages: error: pile.pages has 3 layers, and a tap shows a texture of one; tap what a "
              "pass makes of it\n");
}

class Values : public Compile {
protected:
    static double value(const Bound& bound, const std::string& name, const CaptureHeader& header = {}) {
        return std::get<double>(resolved(bound, header).get(name));
    }
    static ParamSet resolved(const Bound& bound, const CaptureHeader& header) {
        Capture capture;
        capture.header = header;
        FrameInputs frame;
        frame.capture = &capture;
        return resolve_params(bound.pipeline().steps.at(0), frame);
    }
    static CaptureHeader focused_at(double distance_m) {
        CaptureHeader header;
        header.path = "in.exr";
        header.camera.set("focus_distance", distance_m);
        return header;
    }
};

TEST_F(Values, ComeFromSetThenLookThenPresetThenCaptureThenManifest) {
    const std::string plain = look_of(R"({ "effect": "fog" })");
    const std::string preset = look_of(R"({ "effect": "fog", "preset": "thick" })");
    const std::string look =
        look_of(R"({ "effect": "fog", "preset": "thick", "params": { "reach": "400 cm" } })");
    const CaptureHeader capture = focused_at(7);
    EXPECT_EQ(value(Bound(effects_, plain), "reach"), 5);
    EXPECT_EQ(value(Bound(effects_, plain), "reach", capture), 7);
    EXPECT_EQ(value(Bound(effects_, preset), "reach", capture), 3);
    EXPECT_EQ(value(Bound(effects_, look), "reach", capture), 4);
    EXPECT_EQ(value(Bound(effects_, look, {{"fog.reach=\"6 m\""}, {}}), "reach", capture), 6);
    EXPECT_EQ(value(Bound(effects_, look), "density", capture), 2) << "the preset's other value stands";
}

TEST_F(Values, AreReadFromSetAsJsonOrAsABareWord) {
    const std::string plain = look_of(R"({ "effect": "fog" })");
    for (const char* set : {"fog.reach=2.5", "fog.reach=2.5 m", "fog.reach=\"2.5 m\"", "fog.reach=250cm"})
        EXPECT_EQ(value(Bound(effects_, plain, {{set}, {}}), "reach"), 2.5) << set;
}

TEST_F(Values, OfTheCaptureThatAreOutOfRangeAreRefusedUnlessTheLookGivesOne) {
    const Bound bound(effects_, look_of(R"({ "effect": "fog" })"));
    try {
        resolved(bound, focused_at(500));
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        EXPECT_STREQ(
            error.what(),
            "in.exr: camera.focus_distance is 500, outside the range of fog.reach (set the parameter in "
            "the look, or correct the capture's camera)");
    }
    EXPECT_EQ(value(Bound(effects_, look_of(R"({ "effect": "fog", "preset": "thick" })")), "reach",
                    focused_at(500)),
              3);
}

TEST_F(Compile, NamesEffectRoleAndChannelsOfAMissingRole) {
    CaptureHeader header;
    header.path = "in.exr";
    header.profile = "native";
    header.roles = {"color"};
    header.channels = {"A", "B", "G", "R"};
    try {
        require_capture_roles(Bound(effects_, look_of(R"({ "effect": "fog", "name": "haze" })")).pipeline(),
                              header);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        EXPECT_STREQ(
            error.what(),
            "in.exr: step 'haze' (effect fog) needs the role 'depth', which the profile 'native' does not "
            "find among the channels A, B, G, R (\"channels\": {\"depth\": {\"channels\": [...]}} in "
            "capture.json names its channels)");
    }
    EXPECT_NO_THROW(
        require_capture_roles(Bound(effects_, look_of(R"({ "effect": "mist" })")).pipeline(), header));
    header.roles = {"depth"};
    EXPECT_THROW(require_capture_roles(Bound(effects_, look_of("")).pipeline(), header), Error)
        << "outputs need color";
}

TEST_F(Compile, NamesEveryMissingRoleOnceWithTheRemediesOfTheProfile) {
    effects_.add(
        "blur",
        R"("inputs": { "color": { "role": "color" }, "velocity": { "role": "velocity" } }, "outputs": { "color": { "role": "color" } },
           "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "velocity"], "writes": ["color"] } ])",
        "void main() { out_color = vec4(0); }\n");
    CaptureHeader header;
    header.path = "in.exr";
    header.profile = "maker";
    header.roles = {"color"};
    header.channels = {"B", "G", "R"};
    header.remedies = {{"velocity", "tick Vector"}, {"normal", "tick Normal"}};
    const Bound bound(
        effects_,
        look_of(R"({ "effect": "fog" }, { "effect": "blur" }, { "effect": "fog", "name": "again" })"));
    ASSERT_EQ(bound.faults(), "");
    try {
        require_capture_roles(bound.pipeline(), header);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_STREQ(
            error.what(),
            "in.exr: step 'fog' (effect fog) needs the role 'depth' and step 'blur' (effect blur) "
            "needs the role 'velocity', which the profile 'maker' does not find among the channels "
            "B, G, R (for 'velocity': tick Vector; \"channels\": {\"ROLE\": {\"channels\": [...]}} in "
            "capture.json names its channels)");
    }
}

TEST_F(Compile, PrefersTheUsersEffectToAShippedOneOfItsName) {
    effects_.add_color("bokeh", "source");
    EXPECT_NE(Bound(effects_, look_of(R"({ "effect": "bokeh", "params": { "f_number": 2 } })")).faults(), "");
}

}  // namespace
}  // namespace aftershade::test
