#include "framework/render/renderer.h"

#include <algorithm>
#include <cstring>

#include "framework/base/error.h"
#include "tests/backends.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

const char* const kColorOnly =
    R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },)";
const char* const kOnePass =
    R"("passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])";

Capture plain(int width = 7, int height = 5, Rgb color = {0.25f, 0.5f, 1}) {
    return make_capture({.width = width, .height = height, .background = color, .background_depth_m = 4});
}

Rgb at(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

void expect_everywhere(const Image& image, Rgb expected) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb value = at(image, x, y);
            ASSERT_EQ(value.r, expected.r) << x << ", " << y;
            ASSERT_EQ(value.g, expected.g) << x << ", " << y;
            ASSERT_EQ(value.b, expected.b) << x << ", " << y;
        }
}

class RendererOn : public gpu::OnEachBackend {};
ON_EACH_BACKEND(RendererOn);

TEST_P(RendererOn, CopiesColorBitForBitThroughAnIdentity) {
    EffectFolder effects;
    effects.add_color("identity", "source");
    Capture capture = plain(8, 4);
    const std::uint32_t bits[] = {
        0x7fc00000, 0x7f800000, 0xff800000, 0x80000000,  // NaN, +inf, -inf, -0
        0x00000001, 0x807fffff, 0x7f7fffff, 0x3f800001,  // denormals, largest, 1 + ulp
        0xffc00001, 0x00800000};
    std::span<float> values = capture.images.at("color").floats();
    for (std::size_t i = 0; i < std::size(bits); ++i) std::memcpy(&values[i], &bits[i], sizeof bits[i]);
    std::uint32_t state = 7;
    for (std::size_t i = std::size(bits); i < values.size(); ++i)
        values[i] = float(std::int32_t(state = state * 1664525u + 1013904223u)) * 1e-7f;
    const std::string twice = R"({ "effect": "identity" }, { "effect": "identity", "name": "again" })";
    const Image color = Bench(effects, look_of(twice), {}, GetParam()).color(capture);
    ASSERT_EQ(color.channels(), 4);
    EXPECT_EQ(std::memcmp(color.floats().data(), values.data(), values.size_bytes()), 0);
}

TEST_P(RendererOn, CarriesEveryKindOfRole) {
    EffectFolder effects;
    const auto add = [&](const std::string& role) {
        effects.add(role + "_copy",
                    R"("inputs": { "image": { "role": ")" + role +
                        R"(" } }, "outputs": { "result": { "role": ")" + role +
                        R"(" } }, "passes": [ { "name": "main", "shader": "main.frag", "reads": ["image"],
                                               "writes": ["result"] } ])",
                    "void main() { out_result = texelFetch(image, ivec2(gl_FragCoord.xy), 0)" +
                        std::string(role == "velocity"                       ? ".xy"
                                    : role == "depth" || role == "object_id" ? ".r"
                                                                             : "") +
                        "; }\n");
    };
    Capture capture = plain();
    std::string steps;
    const std::vector<std::string> roles{"depth", "velocity", "normal", "albedo", "object_id"};
    for (const std::string& role : roles) {
        add(role);
        steps += std::string(steps.empty() ? "" : ", ") + R"({ "effect": ")" + role + "_copy\" }";
        Image& image = capture.images.at(role);
        if (role == "object_id")
            for (std::size_t i = 0; i < image.uints().size(); ++i)
                image.uints()[i] = 0xfffffff0u - std::uint32_t(i);
        else
            for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = float(i) * 0.37f - 2;
    }
    const FrameResult result = Bench(effects, look_of(steps), {}, GetParam()).run(capture, roles);
    ASSERT_EQ(result.images.size(), roles.size());
    for (const std::string& role : roles) {
        const Image& made = result.images.at(role);
        const Image& given = capture.images.at(role);
        ASSERT_EQ(made.channels(), given.channels()) << role;
        if (role == "object_id") EXPECT_TRUE(std::ranges::equal(made.uints(), given.uints()));
        else EXPECT_TRUE(std::ranges::equal(made.floats(), given.floats())) << role;
    }
}

