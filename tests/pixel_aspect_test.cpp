// Frames whose pixels are not square: steps that draw round shapes work on square ones that stand for them.
#include <algorithm>
#include <array>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "framework/look/pixel_shape.h"
#include "framework/look/reach.h"
#include "tests/backends.h"
#include "tests/every_effect.h"
#include "tests/render/effect_fixture.h"
#include "tests/square_pixels_by_hand.h"

namespace aftershade::test {
namespace {

void expect_equal(const Image& image, const Image& expected, const std::string& what) {
    ASSERT_EQ(image.width(), expected.width()) << what;
    ASSERT_EQ(image.height(), expected.height()) << what;
    float most = 0;
    for (std::size_t i = 0; i < image.floats().size(); ++i) {
        const float a = image.floats()[i], b = expected.floats()[i];
        if (a != b) most = std::max(most, std::abs(a - b) / std::max(1.0f, std::abs(b)));
    }
    EXPECT_LE(most, 1e-6f) << what;
}

constexpr std::array kAspects = {2.0f, 1.5f, 0.5f};

Capture lens_capture(float aspect) {
    Capture capture = small_capture();
    CaptureHeader& header = capture.header;
    header.pixel_aspect = aspect;
    header.data_window = {-3, -5, 60, 30};
    header.display_window = {0, 0, 57, 26};
    header.camera.jitter_px = {0.25, -0.125};
    header.camera.set("focal_length", 50);
    header.camera.set("sensor_width", 12);
    header.camera.set("focus_distance", 3);
    header.camera.set("f_number", 2);
    return capture;
}

// ---- which steps ----

bool works_on_square_pixels(const std::string& effect) {
    Diagnostics diagnostics;
    Pipeline pipeline;
    pipeline.steps.resize(1);
    pipeline.steps.front().manifest = registry().find(effect, diagnostics);
    return SquareSteps(pipeline, 2).contains(0);
}

TEST(PixelAspect, EveryEffectWorksOnSquarePixelsButThoseOfNeighboursAndOfJitteredSamples) {
    const std::set<std::string> stored = {
        "color_convert", "color_grade", "ocio_file_transform",  "ocio_view",     "sanitize", "sss_combine",
        "sss_prepare",   "taa",         "velocity_from_camera", "view_transform"};
    for (const std::string& effect : registry().ids())
        EXPECT_EQ(works_on_square_pixels(effect), !stored.contains(effect)) << effect;
}

std::vector<std::string> notes_of(LookRunner& runner, float aspect, int frame = 1) {
    Capture capture = lens_capture(aspect);
    capture.header.frame = frame;
    return runner.run(capture).messages;
}

TEST(PixelAspect, ANoteSaysTheSizeOnceAndAgainWhereTheAspectChanges) {
    const std::string look = R"({"aftershade": 1, "steps": [{"effect": "color_grade"}, {"effect": "dof"},
        {"effect": "color_grade", "name": "grade"}, {"effect": "bloom"}, {"effect": "view_transform"}]})";
    LookRunner runner(look, backends().front());
    EXPECT_EQ(notes_of(runner, 2, 1),
              std::vector<std::string>{"note: steps 'dof' to 'bloom' work on 128 x 36 square pixels (the "
                                       "capture's pixel aspect is 2)"});
    EXPECT_TRUE(notes_of(runner, 2, 2).empty());
    EXPECT_EQ(notes_of(runner, 0.5f, 3),
              std::vector<std::string>{"note: steps 'dof' to 'bloom' work on 64 x 72 square pixels (the "
                                       "capture's pixel aspect is 0.5)"});
    EXPECT_TRUE(notes_of(runner, 1, 4).empty());
}

TEST(PixelAspect, AnErrorNamesASideThatNoTextureHas) {
    LookRunner runner(look_of("bloom", {}), backends().front());
    try {
        notes_of(runner, 5000);
        FAIL();
    } catch (const std::exception& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("synthetic: step 'bloom' works on 320000 x 36 square pixels (the capture's pixel "
                            "aspect is 5000), and a side may have at most "),
                  std::string::npos)
            << text;
        EXPECT_NE(text.find("pixelAspectRatio"), std::string::npos) << text;
    }
    EXPECT_FALSE(notes_of(runner, 2).empty());
}

