// Draws as compute shaders: the same bits as fragments give, by generated effects.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "framework/document/glsl_text.h"
#include "tests/backends.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

using gpu::Backend;

constexpr std::array<std::string_view, 13> kFormats = {"r8",      "rg8",      "rgba8", "r16f",    "rg16f",
                                                       "rgba16f", "r32f",     "rg32f", "rgba32f", "r32ui",
                                                       "rg32ui",  "rgba32ui", "r32i"};
constexpr std::array<std::pair<int, int>, 5> kSizes = {{{1, 1}, {17, 3}, {64, 36}, {33, 20}, {5, 70}}};

/// Choices of variant `index`, all different from call to call.
class Choices {
public:
    explicit Choices(int index) : state_(std::uint32_t(index) * 2654435761u + 12345u) {}
    std::size_t of(std::size_t count) {
        state_ = state_ * 1664525u + 1013904223u;
        return (state_ >> 16) % count;
    }

private:
    std::uint32_t state_;
};

std::string cast_of(std::string_view format, const std::string& vec4) {
    const bool is_integer = format.ends_with("i");
    const std::string_view digits = format.substr(format.find_first_of("0123456789"));
    const std::size_t channels = format.starts_with("rgba") ? 4 : format.starts_with("rg") ? 2 : 1;
    const std::string prefix = digits.ends_with("ui") ? "u" : is_integer ? "i" : "";
    const std::string swizzle = channels == 4 ? "" : channels == 2 ? ".rg" : ".r";
    const std::string type = channels == 1 ? (prefix == "u"   ? "uint"
                                              : prefix == "i" ? "int"
                                                              : "float")
                                           : prefix + "vec" + std::to_string(channels);
    // Floats that are out of an integer's range are undefined there.
    const std::string value = is_integer ? "clamp(" + vec4 + ", 0.0, 1e6)" : vec4;
    return type + "((" + value + ")" + swizzle + ")";
}

struct Variant {
    std::string manifest;
    std::string shader;
    int width = 0;
    int height = 0;
};