TEST_P(RendererOn, ReadsZerosBesideTheChannelsThatAnAovHas) {
    EffectFolder effects;
    effects.add("show",
                R"("inputs": { "hair": { "role": "aov:hair" } }, "outputs": { "color": { "role": "color" } },
                           "passes": [ { "name": "main", "shader": "main.frag", "reads": ["hair"],
                                         "writes": ["color"] } ])",
                "void main() { out_color = texelFetch(hair, ivec2(gl_FragCoord.xy), 0); }\n");
    Capture capture = plain();
    Image hair(7, 5, 1);
    std::ranges::fill(hair.floats(), 0.5f);
    capture.images["aov:hair"] = hair;
    expect_everywhere(Bench(effects, look_of(R"({ "effect": "show" })"), {}, GetParam()).color(capture),
                      {0.5f, 0, 0});
}

TEST_P(RendererOn, GivesTheShaderItsParametersInTheirUnits) {
    EffectFolder effects;
    effects.add_color(
        "show",
        "vec4(param.reach, param.flag ? 1 : 2, param.mode == MODE_B ? 3 : 4, param.tint.y + float(COUNT))",
        R"("flag": { "type": "bool", "default": false, "doc": "." },
                         "reach": { "type": "float", "unit": "mm", "default": 1, "doc": "." },
                         "tint": { "type": "vec3", "default": [0, 0, 0], "doc": "." },
                         "count": { "type": "int", "default": 1, "bind": "define", "doc": "." },
                         "mode": { "type": "enum", "values": ["a", "b"], "default": "a", "doc": "." })");
    const std::string step =
        R"({ "effect": "show",
             "params": { "reach": "2.5 cm", "flag": true, "tint": [7, 8, 9], "mode": "b", "count": 5 } })";
    const Image color = Bench(effects, look_of(step), {}, GetParam()).color(plain());
    expect_everywhere(color, {25, 1, 3});
    EXPECT_EQ(color.at(0, 0, 3), 13);
}

class Renderer : public testing::Test {
protected:
    EffectFolder effects_;
};

TEST_F(Renderer, RunsStepsInOrderAndLeavesDisabledOnesOut) {
    effects_.add_color("add", "source + vec4(1, 1, 1, 0)");
    effects_.add_color("twice", "source * vec4(2, 2, 2, 1)");
    expect_everywhere(
        Bench(effects_, look_of(R"({ "effect": "add" }, { "effect": "twice" })")).color(plain()),
        {2.5f, 3, 4});
    expect_everywhere(
        Bench(effects_, look_of(R"({ "effect": "twice" }, { "effect": "add" })")).color(plain()),
        {1.5f, 2, 3});
    expect_everywhere(
        Bench(effects_, look_of(R"({ "effect": "add", "enabled": false }, { "effect": "twice" })"))
            .color(plain()),
        {0.5f, 1, 2});
}

TEST_F(Renderer, TakesAnInputFromAnyEarlierStep) {
    effects_.add_color("add", "source + vec4(1, 1, 1, 0)");
    effects_.add_color("twice", "source * vec4(2, 2, 2, 1)");
    const std::string steps =
        R"({ "effect": "add" }, { "effect": "twice" }, { "effect": "twice", "name": "last", "in": )";
    expect_everywhere(Bench(effects_, look_of(steps + R"({ "color": "add.color" } })")).color(plain()),
                      {2.5f, 3, 4});
    expect_everywhere(Bench(effects_, look_of(steps + R"({ "color": "capture.color" } })")).color(plain()),
                      {0.5f, 1, 2});
}

TEST_F(Renderer, ReturnsOnlyWhatAStepMade) {
    effects_.add_color("identity", "source");
    EXPECT_TRUE(Bench(effects_, look_of("")).run(plain()).images.empty());
    const FrameResult result =
        Bench(effects_, look_of(R"({ "effect": "identity" })")).run(plain(), {"color", "depth", "display"});
    EXPECT_EQ(result.images.size(), 1u);
}