// ---- the same as by hand ----

class PixelAspectOf : public EveryEffect {};

TEST_P(PixelAspectOf, IsWhatTheEffectMakesOfSquarePixelsByHand) {
    if (!works_on_square_pixels(GetParam())) GTEST_SKIP() << "works on stored pixels";
    for (const float aspect : kAspects) {
        const ByHand hand{double(aspect)};
        const Capture capture = with_aovs(lens_capture(aspect)), wide = hand.widened(capture);
        Capture before = capture, wide_before = wide;
        before.header.frame = wide_before.header.frame = capture.header.frame - 1;
        const auto run = [&](const Capture& now, const Capture& earlier) {
            FrameInputs frame;
            frame.capture = &now;
            frame.neighbours[-1] = &earlier;
            return LookRunner(look_of(GetParam(), {}), backends().front()).run(frame);
        };
        const FrameResult made = run(capture, before), expected = run(wide, wide_before);
        ASSERT_EQ(made.images.size(), expected.images.size());
        for (const auto& [role, image] : expected.images)
            expect_equal(made.images.at(role), hand.narrowed(image, role, capture),
                         role + " at " + std::to_string(aspect));
    }
}

INSTANTIATE_TEST_SUITE_P(Shipped, PixelAspectOf, testing::ValuesIn(registry().ids()),
                         [](const auto& test) { return test.param; });

TEST(PixelAspect, OfSubframesAndOfTheStepsAfterThemIsThatOfSquarePixelsByHand) {
    // The second dof reads the depth of the exposure's middle, the first that of each sub-frame.
    const std::string look =
        R"({"aftershade": 1, "steps": [{"effect": "dof_simple"}, {"effect": "accumulate"},
        {"effect": "dof_simple", "name": "again"}, {"effect": "bloom"}]})";
    for (const float aspect : kAspects) {
        const ByHand hand{double(aspect)};
        LookRunner runner(look, backends().front()), wide_runner(look, backends().front());
        const Capture last = lens_capture(aspect);
        FrameResult made, expected;
        for (int subframe = 0; subframe < 3; ++subframe) {
            Capture capture = last;
            for (float& depth : capture.images.at("depth").floats()) depth *= 1 + 0.4f * float(2 - subframe);
            const Capture wide = hand.widened(capture);
            FrameInputs frame;
            frame.subframe = subframe;
            frame.subframe_count = 3;
            frame.capture = &capture;
            made = runner.run(frame);
            frame.capture = &wide;
            expected = wide_runner.run(frame);
        }
        expect_equal(made.images.at("color"), hand.narrowed(expected.images.at("color"), "color", last),
                     std::to_string(aspect));
    }
}

/// The colour two pixels to the right, and that of the frame before two pixels below.
const char* const kTrailManifest =
    R"("reach": 2, "inputs": { "color": { "role": "color", "history": true } },
       "outputs": { "color": { "role": "color" } },
       "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "color.prev"],
                      "writes": ["color"] } ])";
const char* const kTrailShader = R"(void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_color = texelFetch(color, min(pixel + ivec2(2, 0), frame.size - 1), 0);
    ivec2 below = min(pixel + ivec2(0, 2), frame.size - 1);
    if (frame.history_valid) out_color += 0.5 * texelFetch(color_prev, below, 0);
}
)";

