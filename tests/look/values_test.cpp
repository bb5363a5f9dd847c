// Every form that a value of a look may have, and what each gives for a frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/error.h"
#include "framework/capture/cryptomatte.h"
#include "framework/image/color_space.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

class ValueForms : public testing::Test {
protected:
    ValueForms() {
        effects_.add_color("shown", "vec4(param.reach, param.tint.r, param.falloff_at, 1.0)",
                           R"("reach": { "type": "float", "unit": "m", "default": 5, "min": 0.1, "max": 100,
                                         "doc": "." },
                              "tint": { "type": "color", "default": [1, 1, 1], "doc": "." },
                              "stops": { "type": "float", "unit": "ev", "default": 0, "doc": "." },
                              "falloff_at": { "type": "float", "default": 0.25, "doc": "." },
                              "mode": { "type": "enum", "values": ["soft", "hard"], "default": "soft",
                                        "doc": "." })");
    }

    static Capture scene(int frame) {
        SyntheticScene scene;
        scene.width = 20;
        scene.height = 10;
        scene.background_depth_m = 9;
        scene.box = SyntheticBox{12, 2, 4, 4, 0, 0, 2.5f, {0.9f, 0.2f, 0.1f}};
        return make_capture(scene, frame);
    }
    double reach(const std::string& value, const Capture& capture, const std::string& vars = "") {
        const std::string look = R"({ "aftershade": 1, )" + vars +
                                 R"("steps": [ { "effect": "shown", "params": { "reach": )" + value +
                                 " } } ] }";
        const Bound bound(effects_, look);
        EXPECT_EQ(bound.faults(), "");
        FrameInputs frame;
        frame.capture = &capture;
        return std::get<double>(resolve_params(bound.pipeline().steps.at(0), frame).get("reach"));
    }
    std::string faults(const std::string& value) {
        return Bound(effects_, look_of(R"({ "effect": "shown", "params": { "reach": )" + value + " } }"))
            .faults();
    }
    EffectFolder effects_;
};

TEST_F(ValueForms, KeysAreLinearBetweenFramesAndConstantBeyond) {
    const std::string keys = R"({ "keys": { "10": 2, "20": "4 m", "30": 4 } })";
    for (const auto& [frame, expected] : {std::pair(1, 2.0), {10, 2.0}, {15, 3.0}, {20, 4.0}, {99, 4.0}})
        EXPECT_DOUBLE_EQ(reach(keys, scene(frame)), expected) << frame;
    const std::string step = R"({ "keys": { "10": 2, "20": 4 }, "interpolation": "step" })";
    EXPECT_EQ(reach(step, scene(19)), 2);
    EXPECT_EQ(reach(step, scene(20)), 4);
    const std::string smooth = R"({ "keys": { "10": 2, "20": 4 }, "interpolation": "smooth" })";
    EXPECT_DOUBLE_EQ(reach(smooth, scene(12)), 2 + 2 * (3 * 0.04 - 2 * 0.008));
}

TEST_F(ValueForms, AKeyMaySayHowItsValueGoesToTheNext) {
    const std::string keys = R"({ "keys": { "10": { "value": "2 m", "interpolation": "step" },
        "20": { "value": 4, "interpolation": [0.42, 0, 0.58, 1] }, "30": 8, "40": { "value": 4 }, "50": 0.5 },
        "interpolation": "smooth" })";
    const double eased = 3 * 0.04 - 2 * 0.008;
    for (const auto& [frame, expected] : {std::pair(10, 2.0),
                                          {19, 2.0},
                                          {20, 4.0},
                                          {25, 6.0},
                                          {32, 8 - 4 * eased},
                                          {42, 4 - 3.5 * eased},
                                          {60, 0.5}})
        EXPECT_NEAR(reach(keys, scene(frame)), expected, 1e-9) << frame;
    EXPECT_LT(reach(keys, scene(22)), 4 + 4 * 0.2) << "slowly at first";
    const std::string rack = R"({ "keys": { "10": { "value": { "from": "depth", "object": 2 },
        "interpolation": "step" }, "20": { "from": "depth", "uv": [0.1, 0.9] } } })";
    EXPECT_NEAR(reach(rack, scene(19)), 2.5, 1e-6);
    EXPECT_NEAR(reach(rack, scene(20)), 9, 1e-6);
    for (const std::string& value : {keys, rack}) {
        const Bound bound(effects_,
                          look_of(R"({ "effect": "shown", "params": { "reach": )" + value + " } }"));
        const std::string text = format_source(bound.pipeline().steps.at(0).values.at("reach"));
        EXPECT_NEAR(reach(text, scene(22)), reach(value, scene(22)), 1e-12) << text;
    }
}