TEST_F(Renderer, FollowsASizeThatChangesBetweenFrames) {
    effects_.add_color("place", "vec4(gl_FragCoord.xy, color_size.xy)");
    Bench bench(effects_, look_of(R"({ "effect": "place" })"));
    for (const auto& [width, height] :
         {std::pair(7, 5), std::pair(31, 17), std::pair(3, 40), std::pair(7, 5)}) {
        const Image color = bench.color(plain(width, height));
        ASSERT_EQ(color.width(), width);
        ASSERT_EQ(color.height(), height);
        EXPECT_EQ(color.at(width - 1, height - 1, 0), float(width) - 0.5f);
        EXPECT_EQ(color.at(width - 1, height - 1, 1), float(height) - 0.5f);
        EXPECT_EQ(color.at(0, 0, 2), float(width));
        EXPECT_EQ(color.at(0, 0, 3), float(height));
    }
}

// A graph is built from the shader files, so a file that changed shows whether one was built.
TEST_F(Renderer, BuildsAGraphAgainForAnotherSizeAndNotForAnotherFrameOrValue) {
    const std::string params =
        R"("reach": { "type": "float", "unit": "m", "default": 0, "from": "camera.focus_distance",
                       "doc": "." })";
    effects_.add_color("show", "vec4(param.reach, 1, frame.number, 1)", params);
    Bench bench(effects_, look_of(R"({ "effect": "show" })"));
    Capture capture = plain();
    expect_everywhere(bench.color(capture), {0, 1, 1});
    effects_.add_color("show", "vec4(param.reach, 2, frame.number, 1)", params);
    capture.header.frame = 9;
    capture.header.camera.set("focus_distance", 3);
    expect_everywhere(bench.color(capture), {3, 1, 9});
    expect_everywhere(bench.color(plain(6, 6)), {0, 2, 1});
    expect_everywhere(bench.color(capture), {3, 2, 9});
}

TEST_F(Renderer, BuildsAGraphAgainWhenAValueThatIsADefineChanges) {
    effects_.add_color(
        "show", "vec4(float(REACH))",
        R"("reach": { "type": "float", "unit": "m", "default": 0.5, "from": "camera.focus_distance",
                                     "bind": "define", "doc": "." })");
    Bench bench(effects_, look_of(R"({ "effect": "show" })"));
    Capture capture = plain();
    for (const double reach_m : {1.25, 2.5, 1.25}) {
        capture.header.camera.set("focus_distance", reach_m);
        EXPECT_EQ(bench.color(capture).at(0, 0, 0), float(reach_m));
    }
}

TEST_F(Renderer, FollowsAnOptionalRoleThatComesAndGoes) {
    effects_.add(
        "maybe",
        R"("inputs": { "color": { "role": "color" }, "depth": { "role": "depth", "optional": true } },
        "outputs": { "color": { "role": "color" } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["depth", "color"],
                      "writes": ["color"] } ])",
        R"(void main() {
    out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
#ifdef HAS_DEPTH
    out_color.r = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r;
#endif
})");
    Bench bench(effects_, look_of(R"({ "effect": "maybe" })"));
    const Capture with = plain();
    Capture without = plain();
    without.images.erase("depth");
    for (int i = 0; i < 2; ++i) {
        expect_everywhere(bench.color(with), {4, 0.5f, 1});
        expect_everywhere(bench.color(without), {0.25f, 0.5f, 1});
    }
}

TEST_F(Renderer, TellsTheShaderWhereItIsInTheDisplayWindow) {
    effects_.add_color("show", "vec4(vec2(frame.display_size), vec2(frame.origin))");
    Capture capture = plain();
    capture.header.display_window = {10, 20, 109, 79};
    capture.header.data_window = {13, 18, 19, 22};
    const Image color = Bench(effects_, look_of(R"({ "effect": "show" })")).color(capture);
    expect_everywhere(color, {100, 60, 3});
    EXPECT_EQ(color.at(0, 0, 3), -2);
}