TEST(PixelAspect, OfAHistoryIsThatOfSquarePixelsByHandAndAnotherAspectEndsIt) {
    EffectFolder effects;
    effects.add("trail", kTrailManifest, kTrailShader);
    for (const float aspect : kAspects) {
        const ByHand hand{double(aspect)};
        Bench bench(effects, look_of(R"({"effect": "trail"})")),
            wide_bench(effects, look_of(R"({"effect": "trail"})"));
        for (int number = 1; number < 4; ++number) {
            Capture capture = lens_capture(aspect);
            capture.header.frame = number;
            for (float& value : capture.images.at("color").floats()) value *= float(number);
            const FrameResult made = bench.run(capture);
            EXPECT_EQ(made.history_reset, number == 1 ? "the first frame" : "");
            expect_equal(made.images.at("color"),
                         hand.narrowed(wide_bench.color(hand.widened(capture)), "color", capture),
                         std::to_string(aspect) + ", frame " + std::to_string(number));
        }
        Capture other = lens_capture(aspect * 1.25f);
        other.header.frame = 4;
        EXPECT_EQ(bench.run(other).history_reset, "another pixel aspect");
    }
}

TEST(PixelAspect, OfAMixByAMaskIsThatOfSquarePixelsByHand) {
    for (const char* mask : {R"({"role": "mask"})", R"({"object": [1]})"}) {
        const std::string look = std::string(R"({"aftershade": 1, "steps": [{"effect": "color_grade"},
            {"effect": "bloom", "mix": 0.7, "mask": )") +
                                 mask + "}]}";
        for (const float aspect : kAspects) {
            const ByHand hand{double(aspect)};
            const Capture capture = lens_capture(aspect);
            expect_equal(LookRunner(look, backends().front()).color(capture),
                         hand.narrowed(LookRunner(look, backends().front()).color(hand.widened(capture)),
                                       "color", capture),
                         mask + std::to_string(aspect));
        }
    }
}

// ---- stored pixels ----

/// Takes square pixels, and changes none.
void add_same(EffectFolder& effects) {
    effects.add_color(
        "same", "source",
        R"("size": { "type": "float", "unit": "px", "default": 1, "min": 0, "max": 9, "doc": "Nothing." })");
    effects.add(
        "same_motion",
        R"("reach": "all", "inputs": { "velocity": { "role": "velocity" }, "depth": { "role": "depth" } },
                   "outputs": { "velocity": { "role": "velocity" }, "depth": { "role": "depth" } },
                   "passes": [ { "name": "main", "shader": "main.frag", "reads": ["velocity", "depth"],
                                  "writes": ["velocity", "depth"] } ])",
        "void main() {\n    out_velocity = texelFetch(velocity, ivec2(gl_FragCoord.xy), 0).xy;\n"
        "    out_depth = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).x;\n}\n");
}

Capture noise_capture(int width, int height, float aspect) {
    Capture capture = make_capture({.width = width, .height = height});
    capture.header.pixel_aspect = aspect;
    std::uint32_t state = 1;
    for (const char* role : {"color", "depth", "velocity"})
        for (float& value : capture.images.at(role).floats())
            value = float(state = state * 1664525 + 1013904223) / 1e9f - 2;
    return capture;
}

TEST(PixelAspect, AStepThatChangesNothingGivesTheInputBackToTheBit) {
    EffectFolder effects;
    add_same(effects);
    Bench bench(effects, look_of(R"({"effect": "same"}, {"effect": "same_motion"})"));
    for (const float aspect : {2.0f, 0.5f, 1.5f, 1.3333f, 1.0926f, 0.3f, 7.0f, 1.0f})
        for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 3}, {3, 2}, {37, 23}}) {
            const Capture capture = noise_capture(width, height, aspect);
            const FrameResult made = bench.run(capture, {"color", "depth", "velocity"});
            for (const char* role : {"color", "depth"})
                EXPECT_TRUE(same_bits(made.images.at(role), capture.images.at(role)))
                    << role << " of " << width << " x " << height << " px at " << aspect;
            // Multiplied and divided by the stretch.
            expect_equal(made.images.at("velocity"), capture.images.at("velocity"), "velocity");
        }
}