TEST_F(ValueForms, OfAKeyAreErrorsWhereTheyStand) {
    const auto says = [&](const std::string& key, const std::string& words) {
        const std::string found = faults(R"({ "keys": { "1": )" + key + " } }");
        EXPECT_NE(found.find(words), std::string::npos) << found;
    };
    says(R"({ "value": 500 })", "500 m is above the maximum 100 m");
    says(R"({ "value": 5, "interpolation": "cubic" })", "or the handles of a curve");
    says(R"({ "value": 5, "ease": "step" })", "shown.reach has no key 'ease'");
    says(R"({ "value": { "value": 5 } })", "shown.reach");
}

TEST_F(ValueForms, VariablesStandForAnyValue) {
    EXPECT_EQ(reach(R"({ "var": "far" })", scene(1), R"("vars": { "far": "700 cm" }, )"), 7);
    EXPECT_EQ(
        reach(R"({ "keys": { "1": { "var": "far" }, "3": 1 } })", scene(2), R"("vars": { "far": 7 }, )"), 4);
}

TEST_F(ValueForms, DepthIsTakenAtAPointOrAsTheMedianOfAnObject) {
    EXPECT_FLOAT_EQ(float(reach(R"({ "from": "depth", "uv": [0.7, 0.4] })", scene(1))), 2.5f);
    EXPECT_FLOAT_EQ(float(reach(R"({ "from": "depth", "uv": [0.1, 0.9] })", scene(1))), 9.0f);
    EXPECT_FLOAT_EQ(float(reach(R"({ "from": "depth", "object": 2 })", scene(1))), 2.5f);
    EXPECT_FLOAT_EQ(float(reach(R"({ "from": "depth", "object": "2-4" })", scene(1))), 2.5f);
    EXPECT_FLOAT_EQ(float(reach(R"({ "from": "depth", "object": "0,2" })", scene(1))), 9.0f) << "most of it";
    Capture named = scene(1);
    for (std::uint32_t& id : named.images.at("object_id").uints())
        if (id == 2) id = cryptomatte_hash("Wheel");
    EXPECT_FLOAT_EQ(float(reach(R"({ "from": "depth", "object": "Wheel" })", named)), 2.5f);
}

TEST_F(ValueForms, DepthThatIsNotThereIsAnErrorOfTheCapture) {
    Capture capture = scene(1);
    capture.images.at("depth").at(0, 0, 0) = std::numeric_limits<float>::infinity();
    for (const auto& [value, message] :
         {std::pair(R"({ "from": "depth", "uv": [0, 0] })", "shown.reach: nothing was hit at pixel (0, 0)"),
          {R"({ "from": "depth", "object": 77 })", "shown.reach: object 77 has no pixel with a depth"},
          {R"({ "from": "depth", "object": "77-78" })",
           "shown.reach: objects 77-78 have no pixel with a depth"},
          {R"({ "from": "depth", "object": "77,79" })", "object 77 and object 79 have no pixel with a depth"},
          {R"({ "from": "camera.far" })", "the capture has no camera.far"}}) {
        try {
            reach(value, capture);
            ADD_FAILURE() << value;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::capture);
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
        }
    }
}

TEST_F(ValueForms, KeysMayComeFromTheCaptureOfEachFrame) {
    const std::string rack = R"({ "keys": { "10": { "from": "depth", "object": 2 }, "20": { "from": "depth",
        "uv": [0.1, 0.9] }, "30": 4 }, "interpolation": "smooth" })";
    for (const auto& [frame, expected] : {std::pair(1, 2.5),
                                          {10, 2.5},
                                          {12, 2.5 + 6.5 * (3 * 0.04 - 2 * 0.008)},
                                          {20, 9.0},
                                          {25, 6.5},
                                          {40, 4.0}})
        EXPECT_NEAR(reach(rack, scene(frame)), expected, 1e-6) << frame;
    Capture moved = scene(10);
    for (float& depth_m : moved.images.at("depth").floats()) depth_m += 1;
    EXPECT_NEAR(reach(rack, moved), 3.5, 1e-6) << "the focus follows the object";
    std::ranges::fill(moved.images.at("depth").floats(), std::numeric_limits<float>::infinity());
    moved.header.frame = 30;
    EXPECT_EQ(reach(rack, moved), 4) << "no key that does not count is taken from the frame";
    const Bound bound(effects_, R"({ "aftershade": 1, "steps": [ { "effect": "shown", "params": { "reach":
        { "keys": { "1": { "from": "depth", "object": "Ball" }, "24": { "from": "depth", "object": "Suzanne" } } } } } ] })");
    EXPECT_TRUE(bound.pipeline().object_names().empty()) << "object_id stays free for another Cryptomatte";
    const auto roles = bound.pipeline().capture_roles();
    for (const char* object : {"Ball", "Suzanne"}) {
        const std::vector<TableKey> key{{0, 0, object}};
        EXPECT_TRUE(std::ranges::count(roles, RoleId::coverage(key))) << object;
    }
    Capture covered = scene(1);
    const std::vector<TableKey> ball{{0, 0, "Ball"}};
    Image& coverage = covered.images.emplace(RoleId::coverage(ball), Image(20, 10, 1)).first->second;
    coverage.at(0, 0, 0) = 0.75f;
    covered.images.at("depth").at(0, 0, 0) = 7;
    coverage.at(1, 0, 0) = 0.25f;
    EXPECT_NEAR(reach(R"({ "from": "depth", "object": "Ball" })", covered), 7, 1e-6)
        << "where it covers half";
    EXPECT_NE(
        faults(R"({ "keys": { "1": { "from": "depth", "uv": [2, 0] } } })").find("two numbers from 0 to 1"),
        std::string::npos);
}