/// Two textures of any formats, written at once with values beyond their ranges, then drawn over in parts: on
/// a level, over tiles, with discard and return; and read with offsets, filters and from the frame before.
Variant variant_of(int index) {
    constexpr std::array<const char*, 6> kValues = {
        "read_at(ivec2(1, 0)) * 3.7 - 0.9",
        "vec4(gl_FragCoord.xy * 1234.5, 1.0 / (0.1 + read_at(ivec2(-1, 2)).r), 1e30)",
        "mix(read_at(ivec2(0)), textureLod(color, gl_FragCoord.xy * color_size.zw + 0.013, 0.0), 0.37)",
        "SAMPLE(color, gl_FragCoord.yx * color_size.zw) * 0.501960784",
        "vec4(sin(gl_FragCoord.x), exp(read_at(ivec2(2)).g), pow(gl_FragCoord.y, 0.37), gl_FragCoord.w)",
        "vec4(gl_FragCoord.z, sqrt(gl_FragCoord.x / 3.0), log(gl_FragCoord.y), read_at(ivec2(-3, 0)).a)"};
    constexpr std::array<const char*, 4> kLeaving = {
        "if (hash(p) % 3u == 0u) discard;", "if (p.x % 3 == 0) { return; }",
        "if (p.y % 2 == 1) discard; else if (p.x > 9) return;", ""};
    Choices choose(index);
    const std::string_view a = kFormats[choose.of(kFormats.size())], b = kFormats[choose.of(kFormats.size())];
    Variant variant;
    std::tie(variant.width, variant.height) = kSizes[choose.of(kSizes.size())];
    const std::string filter = choose.of(2) == 0 ? "linear" : "nearest";
    const std::string over = choose.of(2) == 0 ? R"("over": "chosen",)" : "";
    const std::string side = choose.of(2) == 0 ? "16" : "5";
    const std::string level = over.empty() ? std::to_string(choose.of(2)) : "0";
    const bool has_tiles = !over.empty();
    variant.manifest = filled(
        R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
    "textures": { "a": { "format": "$a", "mips": 2, "clear": 1, "doc": "." },
                  "b": { "format": "$b", "mips": 2, "clear": 0, "doc": "." },
                  $marks
                  "kept": { "format": "rgba32f", "history": true, "doc": "." } },
    $tiles "passes": [
        $mark
        { "name": "make", "shader": "main.frag", "reads": [{ "color": "$filter" }],
          "writes": [{ "a": { "level": 0 } }, { "b": { "level": 0 } }], "defines": { "MAKE": 1, "SAMPLE": "texture" } },
        { "name": "level", "shader": "main.frag", "reads": [], "writes": [{ "a": { "level": 1 } }],
          "defines": { "LEVEL": 1 } },
        { "name": "part", "shader": "main.frag", $over "reads": [{ "color": "$filter" }],
          "writes": [{ "a": { "level": $level } }], "defines": { "PART": 1, "SAMPLE": "texture" } },
        { "name": "show", "shader": "main.frag", "reads": ["a", "b", "kept.prev"],
          "writes": ["color", "kept"], "defines": { "SHOW": 1 } } ])",
        {{"a", std::string(a)},
         {"b", std::string(b)},
         {"filter", filter},
         {"over", over},
         {"level", level},
         {"marks", has_tiles ? R"("marks": { "format": "r8", "tile": )" + side + R"(, "doc": "." },)" : ""},
         {"tiles", has_tiles ? R"("tiles": { "chosen": { "of": "marks.r", "doc": "." } },)" : ""},
         {"mark", has_tiles ? R"({ "name": "mark", "shader": "main.frag", "reads": [], "writes": ["marks"],
                                   "defines": { "MARK": 1 } },)"
                            : ""}});
    variant.shader = filled(R"(
uint hash(ivec2 p) { return (uint(p.x) * 1664525u + uint(p.y)) * 1013904223u >> 16; }
#if defined(MAKE) || defined(PART)
vec4 read_at(ivec2 offset) {
    return texelFetch(color, clamp(ivec2(gl_FragCoord.xy) + offset, ivec2(0), textureSize(color, 0) - 1), 0);
}
#endif
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#if defined(MARK)
    out_marks = hash(p) % 3u == 0u ? 0.0 : 1.0;
#elif defined(MAKE)
    out_a = $first;
    out_b = $second;
    if (p.x == 2) out_a += out_a;
#elif defined(LEVEL)
    out_a = $level_value;
#elif defined(PART)
    $leaving
    out_a = $third;
#else
    vec4 was = texelFetch(kept_prev, p, 0);
    out_kept = vec4(texelFetch(a, p, 0)) + vec4(texelFetch(b, p, 0)) + 0.5 * was;
    out_color = out_kept + vec4(texelFetch(a, p / 2, 1)) + vec4(textureLod(b, gl_FragCoord.xy * b_size.zw, 0.0));
#endif
}
)",
                            {{"first", cast_of(a, kValues[choose.of(kValues.size())])},
                             {"second", cast_of(b, kValues[choose.of(kValues.size())])},
                             {"third", cast_of(a, kValues[choose.of(kValues.size())])},
                             {"level_value", cast_of(a, "vec4(p.xyyx)")},
                             {"leaving", kLeaving[choose.of(kLeaving.size())]}});
    return variant;
}

Capture picture_of(int width, int height, int frame) {
    return make_capture({.width = width,
                         .height = height,
                         .background = {0.3f + 0.1f * float(frame), 0.5f, 2},
                         .points = {{width / 2, height / 2, 700}, {0, height - 1, 0.001f}}},
                        frame);
}

constexpr int kVariants = 40;  // of five shaders each

class DrawsAsComputeShaders : public gpu::OnEachBackend {};

TEST_P(DrawsAsComputeShaders, GiveTheBitsOfFragmentsInGeneratedEffects) {
    EffectFolder effects;
    for (int i = 0; i < kVariants; ++i) {
        const Variant variant = variant_of(i);
        effects.add("variant_" + std::to_string(i), variant.manifest, variant.shader);
    }
    for (int i = 0; i < kVariants; ++i) {
        const Variant variant = variant_of(i);
        const std::string look = look_of(R"({"effect": "variant_)" + std::to_string(i) + "\"}");
        Bench drawn(effects, look, {}, GetParam(), {.draw_with = DrawWith::fragment});
        Bench computed(effects, look, {}, GetParam(), {.draw_with = DrawWith::compute});
        for (const int frame : {1, 2}) {
            const Capture capture = picture_of(variant.width, variant.height, frame);
            const Image a = drawn.color(capture), b = computed.color(capture);
            ASSERT_EQ(std::memcmp(a.floats().data(), b.floats().data(), a.floats().size_bytes()), 0)
                << "variant " << i << ", frame " << frame << "\n"
                << variant.manifest << variant.shader;
        }
        for (const DrawnPass& draw : computed.renderer().draws())
            ASSERT_TRUE(draw.computes) << "variant " << i << ": " << draw.pass << " " << draw.why_drawn;
        for (const DrawnPass& draw : drawn.renderer().draws()) ASSERT_FALSE(draw.computes) << draw.pass;
    }
}

