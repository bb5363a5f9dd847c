// Every form that a value of a look may have, and what each gives for a frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/error.h"
#include "framework/capture/cryptomatte.h"
#include "framework/file/png_file.h"
#include "framework/image/color_space.h"
#include "tests/file/png_chunks.h"
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

/// Mix and mask of a step that paints everything white.
class MixAndMask : public testing::Test {
protected:
    MixAndMask() { effects_.add_color("white", "vec4(1.0)"); }
    static Capture scene() {
        SyntheticScene scene;
        scene.width = 20;
        scene.height = 10;
        scene.background = {0.25f, 0.5f, 0};
        scene.box = SyntheticBox{12, 2, 4, 4, 0, 0, 2.5f, {0.75f, 0.2f, 0.1f}};
        return make_capture(scene, 0);
    }
    Image run(const std::string& step) {
        Bench bench(effects_, look_of(step));
        return bench.color(scene());
    }
    EffectFolder effects_;
};

TEST_F(MixAndMask, MixGoesFromTheImageBeforeToTheImageMade) {
    EXPECT_EQ(run(R"({ "effect": "white", "mix": 0 })").at(1, 1, 0), 0.25f);
    EXPECT_EQ(run(R"({ "effect": "white", "mix": 1 })").at(1, 1, 0), 1.0f);
    EXPECT_FLOAT_EQ(run(R"({ "effect": "white", "mix": 0.5 })").at(1, 1, 0), 0.625f);
    EXPECT_FLOAT_EQ(run(R"({ "effect": "white", "mix": { "keys": { "-10": 0, "10": 1 } } })").at(1, 1, 0),
                    0.625f);
    Bench set(effects_, look_of(R"({ "effect": "white" })"), {{"white.mix=0.25"}, {}});
    EXPECT_FLOAT_EQ(set.color(scene()).at(1, 1, 0), 0.4375f);
}

TEST_F(MixAndMask, AMaskIsARoleAnObjectOrAFile) {
    for (const char* mask : {R"({ "role": "mask" })", R"({ "object": 2 })", R"({ "object": [7, 2] })",
                             R"({ "object": 0, "invert": true })"}) {
        const Image image = run(std::string(R"({ "effect": "white", "mask": )") + mask + " }");
        EXPECT_EQ(image.at(1, 1, 0), 0.25f) << mask;
        EXPECT_EQ(image.at(13, 3, 0), 1.0f) << mask;
    }
    const TemporaryFolder folder;
    Image half(20, 10, 3);
    for (int y = 0; y < 10; ++y)
        for (int x = 10; x < 20; ++x)
            for (int c = 0; c < 3; ++c) half.at(x, y, c) = 1;
    write_png(folder / "right.png", half);
    const Image image =
        run(R"({ "effect": "white", "mask": { "file": ")" + (folder / "right.png").string() + "\" } }");
    EXPECT_EQ(image.at(1, 1, 0), 0.25f);
    EXPECT_EQ(image.at(18, 8, 0), 1.0f);
}

TEST_F(MixAndMask, ThatComeAsAPngOfAnotherSpaceSayThatItIsNotApplied) {
    const TemporaryFolder folder;
    Image half(20, 10, 1);
    std::ranges::fill(half.floats(), 0.5f);
    const std::string file = (folder / "half.png").string(), png = encode_png("", half);
    const std::string step = R"({ "effect": "white", "mask": { "file": ")" + file + "\" } }";
    write_text(file, png);
    EXPECT_EQ(Bound(effects_, look_of(step)).faults(), "");
    write_text(file, png_with_chunk(png, "gAMA", png_number(100000)));
    const std::string faults = Bound(effects_, look_of(step)).faults();
    EXPECT_NE(faults.find("warning: '" + file + "': its gAMA 1 is not applied"), std::string::npos) << faults;
    const Capture grey = make_capture({.width = 20, .height = 10, .background = {0.25f, 0.25f, 0.25f}});
    EXPECT_NEAR(Bench(effects_, look_of(step)).color(grey).at(1, 1, 0), 0.25f + 0.75f * 128 / 255, 1e-6f);
}

/// One row of a pixel for each id.
Capture capture_of_ids(const std::vector<std::uint32_t>& ids) {
    Capture capture =
        make_capture({.width = int(ids.size()), .height = 1, .background = {0.25f, 0.25f, 0.25f}});
    for (std::size_t x = 0; x < ids.size(); ++x)
        capture.images.at("object_id").uint_at(int(x), 0, 0) = ids[x];
    return capture;
}

