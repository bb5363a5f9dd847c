// "in": what a look may wire to an input: roles of the capture, and outputs and textures of earlier steps.
#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

TEST(StepOrder, WarnsOfALensAfterAShutter) {
    const EffectFolder none;
    const auto faults = [&](const std::string& steps) { return Bound(none, look_of(steps)).faults(); };
    EXPECT_EQ(
        faults(R"({"effect": "motion_blur"}, {"effect": "bloom"}, {"effect": "dof"})"),
        "look:1:79: warning: step 'dof' comes after 'motion_blur', but effects of the lens belong before "
        "those of the shutter: move it before 'motion_blur'\n");
    EXPECT_EQ(faults(R"({"effect": "dof"}, {"effect": "motion_blur"})"), "");
    EXPECT_EQ(faults(R"({"effect": "motion_blur", "enabled": false}, {"effect": "dof"})"), "");
    EXPECT_EQ(faults(R"({"effect": "motion_blur"}, {"effect": "dof", "in": {"color": "capture.color"}})"),
              "");
}

TEST(StepRoles, ComeWithTheColorThatHasTheirLight) {
    const EffectFolder none;
    const auto step_of = [&](const std::string& steps) {
        return Bound(none, look_of(steps)).pipeline().steps.back().inputs.at("foreground").step;
    };
    EXPECT_EQ(step_of(R"({"effect": "dof"}, {"effect": "motion_blur"})"), 0);
    EXPECT_EQ(step_of(R"({"effect": "dof"}, {"effect": "color_grade"}, {"effect": "motion_blur"})"), -1);
    EXPECT_EQ(
        step_of(
            R"({"effect": "dof"}, {"effect": "motion_blur"}, {"name": "again", "effect": "motion_blur"})"),
        -1);
    EXPECT_EQ(step_of(R"({"effect": "dof"}, {"effect": "motion_blur", "in": {"color": "capture.color"}})"),
              -1);
    EXPECT_EQ(
        step_of(R"({"effect": "dof"}, {"name": "wide", "effect": "dof", "in": {"color": "capture.color"}},
                         {"effect": "motion_blur", "in": {"color": "dof.color"}})"),
        0);
}