/// The colour of `effect` drawn both ways.
struct BothWays {
    Image drawn, computed;
    bool are_same() const {
        const auto a = drawn.floats(), b = computed.floats();
        return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
    }
};

BothWays both_ways(const EffectFolder& effects, const std::string& effect, const Capture& capture,
                   Backend backend) {
    const std::string look = look_of("{\"effect\": \"" + effect + "\"}");
    Bench drawn(effects, look, {}, backend, {.draw_with = DrawWith::fragment});
    Bench computed(effects, look, {}, backend, {.draw_with = DrawWith::compute});
    BothWays both{drawn.color(capture), computed.color(capture)};
    for (const DrawnPass& draw : computed.renderer().draws())
        EXPECT_TRUE(draw.computes) << draw.pass << " " << draw.why_drawn;
    return both;
}

TEST_P(DrawsAsComputeShaders, TreatDenormalFloatsAsFragmentsDo) {
    EffectFolder effects;
    effects.add("denormal",
                R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "passes": [{ "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] }])",
                R"(void main() {
    // 2^-133 for each column: a denormal that is a normal number again after two products.
    float value = uintBitsToFloat(uint(gl_FragCoord.x) << 16);
    out_color = vec4(value * 1e19 * 1e19, value > 0.0 ? 1.0 : 0.0, texelFetch(color, ivec2(gl_FragCoord.xy), 0).ba);
})");
    const BothWays both = both_ways(effects, "denormal", picture_of(16, 4, 1), GetParam());
    EXPECT_TRUE(both.are_same()) << both.drawn.at(9, 0, 0) << " " << both.computed.at(9, 0, 0) << ", "
                                 << both.drawn.at(9, 0, 1) << " " << both.computed.at(9, 0, 1);
}

TEST_P(DrawsAsComputeShaders, DivideTilesAsQuadsDoWhereAnEdgeGoesThroughCentres) {
    // 0.5: the edges of odd tiles lie at 2.5, 7.5, ... texels; 0.77 and 5: at 38.5.
    for (const char* const scale : {"0.5", "0.77", "0.3", "1.5"})
        for (const char* const side : {"2", "3", "5", "7"}) {
            EffectFolder effects;
            effects.add("tiled",
                        filled(R"("inputs": { "color": { "role": "color" } },
        "outputs": { "color": { "role": "color" } },
        "textures": { "marks": { "format": "r8", "tile": $side, "doc": "." },
                      "part": { "format": "r32f", "scale": $scale, "clear": 0, "doc": "." } },
        "tiles": { "chosen": { "of": "marks.r", "doc": "." } },
        "passes": [
            { "name": "mark", "shader": "main.frag", "reads": [], "writes": ["marks"], "defines": { "MARK": 1 } },
            { "name": "part", "shader": "main.frag", "over": "chosen", "reads": [], "writes": ["part"],
              "defines": { "PART": 1 } },
            { "name": "show", "shader": "main.frag", "reads": ["part", "color"], "writes": ["color"] } ])",
                               {{"side", side}, {"scale", scale}}),
                        R"(void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#if defined(MARK)
    out_marks = (p.x * 7 + p.y * 3) % 5 < 2 ? 1.0 : 0.0;
#elif defined(PART)
    out_part = 1.0;
#else
    ivec2 at = ivec2((vec2(p) + 0.5) * part_size.xy / color_size.xy);
    out_color = vec4(texelFetch(part, at, 0).r) + texelFetch(color, p, 0);
#endif
})");
            EXPECT_TRUE(both_ways(effects, "tiled", picture_of(129, 65, 1), GetParam()).are_same())
                << "scale " << scale << ", side " << side;
        }
}

TEST_P(DrawsAsComputeShaders, StoreNanInBytesAsDrawsDo) {
    for (const char* const format : {"r8", "rg8", "rgba8"}) {
        EffectFolder effects;
        effects.add("bytes",
                    filled(R"("inputs": { "color": { "role": "color" } },
        "outputs": { "color": { "role": "color" } },
        "textures": { "bytes": { "format": "$format", "doc": "." } },
        "passes": [
            { "name": "make", "shader": "main.frag", "reads": [], "writes": ["bytes"], "defines": { "MAKE": 1 } },
            { "name": "show", "shader": "main.frag", "reads": ["bytes", "color"], "writes": ["color"] } ])",
                           {{"format", format}}),
                    filled(R"(void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef MAKE
    // NaN left of column 3, then -infinity.
    out_bytes = $value;
#else
    out_color = vec4(texelFetch(bytes, p, 0)) + texelFetch(color, p, 0);
#endif
})",
                           {{"value", cast_of(format,
                                              "vec4(log(float(p.x - 3)), sqrt(float(p.y - 2)), 1.0, "
                                              "0.0 / float(p.x - 4))")}}));
        EXPECT_TRUE(both_ways(effects, "bytes", picture_of(17, 9, 1), GetParam()).are_same()) << format;
    }
}