TEST_F(Renderer, TellsTheShaderOfThisFramesAndTheLastFramesJitter) {
    effects_.add_color("show", "vec4(camera.jitter_px, camera.prev_jitter_px)");
    Bench bench(effects_, look_of(R"({ "effect": "show" })"));
    Capture capture = plain();
    capture.header.frame = 1;
    capture.header.camera.jitter_px = {0.25, -0.5};
    expect_everywhere(bench.color(capture), {0.25f, -0.5f, 0});
    capture.header.frame = 2;
    capture.header.camera.jitter_px = {0.125, 0};
    const Image second = bench.color(capture);
    expect_everywhere(second, {0.125f, 0, 0.25f});
    EXPECT_EQ(second.at(0, 0, 3), -0.5f);
}

/// An effect from color to color that uses the capture's lights.
void add_lit(EffectFolder& effects, const std::string& expression) {
    effects.add("lit", std::string(kColorOnly) + R"("uses": ["lights"],)" + kOnePass,
                "void main() { out_color = " + expression + " + 0 * texelFetch(color, ivec2(0), 0); }\n");
}

TEST_F(Renderer, GivesEffectsThatUseThemTheCapturesLights) {
    add_lit(effects_,
            "vec4(lights.light[0].position_m, lights.count) * float(lights.light[0].kind == LIGHT_AREA) + "
            "vec4(10 * lights.light[1].direction, lights.light[1].intensity.b) * "
            "float(lights.light[1].kind == LIGHT_DIRECTIONAL)");
    Bench bench(effects_, look_of(R"({ "effect": "lit" })"));
    Capture capture = plain();
    expect_everywhere(bench.color(capture), {0, 0, 0});
    capture.header.lights = {{CaptureLight::Kind::area, "key", {1, 2, 3}, {0, -1, 0}, {0.5, 0.25}, {4, 5, 6}},
                             {CaptureLight::Kind::directional, "", {}, {0, 0.5, 1}, {}, {7, 8, 9}}};
    const Image two = bench.color(capture);
    expect_everywhere(two, {1, 7, 13});
    EXPECT_EQ(two.at(0, 0, 3), 11);
    // Another frame's lights are its own.
    capture.header.lights = {{CaptureLight::Kind::area, "", {-4, 0, 0}, {0, 0, 1}, {1, 1}, {}}};
    capture.header.frame += 1;
    expect_everywhere(bench.color(capture), {-4, 0, 0});
}

TEST_F(Renderer, RefusesMoreLightsThanShadersTakeOnlyForEffectsThatUseThem) {
    add_lit(effects_, "vec4(lights.light[15].intensity, lights.count)");
    effects_.add_color("plain", "source");
    Capture capture = plain();
    capture.header.path = "many.exr";
    capture.header.lights.assign(16, {CaptureLight::Kind::point, "", {}, {}, {}, {1, 2, 3}});
    Bench lit(effects_, look_of(R"({ "effect": "lit", "name": "relight" })"));
    const Image color = lit.color(capture);
    expect_everywhere(color, {1, 2, 3});
    EXPECT_EQ(color.at(0, 0, 3), 16);
    capture.header.lights.resize(17);
    expect_everywhere(Bench(effects_, look_of(R"({ "effect": "plain" })")).color(capture), {0.25f, 0.5f, 1});
    try {
        lit.color(capture);
        FAIL() << "17 lights were taken";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        EXPECT_EQ(std::string(error.what()),
                  "many.exr: step 'relight' uses the capture's lights, of which there are 17; effects take "
                  "16. Name those that count in \"lights\" of capture.json");
    }
}