TEST_F(MixAndMask, AMaskTakesRangesListsAndNames) {
    const std::vector<std::uint32_t> ids = {0, 1, 5, 8, 9, 11, 12, cryptomatte_hash("Wheel"), 4294967295u};
    const Capture capture = capture_of_ids(ids);
    const auto painted = [&](const std::string& objects) {
        Bench bench(effects_, look_of(R"({ "effect": "white", "mask": { "object": )" + objects + " } }"));
        const Image image = bench.color(capture);
        std::vector<std::uint32_t> found;
        for (std::size_t x = 0; x < ids.size(); ++x)
            if (image.at(int(x), 0, 0) == 1) found.push_back(ids[x]);
            else EXPECT_EQ(image.at(int(x), 0, 0), 0.25f);
        return found;
    };
    using Ids = std::vector<std::uint32_t>;
    EXPECT_EQ(painted(R"(["1-8"])"), (Ids{1, 5, 8}));
    EXPECT_EQ(painted(R"("8-9,12")"), (Ids{8, 9, 12}));
    EXPECT_EQ(painted(R"(["11-12", 0, "Wheel"])"), (Ids{0, 11, 12, cryptomatte_hash("Wheel")}));
    EXPECT_EQ(painted(R"(["0-4294967295"])"), Ids(ids));
    EXPECT_EQ(painted(R"([4294967295, "2-4"])"), Ids{4294967295u});
}

TEST_F(MixAndMask, AMaskHasEveryObjectOfALongList) {
    std::vector<std::uint32_t> ids;
    std::string even;
    for (std::uint32_t id = 0; id < 2000; ++id) {
        ids.push_back(id);
        if (id % 2 == 0) even += (even.empty() ? "" : ", ") + std::to_string(1998 - id);
    }
    Bench bench(effects_, look_of(R"({ "effect": "white", "mask": { "object": [)" + even + "] } }"));
    const Image image = bench.color(capture_of_ids(ids));
    for (int x = 0; x < int(ids.size()); ++x) ASSERT_EQ(image.at(x, 0, 0), x % 2 == 0 ? 1.0f : 0.25f) << x;
}

TEST_F(MixAndMask, ThatHaveNothingToWorkOnAreErrors) {
    const auto faults = [&](const std::string& step) { return Bound(effects_, look_of(step)).faults(); };
    EXPECT_NE(faults(R"({ "effect": "view_transform", "mix": 0.5 })").find("no earlier step has made one"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "effect": "white", "mix": 2 })").find("white.mix: 2 is above the maximum 1"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "effect": "white", "mask": { "role": "velocity" } })").find("one channel"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "effect": "white", "mask": {} })").find("one of 'role', 'object' and 'file'"),
              std::string::npos);
    EXPECT_NE(faults(R"({ "effect": "white", "mask": { "file": "no.png" } })").find("no file 'no.png'"),
              std::string::npos);
}

TEST_F(MixAndMask, TablesCurvesAndFilesReachTheShader) {
    const TemporaryFolder folder;
    write_text(folder / "swap.cube",
               "LUT_3D_SIZE 2\n0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n");
    effects_.add("rich", R"(
        "inputs": { "color": { "role": "color" }, "object_id": { "role": "object_id" } },
        "outputs": { "color": { "role": "color" } },
        "params": {
          "gains": { "type": "table", "doc": ".", "columns": {
              "gain": { "type": "float", "default": 1, "doc": "." } } },
          "tone": { "type": "curve", "default": [[0, 0], [1, 1]], "doc": "." },
          "grade": { "type": "file", "kind": "lut", "default": "", "doc": "." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "object_id"],
                      "writes": ["color"] } ])",
                 R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 rgb = texelFetch(color, p, 0).rgb * gains(texelFetch(object_id, p, 0).r).gain;
    rgb.g = tone(rgb.g);
#ifdef HAS_GRADE
    rgb = grade(rgb);
#endif
    out_color = vec4(rgb, 1.0);
})");
    const Image image = run(R"({ "effect": "rich", "params": {
        "gains": { "rows": [ { "object": 2, "gain": 0.5 } ] },
        "tone": [[0, 0], [0.5, 1], [1, 1]],
        "grade": ")" + (folder / "swap.cube").string() +
                            R"(" } })");
    // Red and blue change places; green goes through the curve; object 2 is halved first.
    EXPECT_NEAR(image.at(1, 1, 2), 0.25f, 1e-6);
    EXPECT_NEAR(image.at(1, 1, 1), 1.0f, 1e-3);
    EXPECT_NEAR(image.at(13, 3, 2), 0.375f, 1e-6);
    EXPECT_NEAR(image.at(13, 3, 1), 0.2f, 1e-3);
    EXPECT_NEAR(image.at(13, 3, 0), 0.05f, 1e-6);
}