/// `maker` has a texture of every kind; `show` takes any image to color, `warp` a velocity.
class Wiring : public testing::Test {
protected:
    Wiring() {
        effects_.add(
            "maker",
            R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
            "params": { "on": { "type": "bool", "default": true, "doc": "Whether." } },
            "textures": { "twice": { "format": "r32f", "doc": "Twice the red." },
                          "flow": { "format": "rg16f", "doc": "A vector." },
                          "half_size": { "format": "r32f", "scale": 0.5, "doc": "Where the texel is." },
                          "tiles": { "format": "rg32f", "tile": 4, "doc": "Where the tile is." },
                          "levels": { "format": "rgba32f", "mips": 3, "doc": "Only level 0 is written." },
                          "kept": { "format": "r32f", "history": true, "doc": "Counts frames." },
                          "sometimes": { "format": "r32f", "doc": "May have no content." },
                          "ids": { "format": "r32ui", "doc": "Whole numbers." },
                          "signed_ids": { "format": "r32i", "doc": "Whole numbers." },
                          "stack": { "format": "r32f", "layers": 2, "clear": 0, "doc": "Two layers." } },
            "passes": [
              { "name": "full", "shader": "full.frag", "reads": ["color", "kept.prev"],
                "writes": ["twice", "flow", "ids", "signed_ids", "kept"] },
              { "name": "smaller", "shader": "smaller.frag", "writes": ["half_size"] },
              { "name": "tile", "shader": "tile.frag", "writes": ["tiles"] },
              { "name": "level", "shader": "level.frag", "writes": ["levels"] },
              { "name": "stack", "kind": "clear", "writes": [{ "stack": { "layer": 1 } }], "value": 1 },
              { "name": "maybe", "shader": "maybe.frag", "writes": ["sometimes"], "when": { "on": true } },
              { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])",
            "void main() { out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0); }\n");
        shader("full",
               "out_twice = 2.0 * texelFetch(color, ivec2(gl_FragCoord.xy), 0).r;\n"
               "out_flow = gl_FragCoord.xy; out_ids = 7u; out_signed_ids = -7;\n"
               "out_kept = texelFetch(kept_prev, ivec2(0), 0).r + 1.0;");
        shader("smaller", "out_half_size = gl_FragCoord.x + 100.0 * gl_FragCoord.y;");
        shader("tile", "out_tiles = gl_FragCoord.xy;");
        shader("level", "out_levels = vec4(gl_FragCoord.xy, 3.0, 4.0);");
        shader("maybe", "out_sometimes = 1.0;");
        const std::string out = R"("outputs": { "color": { "role": "color" } },)";
        effects_.add(
            "show",
            R"("inputs": { "image": { "role": "aov:image", "optional": true },
                                    "color": { "role": "color" } },)" +
                out + R"("passes": [ { "name": "main", "shader": "main.frag",
                                   "reads": ["image", "color"], "writes": ["color"] } ])",
            "void main() {\n#ifdef HAS_IMAGE\n"
            "    ivec2 p = ivec2(gl_FragCoord.xy), size = ivec2(image_size.xy);\n"
            "    out_color = all(lessThan(p, size)) ? texelFetch(image, p, 0) : vec4(image_size.xy, 0, 9);\n"
            "#else\n    out_color = -texelFetch(color, ivec2(gl_FragCoord.xy), 0);\n#endif\n}\n");
        effects_.add(
            "warp",
            R"("inputs": { "velocity": { "role": "velocity" },
                                            "object_id": { "role": "object_id" } },)" +
                out + R"("passes": [ { "name": "main", "shader": "main.frag",
                                   "reads": ["velocity", "object_id"], "writes": ["color"] } ])",
            "void main() { ivec2 p = ivec2(gl_FragCoord.xy);\n"
            "out_color = vec4(texelFetch(velocity, p, 0).xy, texelFetch(object_id, p, 0).r, 1); }\n");
    }

    void shader(const std::string& name, const std::string& body) {
        write_text(effects_.path() / "maker" / (name + ".frag"),
                   std::string(kShaderHead) + "void main() {\n" + body + "\n}\n");
    }

    static Capture capture() {
        return make_capture({.width = 10, .height = 6, .background = {0.25f, 0.5f, 0.75f}});
    }

    /// What `effect`, wired so, makes after `maker`.
    Image made(const std::string& effect, const std::string& in) {
        return Bench(effects_, look_of(R"({ "effect": "maker" }, { "effect": ")" + effect + R"(", "in": { )" +
                                       in + " } }"))
            .color(capture());
    }
    std::string faults(const std::string& effect, const std::string& in) {
        return Bound(effects_, look_of(R"({ "effect": "maker" }, { "effect": ")" + effect + R"(", "in": { )" +
                                       in + " } }"))
            .faults();
    }

    EffectFolder effects_;
};

TEST_F(Wiring, GivesAnEarlierStepsTextureToAnInputAsItIs) {
    const Image image = made("show", R"("image": "maker.twice")");
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 10; ++x) {
            EXPECT_EQ(image.at(x, y, 0), 0.5f);
            EXPECT_EQ(image.at(x, y, 1), 0.0f);  // GL's rule for channels that a texture has not
        }
}

TEST_F(Wiring, LeavesATextureInItsOwnSize) {
    const Image image = made("show", R"("image": "maker.half_size")");
    EXPECT_EQ(image.at(4, 2, 0), 4.5f + 100 * 2.5f);
    EXPECT_EQ(image.at(9, 5, 0), 5.0f);  // image_size
    EXPECT_EQ(image.at(9, 5, 1), 3.0f);
}