TEST_F(Renderer, GivesEachStepASeedThatAnotherStepDoesNotChange) {
    effects_.add_color("seed", "source + vec4(float(frame.step_seed >> 8u), 0, 0, 0)");
    const Capture black = plain(2, 2, {});
    const auto seed = [&](const std::string& steps, const std::string& tap) {
        return Bench(effects_, look_of(steps), {{}, {tap}}).run(black).taps.at(tap).at(0, 0, 0);
    };
    const std::string a = R"({ "effect": "seed", "name": "a" })";
    const std::string b = R"({ "effect": "seed", "name": "b", "in": { "color": "capture.color" } })";
    EXPECT_NE(seed(a + ", " + b, "a.color"), seed(a + ", " + b, "b.color"));
    EXPECT_EQ(seed(a + ", " + b, "b.color"), seed(b, "b.color"));
}

TEST_F(Renderer, SizesTexturesByScaleAndByTileRoundedUp) {
    effects_.add("sizes", std::string(kColorOnly) + R"("textures": {
            "small": { "format": "rgba32f", "scale": 0.5, "doc": "." },
            "tiles": { "format": "r32f", "tile": 4, "doc": "." } },
        "passes": [ { "name": "one", "shader": "one.frag", "reads": ["color"], "writes": ["small"] },
                    { "name": "two", "shader": "two.frag", "reads": ["color"], "writes": ["tiles"] },
                    { "name": "main", "shader": "main.frag", "reads": ["small", "tiles"],
                      "writes": ["color"] } ])",
                 "void main() { out_color = vec4(small_size.xy, tiles_size.xy); }\n");
    // Every input must be read and every texture be written.
    write_text(effects_.path() / "sizes/one.frag",
               std::string(kShaderHead) + "void main() { out_small = color_size; }\n");
    write_text(effects_.path() / "sizes/two.frag",
               std::string(kShaderHead) + "void main() { out_tiles = color_size.x; }\n");
    Bench bench(effects_, look_of(R"({ "effect": "sizes" })"), {{}, {"sizes.small", "sizes.tiles"}});
    const FrameResult result = bench.run(plain(9, 5));
    expect_everywhere(result.images.at("color"), {5, 3, 3});
    EXPECT_EQ(result.images.at("color").at(0, 0, 3), 2);
    EXPECT_EQ(result.taps.at("sizes.small").width(), 5);
    EXPECT_EQ(result.taps.at("sizes.tiles").channels(), 1);
    EXPECT_EQ(result.taps.at("sizes.tiles").at(2, 1, 0), 9);
}

TEST_F(Renderer, TapsWithoutChangingTheResult) {
    effects_.add_color("add", "source + vec4(1, 1, 1, 0)");
    effects_.add_color("twice", "source * vec4(2, 2, 2, 1)");
    const std::string look =
        look_of(R"({ "effect": "add" }, { "effect": "twice" }, { "effect": "add", "name": "more" },
                                        { "effect": "twice", "name": "end" })");
    const FrameResult plainly = Bench(effects_, look).run(plain());
    Bench bench(effects_, look, {{}, {"add.color", "more.color"}});
    for (int frame = 0; frame < 2; ++frame) {
        const FrameResult tapped = bench.run(plain());
        EXPECT_TRUE(
            std::ranges::equal(tapped.images.at("color").floats(), plainly.images.at("color").floats()));
        expect_everywhere(tapped.taps.at("add.color"), {1.25f, 1.5f, 2});
        expect_everywhere(tapped.taps.at("more.color"), {3.5f, 4, 5});
    }
}