ON_EACH_BACKEND(DrawsAsComputeShaders);

/// One pass from color to color, whose shader has `text`, and how it ran.
DrawnPass drawn(const std::string& body) {
    EffectFolder effects;
    effects.add(
        "one", R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "textures": { "levels": { "format": "rgba16f", "mips": "auto", "doc": "." } },
        "passes": [ { "name": "fill", "shader": "main.frag", "reads": ["color"], "writes": ["levels"],
                      "defines": { "FILL": 1 } },
                    { "name": "main", "shader": "main.frag", "reads": ["levels"], "writes": ["color"] } ])",
        "#ifdef FILL\nvoid main() { out_levels = texelFetch(color, ivec2(gl_FragCoord.xy), 0); }\n#else\n" +
            body + "\n#endif\n");
    Bench bench(effects, look_of(R"({"effect": "one"})"), {}, gpu::test_backend(),
                {.draw_with = DrawWith::compute});
    bench.color(picture_of(16, 8, 1));
    return bench.renderer().draws().back();
}

TEST(WhatCannotCompute, StaysADrawAndSaysWhy) {
    const std::map<std::string, std::string> bodies = {
        {"void main() { out_color = vec4(dFdx(gl_FragCoord.x)); }", "uses dFdx()"},
        {"void main() { out_color = vec4(gl_FrontFacing ? 1.0 : 0.0); }", "uses gl_FrontFacing"},
        {"void main() { out_color = texture(levels, gl_FragCoord.xy / 9.0); }",
         "chooses levels of a texture by derivatives, with texture()"},
        {"void leave() { discard; }\nvoid main() { leave(); out_color = vec4(1); }",
         "discards outside of main()"},
        {"void main() { out_color = textureLod(levels, gl_FragCoord.xy / 9.0, 1.0); }", ""}};
    for (const auto& [body, why] : bodies) {
        const DrawnPass pass = drawn(body);
        EXPECT_EQ(pass.why_drawn, why) << body;
        EXPECT_EQ(pass.computes, why.empty()) << body;
    }
}

TEST(WhatCannotCompute, IsWhatBlendsOrHasAVertexShader) {
    EffectFolder effects;
    effects.add("sum",
                R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "textures": { "sum": { "format": "rgba32f", "clear": 0, "doc": "." } },
        "passes": [ { "name": "add", "shader": "main.frag", "reads": ["color"], "writes": ["sum"], "blend": "add",
                      "defines": { "OUT": "out_sum", "IN": "color" } },
                    { "name": "points", "shader": "main.frag", "vertex": "point.vert", "reads": ["color"],
                      "instances": { "of": "points", "count": 1 }, "writes": ["sum"],
                      "defines": { "OUT": "out_sum", "IN": "color" } },
                    { "name": "main", "shader": "main.frag", "reads": ["sum"], "writes": ["color"],
                      "defines": { "OUT": "out_color", "IN": "sum" } } ])",
                "void main() { OUT = texelFetch(IN, ivec2(gl_FragCoord.xy), 0); }\n");
    write_text(effects.path() / "sum" / "point.vert",
               std::string(kShaderHead) + "void main() { gl_Position = vec4(0, 0, 0, 1); }\n");
    Bench bench(effects, look_of(R"({"effect": "sum"})"), {}, gpu::test_backend(),
                {.draw_with = DrawWith::compute});
    bench.color(picture_of(16, 8, 1));
    std::string whys;
    for (const DrawnPass& draw : bench.renderer().draws()) whys += draw.pass + ": " + draw.why_drawn + "\n";
    EXPECT_EQ(whys, "sum.add: blends\nsum.points: has a vertex shader\nsum.main: \n");
}

TEST(WhatCannotCompute, IsReportedWithTheAuthorsOwnLine) {
    EffectFolder effects;
    effects.add_color("wrong", "source * strengthh",
                      R"("strength": { "type": "float", "default": 1, "doc": "." })");
    Bench bench(effects, look_of(R"({"effect": "wrong"})"), {}, gpu::test_backend(),
                {.draw_with = DrawWith::compute});
    try {
        bench.color(picture_of(16, 8, 1));
        FAIL() << "a shader with a fault was drawn";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("main.frag:5:"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace aftershade::test