TEST_F(Wiring, TakesLevelZeroOfATextureWhoseOtherLevelsNobodyWrites) {
    const Image image = made("show", R"("image": "maker.levels")");
    EXPECT_EQ(image.at(7, 3, 0), 7.5f);
    EXPECT_EQ(image.at(7, 3, 3), 4.0f);
}

TEST_F(Wiring, TakesATextureWithHistoryAsThisFrameLeftIt) {
    Bench bench(effects_, look_of(R"({ "effect": "maker" },
                                     { "effect": "show", "in": { "image": "maker.kept" } })"));
    for (const int frame : {1, 2, 3}) {
        Capture now = capture();
        now.header.frame = frame;
        EXPECT_EQ(bench.color(now).at(3, 3, 0), float(frame));
    }
}

TEST_F(Wiring, GivesAnyRoleOfFloatsToAnInputThatTakesAnyImage) {
    Capture now = capture();
    now.images.at("velocity_next").at(2, 1, 1) = -4;
    Bench bench(effects_, look_of(R"({ "effect": "show", "in": { "image": "capture.velocity_next" } })"));
    EXPECT_EQ(bench.color(now).at(2, 1, 1), -4.0f);
    EXPECT_EQ(made("show", R"("image": "maker.color")").at(2, 2, 2), 0.75f);
}

TEST_F(Wiring, LeavesAnInputThatTakesAnyImageOutUnlessTheLookWiresIt) {
    EXPECT_EQ(made("show", "").at(2, 2, 2), -0.75f);
}

TEST_F(Wiring, GivesATextureLikeTheRoleToAnInputOfARole) {
    const Image image = made("warp", R"("velocity": "maker.flow", "object_id": "maker.ids")");
    EXPECT_EQ(image.at(7, 3, 0), 7.5f);
    EXPECT_EQ(image.at(7, 3, 1), 3.5f);
    EXPECT_EQ(image.at(7, 3, 2), 7.0f);
}

TEST_F(Wiring, SuggestsTheNameAndListsOutputsAndTexturesWhereThereIsNone) {
    EXPECT_EQ(faults("show", R"("image": "maker.twise")"),
              "look:1:91: error: maker has no output or texture 'twise'; did you mean 'twice'? (outputs: "
              "'color'; textures: 'twice', 'flow', 'half_size', 'tiles', 'levels', 'kept', 'sometimes', "
              "'ids' and 'signed_ids')\n");
}

TEST_F(Wiring, RefusesAStepThatComesLater) {
    const Bound bound(effects_, look_of(R"({ "effect": "show", "in": { "image": "maker.twice" } },
                                           { "effect": "maker" })"));
    EXPECT_EQ(
        bound.faults(),
        "look:1:68: error: no step 'maker' before 'show'; a step reads outputs of earlier steps only\n");
}

TEST_F(Wiring, SaysThatWholeNumbersAreNoFloats) {
    const std::string integers = faults("show", R"("image": "maker.ids")");
    EXPECT_NE(integers.find("error: texture 'ids' of maker ("), std::string::npos) << integers;
    EXPECT_NE(
        integers.find("is r32ui, whole numbers; input 'image' of show reads floats (the role 'aov:image'"),
        std::string::npos)
        << integers;
    const std::string role = faults("show", R"("image": "capture.object_id")");
    EXPECT_NE(role.find("any image of floats will do, but 'object_id' has whole numbers"), std::string::npos)
        << role;
    for (const char* texture : {"twice", "signed_ids"}) {
        const std::string floats = faults("warp", R"("object_id": "maker.)" + std::string(texture) + "\"");
        EXPECT_NE(floats.find("reads unsigned whole numbers (the role 'object_id'"), std::string::npos)
            << floats;
    }
}

TEST_F(Wiring, SaysWhyATextureDoesNotFitARole) {
    struct Misfit {
        const char* in;
        const char* why;
    };
    for (const Misfit& misfit :
         {Misfit{R"("velocity": "maker.tiles")", "has a texel per tile; input 'velocity' of warp takes"},
          {R"("velocity": "maker.half_size")", "has another scale; input 'velocity' of warp takes"},
          {R"("velocity": "maker.twice")", "is r32f; input 'velocity' of warp takes"},
          {R"("velocity": "maker.stack")", "has 2 layers; input 'velocity' of warp takes a texture of one"},
          {R"("velocity": "maker.color")", "takes the role 'velocity'"}}) {
        const std::string told = faults("warp", misfit.in);
        EXPECT_NE(told.find(misfit.why), std::string::npos) << misfit.in << ": " << told;
    }
}

TEST_F(Wiring, NamesTheTextureThatHasNoContentWithTheseParameters) {
    Bench bench(effects_, look_of(R"({ "effect": "maker", "params": { "on": false } },
                                     { "effect": "show", "in": { "image": "maker.sometimes" } })"));
    try {
        bench.color(capture());
        FAIL() << "read what nobody wrote";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "step 'show': its input 'image' is 'maker.sometimes', which no pass "
                     "writes with these parameters");
    }
}

TEST_F(Wiring, GivesTheCapturesOwnImageToAnInputThatIsFromTheCapture) {
    const std::string out = R"("outputs": { "color": { "role": "color" } },)";
    effects_.add("darken",
                 R"("inputs": { "color": { "role": "color" } },)" + out + R"("passes": [ { "name": "main",
                    "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])",
                 "void main() { out_color = 0.5 * texelFetch(color, ivec2(gl_FragCoord.xy), 0); }\n");
    effects_.add(
        "compare",
        R"("inputs": { "color": { "role": "color" }, "own": { "role": "color", "from": "capture" } },)" +
            out + R"("passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "own"],
                              "writes": ["color"] } ])",
        "void main() { ivec2 p = ivec2(gl_FragCoord.xy);\n"
        "out_color = vec4(texelFetch(color, p, 0).r, texelFetch(own, p, 0).r, 0, 1); }\n");
    const std::string darken = R"({ "effect": "darken" }, { "effect": "compare")";
    const Image image = Bench(effects_, look_of(darken + " }")).color(capture());
    EXPECT_EQ(image.at(3, 3, 0), 0.125f);
    EXPECT_EQ(image.at(3, 3, 1), 0.25f);
    const Image wired =
        Bench(effects_, look_of(darken + R"(, "in": { "own": "darken.color" } })")).color(capture());
    EXPECT_EQ(wired.at(3, 3, 1), 0.125f);
    // What the step is mixed with is the picture before it, not the capture's.
    const Image mixed = Bench(effects_, look_of(darken + R"(, "mix": 0 })")).color(capture());
    EXPECT_EQ(mixed.at(3, 3, 1), 0.25f);
    EXPECT_EQ(mixed.at(3, 3, 2), 0.375f);
}

TEST_F(Wiring, LetsAStepThatCanDoWithoutColorFollowTheDisplay) {
    effects_.add("view", R"("inputs": { "color": { "role": "color" } },
                            "outputs": { "display": { "role": "display" } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["display"] } ])",
                 "void main() { out_display = texelFetch(color, ivec2(gl_FragCoord.xy), 0); }\n");
    effects_.add("over", R"("inputs": { "color": { "role": "color", "optional": true } },
                            "outputs": { "display": { "role": "display" } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["display"] } ])",
                 "void main() {\n#ifdef HAS_COLOR\n"
                 "    out_display = 1.0 - texelFetch(color, ivec2(gl_FragCoord.xy), 0);\n"
                 "#else\n    out_display = vec4(0);\n#endif\n}\n");
    const std::string look = look_of(R"({ "effect": "view" }, { "effect": "over" })");
    EXPECT_EQ(Bound(effects_, look).faults(), "");
    EXPECT_EQ(Bench(effects_, look).run(capture()).images.at("display").at(1, 1, 0), 0.75f);
}

}  // namespace
}  // namespace aftershade::test