class Conditional : public Renderer {
protected:
    Conditional() {
        effects_.add(
            "choose", std::string(kColorOnly) + R"(
            "params": { "mode": { "type": "enum", "values": ["a", "b", "none"],
                                  "default": "a", "doc": "." } },
            "textures": { "extra": { "format": "r32f", "doc": "." } },
            "passes": [ { "name": "a", "shader": "main.frag", "reads": ["color"], "writes": ["color"],
                          "when": { "mode": "a" },
                          "defines": { "LIGHT": 1 } },
                        { "name": "b", "shader": "main.frag", "reads": ["color"], "writes": ["color"],
                          "when": { "mode": ["b"] },
                          "defines": { "LIGHT": 2 } },
                        { "name": "extra", "shader": "extra.frag", "writes": ["extra"],
                          "when": { "mode": "b" } } ])",
            "void main() { out_color = vec4(LIGHT) * texelFetch(color, ivec2(gl_FragCoord.xy), 0).a; }\n");
        write_text(effects_.path() / "choose/extra.frag",
                   std::string(kShaderHead) + "void main() { out_extra = 1.0; }\n");
    }
    static std::string look(const std::string& mode) {
        return look_of(R"({ "effect": "choose", "params": { "mode": ")" + mode + "\" } }");
    }
    Error error(const std::string& mode, const PipelineOptions& options) {
        Bench bench(effects_, look(mode), options);
        try {
            bench.run(plain());
        } catch (const Error& thrown) {
            return thrown;
        }
        return {ErrorKind::interrupted, "no error"};
    }
};

TEST_F(Conditional, RunsThePassesWhoseConditionsHold) {
    expect_everywhere(Bench(effects_, look("a")).color(plain()), {1, 1, 1});
    expect_everywhere(Bench(effects_, look("b")).color(plain()), {2, 2, 2});
}

TEST_F(Conditional, NamesStepAndOutputWhenNoPassWritesIt) {
    const Error thrown = error("none", {});
    EXPECT_EQ(thrown.kind(), ErrorKind::effect);
    EXPECT_STREQ(thrown.what(), "step 'choose': no pass writes the output 'color' with these parameters");
}

TEST_F(Conditional, RefusesATapThatNoPassWrites) {
    const Error thrown = error("a", {{}, {"choose.extra"}});
    EXPECT_EQ(thrown.kind(), ErrorKind::usage);
    EXPECT_STREQ(thrown.what(), "taps choose.extra: no pass writes it with these parameters");
    EXPECT_STREQ(error("b", {{}, {"choose.extra"}}).what(), "no error");
}

TEST_F(Renderer, CompilesPassesThatNothingNeedsOnlyWhereFaultsAreSought) {
    effects_.add("spare",
                 std::string(kColorOnly) + R"("textures": { "unused": { "format": "r8", "doc": "." } },
        "passes": [ { "name": "idle", "shader": "main.frag", "reads": ["color"], "writes": ["unused"], "defines": { "IDLE": 1 } },
                    { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])",
                 "#ifdef IDLE\nvoid main() { out_unused = wrong; }\n#else\n"
                 "void main() { out_color = texelFetch(color, ivec2(0), 0) * 2.0; }\n#endif\n");
    const std::string look = look_of(R"({ "effect": "spare" })");
    expect_everywhere(Bench(effects_, look).color(plain()), {0.5f, 1, 2});
    const auto fault = [&](const RendererOptions& drawing) -> std::string {
        try {
            Bench(effects_, look, {}, gpu::test_backend(), drawing).run(plain());
        } catch (const Error& error) {
            return error.what();
        }
        return "none";
    };
    const std::string kept = fault({.keeps_steps = true});
    EXPECT_NE(kept.find("[pass idle, llvmpipe"), std::string::npos) << kept;
    const std::string checked = fault({.guards_loops = true});
    EXPECT_NE(checked.find("[pass idle, llvmpipe"), std::string::npos) << checked;
}

TEST_F(Renderer, NamesTheFileTheLineAndThePassOfAFaultyShader) {
    effects_.add("wrong", std::string(kColorOnly) + kOnePass,
                 "void main() {\n    out_color = texelFetch(colour, ivec2(0), 0);\n}\n");
    Bench bench(effects_, look_of(R"({ "effect": "wrong" })"));
    try {
        bench.run(plain());
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::effect);
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with((effects_.path() / "wrong/main.frag").string() + ":4:")) << message;
        EXPECT_NE(message.find("colour"), std::string::npos) << message;
        EXPECT_NE(message.find("[pass main, llvmpipe"), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace aftershade::test