TEST(PixelAspect, OfStepsThatLookAtNoOtherPixelMattersNothing) {
    const EffectFolder none;
    const std::string look =
        look_of(R"({"effect": "sanitize"}, {"effect": "color_grade", "params": {"exposure": 0.7}},
                                        {"effect": "view_transform"})");
    Bench square(none, look), wide(none, look);
    const FrameResult expected = square.run(lens_capture(1)), made = wide.run(lens_capture(2));
    EXPECT_TRUE(same_bits(made.images.at("display"), expected.images.at("display")));
    EXPECT_TRUE(same_bits(made.images.at("color"), expected.images.at("color")));
    EXPECT_EQ(wide.renderer().graph_dot(), square.renderer().graph_dot());
    EXPECT_EQ(wide.renderer().graph_dot().find("@square pixels"), std::string::npos);
}

TEST(PixelAspect, StepsBeforeAndAfterTheRoundOnesWorkOnStoredPixels) {
    const EffectFolder none;
    const std::string grade = R"({"effect": "color_grade", "params": {"exposure": 0.7}})";
    const std::string dof = R"({"effect": "dof"})", view = R"({"effect": "view_transform"})";
    for (const float aspect : kAspects) {
        Capture capture = lens_capture(aspect);
        Bench whole(none, look_of(grade + ", " + dof + ", " + view));
        const Image display = whole.run(capture).images.at("display");
        for (const std::string& step : {grade, dof})
            capture.images.at("color") = Bench(none, look_of(step)).color(capture);
        EXPECT_TRUE(same_bits(display, Bench(none, look_of(view)).run(capture).images.at("display")))
            << aspect;
        EXPECT_NE(whole.renderer().graph_dot().find("@square pixels"), std::string::npos);
    }
}

