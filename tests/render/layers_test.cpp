// Effects that look behind the picture: "layer" of an input.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "framework/image/role.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

constexpr const char* kReveal = R"(
    "inputs": { "color": { "role": "color" }, "behind": { "role": "color", "optional": true, "layer": 1 },
                "behind_depth": { "role": "depth", "optional": true, "layer": 1 } },
    "outputs": { "color": { "role": "color" } },
    "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "behind", "behind_depth"],
                  "writes": ["color"] } ])";
/// What lies behind, and its depth in alpha; where nothing does, the picture.
constexpr const char* kRevealShader = R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_color = texelFetch(color, p, 0);
#ifdef HAS_BEHIND
    vec4 hidden = texelFetch(behind, p, 0);
    if (hidden.a > 0.0) out_color = vec4(hidden.rgb, texelFetch(behind_depth, p, 0).r);
#endif
})";

class PipelineLayers : public testing::Test {
protected:
    PipelineLayers() {
        effects_.add("reveal", kReveal, kRevealShader);
        effects_.add_color("double", "source * 2.0");
    }
    static Capture plain() {
        return make_capture({.width = 5, .height = 4, .background = {0.25f, 0.5f, 0.75f}});
    }
    /// A wall at 9 m behind the left two columns.
    static Capture layered() {
        Capture capture = plain();
        Image color(5, 4, 4), depth(5, 4, 1);
        std::ranges::fill(depth.floats(), std::numeric_limits<float>::infinity());
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 2; ++x) {
                for (int c = 0; c < 4; ++c) color.at(x, y, c) = c == 3 ? 1 : 0.125f;
                depth.at(x, y, 0) = 9;
            }
        capture.images[RoleId::of_layer(1, "color")] = std::move(color);
        capture.images[RoleId::of_layer(1, "depth")] = std::move(depth);
        return capture;
    }
    Image shown(const std::string& steps, const Capture& capture) {
        return Bench(effects_, look_of(steps)).color(capture);
    }
    EffectFolder effects_;
};

TEST_F(PipelineLayers, GoToTheEffectThatDeclaresThem) {
    const Image image = shown(R"({ "effect": "reveal" })", layered());
    EXPECT_EQ(image.at(0, 3, 0), 0.125f);
    EXPECT_EQ(image.at(1, 0, 3), 9);
    EXPECT_EQ(image.at(2, 0, 0), 0.25f);
}

TEST_F(PipelineLayers, AreAbsentWhereTheCaptureHasNone) {
    const Image image = shown(R"({ "effect": "reveal" })", plain());
    EXPECT_EQ(image.at(0, 3, 0), 0.25f);
    EXPECT_EQ(image.at(0, 3, 2), 0.75f);
}

TEST_F(PipelineLayers, BuildAnotherGraphWhereAFrameHasThemAndTheNextHasNot) {
    Bench bench(effects_, look_of(R"({ "effect": "reveal" })"));
    Capture first = layered(), then = plain();
    first.header.frame = 1;
    then.header.frame = 9;
    EXPECT_EQ(bench.run(first).images.at("color").at(0, 0, 0), 0.125f);
    EXPECT_EQ(bench.run(then).images.at("color").at(0, 0, 0), 0.25f);
    EXPECT_EQ(bench.renderer().graphs_built(), 2);
}

TEST_F(PipelineLayers, AreTheCapturesWhateverEarlierStepsMake) {
    const Image image = shown(R"({ "effect": "double" }, { "effect": "reveal" })", layered());
    EXPECT_EQ(image.at(0, 0, 0), 0.125f);
    EXPECT_EQ(image.at(4, 0, 0), 0.5f);  // of the step before
}

TEST_F(PipelineLayers, GiveWayToWhatALookWires) {
    const Image image = shown(
        R"({ "effect": "double" }, { "effect": "reveal", "in": { "behind": "double.color" } })", layered());
    EXPECT_EQ(image.at(0, 0, 0), 0.5f);
}

TEST_F(PipelineLayers, DoNotStandForThePictureThatAMixLetsThrough) {
    const Image image = shown(R"({ "effect": "reveal", "mix": 0.5 })", layered());
    EXPECT_EQ(image.at(0, 0, 0), (0.125f + 0.25f) / 2);
}

TEST_F(PipelineLayers, AreAskedOfTheCapture) {
    const Bound bound(effects_, look_of(R"({ "effect": "reveal" })"));
    EXPECT_EQ(bound.pipeline().capture_roles(),
              (std::vector<RoleId>{"color", RoleId::of_layer(1, "color"), RoleId::of_layer(1, "depth")}));
}

TEST_F(PipelineLayers, MayBeAbsentSoTheirInputsAreOptional) {
    for (const auto& [input, fault] :
         {std::pair<const char*, const char*>{R"({ "role": "color", "layer": 1 })", "must be 'optional'"},
          {R"({ "role": "color", "optional": true, "layer": 1, "frame": 1 })", "not both"},
          {R"({ "role": "color", "optional": true, "layer": 1, "history": true })", "not both"},
          {R"({ "role": "color", "optional": true, "layer": 9 })", "0 to 7"}}) {
        effects_.add("wrong",
                     R"("inputs": { "color": )" + std::string(input) +
                         R"( }, "outputs": { "color": { "role": "color" } },
                     "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ])",
                     "void main() { out_color = vec4(0.0); }\n");
        const Bound bound(effects_, look_of(R"({ "effect": "wrong" })"));
        EXPECT_NE(bound.faults().find(fault), std::string::npos) << input << "\n" << bound.faults();
    }
}

}  // namespace
}  // namespace aftershade::test