TEST_F(MixAndMask, AManifestsOwnFilesLieInItsFolderAndThoseOfKeysInTheLooks) {
    effects_.add("tabled", R"(
        "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "params": { "grade": { "type": "file", "kind": "lut", "default": "own.cube", "doc": "." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])",
                 R"(
void main() {
    out_color = vec4(grade(texelFetch(color, ivec2(gl_FragCoord.xy), 0).rgb), 1.0);
})");
    write_text(effects_.path() / "tabled/own.cube", "LUT_1D_SIZE 2\n0.75 0.75 0.75\n0.75 0.75 0.75\n");
    EXPECT_NEAR(run(R"({ "effect": "tabled" })").at(1, 1, 0), 0.75f, 1e-6);
    const TemporaryFolder folder;
    for (const char* level : {"0.25", "0.5"})
        write_text(folder / (std::string(level) + ".cube"),
                   std::string("LUT_1D_SIZE 2\n") + level + " 0 0\n" + level + " 0 0\n");
    const auto keyed = [&](const std::string& second) {
        write_text(folder / "look.json", look_of(R"({ "effect": "tabled", "params": { "grade":
            { "keys": { "1": "0.25.cube", "2": ")" +
                                                 second + "\" } } } }"));
        Diagnostics diagnostics;
        EffectRegistry registry({effects_.path()});
        const auto look = read_look(folder / "look.json", diagnostics);
        const Pipeline pipeline = bind_pipeline(look.value(), registry, {}, diagnostics);
        std::ostringstream faults;
        diagnostics.print(faults);
        std::string text = faults.str();
        for (const ParamValue& value :
             pipeline.steps.at(0).known_values(pipeline.steps[0].manifest->params.at(0)))
            text += std::get<std::string>(value) + "\n";
        return text;
    };
    EXPECT_EQ(keyed("0.5.cube"),
              (folder / "0.25.cube").string() + "\n" + (folder / "0.5.cube").string() + "\n");
    EXPECT_NE(keyed("none.cube").find("tabled.grade: no file '" + (folder / "none.cube").string()),
              std::string::npos);
}

TEST_F(MixAndMask, NeighbourFramesAreSeenWhereTheyAreThere) {
    effects_.add("ahead", R"(
        "inputs": { "color": { "role": "color" },
                    "later": { "role": "color", "frame": 1, "optional": true } },
        "outputs": { "color": { "role": "color" } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "later"],
                      "writes": ["color"] } ])",
                 R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef HAS_LATER
    out_color = texelFetch(later, p, 0);
#else
    out_color = texelFetch(color, p, 0) * 2.0;
#endif
})");
    Bench bench(effects_, look_of(R"({ "effect": "ahead" })"));
    const Capture now = scene();
    Capture then = scene();
    for (float& value : then.images.at("color").floats()) value += 3;
    FrameInputs frame;
    frame.capture = &now;
    frame.neighbours[1] = &then;
    EXPECT_EQ(bench.run(frame).images.at("color").at(1, 1, 0), 3.25f);
    frame.neighbours.clear();
    EXPECT_EQ(bench.run(frame).images.at("color").at(1, 1, 0), 0.5f);
}

TEST_F(MixAndMask, AnInputIsReadOnlyWhereItsConditionsMayHold) {
    effects_.add("ahead", R"(
        "inputs": { "color": { "role": "color" },
                    "later": { "role": "color", "frame": 1, "optional": true, "when": { "look": "ahead" } },
                    "depth": { "role": "depth", "optional": true, "when": { "look": ["ahead", "down"] } } },
        "outputs": { "color": { "role": "color" } },
        "params": { "look": { "type": "enum", "values": ["here", "ahead", "down"], "default": "here", "doc": "." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "later", "depth"],
                      "writes": ["color"] } ])",
                 R"(
void main() {
    out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
#ifdef HAS_LATER
    out_color.r += 10.0 + 0.0 * texelFetch(later, ivec2(0), 0).r;
#endif
#ifdef HAS_DEPTH
    out_color.r += texelFetch(depth, ivec2(0), 0).r > 0.0 ? 100.0 : 0.0;
#endif
})");
    const Capture capture = scene();
    FrameInputs frame;
    frame.capture = frame.neighbours[1] = &capture;
    const std::vector<std::string> none{}, color{"color"}, both{"color", "depth"};
    const auto with = [&](const std::string& value) {
        return look_of(R"({ "effect": "ahead", "params": { "look": )" + value + " } }");
    };
    const auto red = [&](const std::string& value) {
        Bench bench(effects_, with(value));
        return bench.run(frame).images.at("color").at(1, 1, 0);
    };
    EXPECT_EQ(red(R"("here")"), 0.25f);
    EXPECT_EQ(red(R"("down")"), 100.25f);
    EXPECT_EQ(red(R"("ahead")"), 110.25f);
    EXPECT_EQ(red(R"({ "keys": { "1": "here", "9": "ahead" } })"), 110.25f) << "may hold in some frame";
}

}  // namespace
}  // namespace aftershade::test