TEST(PixelAspect, StepsThatAreDrawnAgainReadTheSquarePixelsOfThoseThatAreNot) {
    const EffectFolder none;
    const Bound bound(none, look_of(R"({"effect": "color_grade"}, {"effect": "dof_simple"},
                                       {"effect": "sharpen"}, {"effect": "view_transform"})"));
    for (const float aspect : kAspects) {
        const Capture capture = lens_capture(aspect);
        FrameInputs frame;
        frame.capture = &capture;
        gpu::Context context(gpu::test_backend());
        Pipeline pipeline = bound.pipeline();
        PipelineRenderer kept(context, pipeline, kRoot, {}, {.keeps_steps = true});
        (void)kept.render(frame, {"display"}, false);
        const std::pair<std::size_t, const char*> changes[] = {
            {2, "amount"}, {1, "low_radius"}, {0, "exposure"}};
        for (const auto& [step, param] : changes) {
            pipeline.steps[step].values[param] = ParamValue(0.75);
            pipeline.steps[step].origins[param] = "the test";
            const Image again = kept.render_again(frame, {"display"}, false).images.at("display");
            EXPECT_TRUE(same_bits(again, PipelineRenderer(context, pipeline, kRoot)
                                             .render(frame, {"display"}, false)
                                             .images.at("display")))
                << "step " << step << " at " << aspect;
        }
    }
}

TEST(PixelAspect, APartOfAFrameBeginsWhereTilesOfSquarePixelsDo) {
    const RegionNeeds needs{.margin_px = 20, .align_px = 8};
    EXPECT_EQ(in_stored_pixels(needs, {})->align_px, 8);
    EXPECT_EQ(in_stored_pixels(needs, square_pixels(2))->align_px, 8);
    EXPECT_EQ(in_stored_pixels(needs, square_pixels(1.5f))->align_px, 16);  // 24 square ones
    EXPECT_FALSE(in_stored_pixels(needs, square_pixels(1.0926f)));          // 54 to 59: none below 256
    EXPECT_EQ(in_stored_pixels({.margin_px = 20}, square_pixels(1.0926f))->margin_px, 20);
}

// ---- round on the display ----

struct Spread {
    double x = 0, y = 0;  ///< variances, in square pixels
};

/// A spot that is round on the display, of a side of 120 square pixels.
Spread spread_of(const std::string& effect, const Values& values, float aspect) {
    const double pixel_x = std::max(1.0, double(aspect)), pixel_y = std::max(1.0, 1 / double(aspect));
    Capture capture =
        make_capture({.width = int(120 / pixel_x), .height = int(120 / pixel_y), .background_depth_m = 1});
    capture.header.pixel_aspect = aspect;
    Camera& camera = capture.header.camera;
    camera.set("focal_length", 50);
    camera.set("sensor_width", 7);
    camera.set("focus_distance", 4);
    camera.set("f_number", 1.4);
    Image& color = capture.images.at("color");
    const auto from_middle = [&](int x, int y) {
        return std::pair((x + 0.5) * pixel_x - 60, (y + 0.5) * pixel_y - 60);
    };
    for (int y = 0; y < color.height(); ++y)
        for (int x = 0; x < color.width(); ++x) {
            const auto [from_x, from_y] = from_middle(x, y);
            const float light = std::hypot(from_x, from_y) < 6 ? 50.0f : 0.0f;
            for (int c = 0; c < 3; ++c) color.at(x, y, c) = light;
        }
    const Image blurred = LookRunner(look_of(effect, values), backends().front()).color(capture);
    double sum = 0;
    Spread spread;
    for (int y = 0; y < blurred.height(); ++y)
        for (int x = 0; x < blurred.width(); ++x) {
            const auto [from_x, from_y] = from_middle(x, y);
            const double light = blurred.at(x, y, 0);
            sum += light;
            spread.x += light * from_x * from_x;
            spread.y += light * from_y * from_y;
        }
    return {spread.x / sum, spread.y / sum};
}

TEST(PixelAspect, BlursAreRoundOnTheDisplayAndAsWideAsThoseOfSquarePixels) {
    const Values bloom = {{"intensity", ParamValue(1.0)}, {"radius", ParamValue(12.0)}};
    for (const char* effect : {"dof", "dof_simple", "dof_layered", "dof_scatter", "bokeh_disk",
                               "bokeh_gather", "bokeh_hexagon", "bloom"}) {
        const Values values = std::string(effect) == "bloom" ? bloom : Values{};
        const Spread square = spread_of(effect, values, 1);
        EXPECT_GT(square.x, 15) << effect;  // the spot's is 9
        for (const float aspect : kAspects) {
            const Spread spread = spread_of(effect, values, aspect);
            EXPECT_NEAR(spread.x / spread.y, square.x / square.y, 0.05) << effect << " at " << aspect;
            EXPECT_NEAR(spread.x / square.x, 1, 0.06) << effect << " at " << aspect;
        }
    }
}

TEST(PixelAspect, AMotionBlursStreakHasTheSameLengthOnTheDisplayInBothDirections) {
    const auto streak = [](float aspect, int axis) {
        const double pixel = axis == 0 ? std::max(1.0, double(aspect)) : std::max(1.0, 1 / double(aspect));
        Capture capture = make_capture({.width = 61, .height = 61, .background_depth_m = 1});
        capture.header.pixel_aspect = aspect;
        for (int i = 0; i < 61 * 61; ++i)
            for (const char* role : {"velocity", "velocity_next"})
                capture.images.at(role).floats()[std::size_t(2 * i + axis)] = float(24 / pixel);
        for (int c = 0; c < 3; ++c) capture.images.at("color").at(30, 30, c) = 100;
        const Image blurred = LookRunner(look_of("motion_blur", {}), backends().front()).color(capture);
        double sum = 0, spread = 0;
        for (int y = 0; y < 61; ++y)
            for (int x = 0; x < 61; ++x) {
                const double light = blurred.at(x, y, 0), from = ((axis == 0 ? x : y) - 30) * pixel;
                sum += light;
                spread += light * from * from;
            }
        // A pixel has a width of its own.
        return std::sqrt(12 * spread / sum + pixel * pixel);
    };
    for (const int axis : {0, 1})
        for (const float aspect : kAspects)
            EXPECT_NEAR(streak(aspect, axis) / streak(1, axis), 1, 0.08) << aspect;
}

}  // namespace
}  // namespace aftershade::test