TEST_F(ValueForms, AnExposureMayBringAnObjectTo18PercentGrey) {
    const auto exposure = [&](const std::string& value, const Capture& capture) {
        const Bound bound(effects_,
                          look_of(R"({ "effect": "shown", "params": { "stops": )" + value + " } }"));
        EXPECT_EQ(bound.faults(), "");
        FrameInputs frame;
        frame.capture = &capture;
        return std::get<double>(resolve_params(bound.pipeline().steps.at(0), frame).get("stops"));
    };
    const std::string of_box = R"({ "from": "luminance", "object": 2 })";
    Capture capture = scene(1);
    const double luminance = 0.2126 * 0.9 + 0.7152 * 0.2 + 0.0722 * 0.1;  // Rec. 709's weights
    EXPECT_NEAR(exposure(of_box, capture), std::log2(0.18 / luminance), 1e-5);
    for (float& light : capture.images.at("color").floats()) light *= 4;
    EXPECT_NEAR(exposure(of_box, capture), std::log2(0.18 / luminance) - 2, 1e-5) << "two stops more light";
    capture.header.primaries = *color_space_primaries("acescg");
    const double ap1 = 0.2722287 * 0.9 + 0.6740818 * 0.2 + 0.0536895 * 0.1;  // S-2014-004, TRA_1's second row
    EXPECT_NEAR(exposure(of_box, capture), std::log2(0.18 / ap1) - 2, 0.02) << "less the adaptation to D65";
    std::ranges::fill(capture.images.at("color").floats(), 0.0f);
    EXPECT_THROW(exposure(of_box, capture), Error);
    EXPECT_NE(faults(of_box).find("luminance is in ev, which cannot be converted to m"), std::string::npos);
}

TEST_F(ValueForms, CameraValuesComeInTheParametersUnit) {
    Capture capture = scene(1);
    capture.header.camera.set("focal_length", 850);
    EXPECT_DOUBLE_EQ(reach(R"({ "from": "camera.focal_length" })", capture), 0.85);
}

TEST_F(ValueForms, ThatMakeNoSenseAreErrorsWithTheirPlace) {
    EXPECT_EQ(faults(R"({ "keys": { "x": 1, "2": 500 } })"),
              "look:1:85: error: shown.reach: 'x' is not a frame number\n"
              "look:1:98: error: shown.reach: 500 m is above the maximum 100 m\n");
    EXPECT_NE(faults(R"({ "keys": {} })").find("shown.reach: 'keys' has no frame"), std::string::npos);
    EXPECT_NE(faults(R"({ "from": "camera.focus" })").find("did you mean 'camera.focus_distance'?"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "from": "camera.f_number" })").find("which cannot be converted to m"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "from": "depth" })").find("has one of 'uv' and 'object'"), std::string::npos);
    EXPECT_NE(faults(R"({ "from": "depth", "object": "7-3" })").find("'7-3' is not a range of ids"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "from": "depth", "uv": [2, 0] })").find("two numbers from 0 to 1"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "var": "nothing" })").find("the look has no variable 'nothing'"),
              std::string::npos);
}

TEST_F(ValueForms, InPixelsShrinkWithTheScale) {
    effects_.add_color("wide", "vec4(param.radius, float(param.steps), 0.0, 1.0)",
                       R"("radius": { "type": "float", "unit": "px", "default": 8, "doc": "." },
                          "steps": { "type": "int", "default": 8, "doc": "." })");
    const Bound bound(effects_, look_of(R"({ "effect": "wide", "params": { "radius": 12 } })"));
    const Capture capture = scene(1);
    FrameInputs frame;
    frame.capture = &capture;
    frame.scale = 0.25;
    const ParamSet params = resolve_params(bound.pipeline().steps.at(0), frame);
    EXPECT_EQ(std::get<double>(params.get("radius")), 3);
    EXPECT_EQ(std::get<std::int64_t>(params.get("steps")), 8) << "a pure number";
}

}  // namespace
}  // namespace aftershade::test
