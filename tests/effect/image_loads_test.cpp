// Fetches of single texels become loads from images, and nothing else does.
#include <chrono>

#include <gtest/gtest.h>

#include "framework/effect/image_loads.h"
#include "tests/effect/assembly.h"

namespace aftershade {
namespace {

using gpu::TextureFormat;
using test::Lines;
using test::lines_of_text;

/// Two samplers as the host declares them, then the author's lines.
struct Rewritten {
    explicit Rewritten(const std::string& author, int first_unit = 0, int units = 32) {
        source.text =
            "#version 450 core\n"
            "layout(binding = 0) uniform sampler2D light;\n"
            "layout(binding = 1) uniform usampler2DArray ids;\n" +
            author;
        source.lines.resize(lines_of_text(source.text).size(), {"a.frag", 1});
        const std::size_t lines = source.lines.size();
        loads = load_as_images(source, {{0, TextureFormat::rgba16f}, {1, TextureFormat::r32ui}}, first_unit,
                               units);
        EXPECT_EQ(lines_of_text(source.text).size(), lines);
    }
    Lines author() const {
        Lines lines = lines_of_text(source.text);
        return {lines.begin() + 3, lines.end()};
    }

    ShaderSource source;
    std::vector<ImageLoad> loads;
};

TEST(ImageLoads, TakeThePlaceOfFetchesAtLevelZero) {
    const Rewritten shader(
        "void main() {\n"
        "    out_a = texelFetch(light, ivec2(texelFetch(ids, ivec3(p, 2), 0).r,\n"
        "                                    1), 0);\n"
        "}\n",
        3);
    EXPECT_EQ(
        lines_of_text(shader.source.text),
        (Lines{
            "#version 450 core",
            "layout(binding = 0) uniform sampler2D light; layout(binding = 3, rgba16f) restrict readonly "
            "uniform image2D aftershade_image_3;",
            "layout(binding = 1) uniform usampler2DArray ids; layout(binding = 4, r32ui) restrict readonly "
            "uniform uimage2DArray aftershade_image_4;",
            "void main() {",
            "    out_a = imageLoad(aftershade_image_3, ivec2(imageLoad(aftershade_image_4, ivec3(p, 2) ).r,",
            "                                    1) );", "}"}));
    ASSERT_EQ(shader.loads.size(), 2U);
    EXPECT_EQ(shader.loads[1].sampler, 1);
    EXPECT_EQ(shader.loads[1].unit, 4);
}

TEST(ImageLoads, LeaveEveryOtherUseToTheSampler) {
    const Rewritten shader(
        "vec4 f(vec2 at) {\n"
        "    return texture(light, at) + texelFetch(light, ivec2(at), 1) + texelFetch(light, ivec2(at), 0);\n"
        "}\n"
        "// texelFetch(ids, p, 0)\n");
    EXPECT_EQ(
        shader.author(),
        (Lines{
            "vec4 f(vec2 at) {",
            "    return texture(light, at) + texelFetch(light, ivec2(at), 1) + imageLoad(aftershade_image_0, "
            "ivec2(at) );",
            "}", "// texelFetch(ids, p, 0)"}));
    EXPECT_EQ(shader.loads.size(), 1U);
    const std::string filtered = "vec4 f(vec2 at) { return texture(light, at); }\n";
    EXPECT_EQ(Rewritten(filtered).author(), lines_of_text(filtered));
}

TEST(ImageLoads, GoThroughTheFunctionsThatGetASampler) {
    const Rewritten shader(
        "vec4 at(sampler2D image, ivec2 p);\n"
        "vec4 at(sampler2D image, ivec2 p) { return texelFetch(image, min(p, textureSize(image, 0) - 1), 0); "
        "}\n"
        "vec4 both(sampler2D a, sampler2D b) { return at(a, ivec2(0)) + at(b, ivec2(1)); }\n"
        "#ifdef HAS_FRONT\n"
        "vec4 front() { return both(front, light); }\n"
        "#endif\n"
        "void main() { out_a = both(light, light); }\n");
    const std::string image = "restrict readonly image2D ";
    EXPECT_EQ(
        shader.author(),
        (Lines{"vec4 at(" + image + "image, ivec2 p);",
               "vec4 at(" + image +
                   "image, ivec2 p) { return imageLoad(image, min(p, imageSize(image ) - 1) ); }",
               "vec4 both(" + image + "a, " + image + "b) { return at(a, ivec2(0)) + at(b, ivec2(1)); }",
               "#ifdef HAS_FRONT", "vec4 front() { return both(front, aftershade_image_0); }", "#endif",
               "void main() { out_a = both(aftershade_image_0, aftershade_image_0); }"}));
}

TEST(ImageLoads, StopWhereAFunctionOrACallerNeedsASampler) {
    const std::string fetches = "vec4 at(sampler2D image, ivec2 p) { return texelFetch(image, p, 0); }\n";
    for (const std::string other :
         {"vec4 soft(sampler2D image, vec2 p) { return texture(image, p); }\nvoid main() { out_a = at(light, "
          "p) + soft(light, p); }\n",
          "vec4 soft(sampler2D image, vec2 p) { return texture(image, p) + at(image, ivec2(p)); }\nvoid "
          "main() { soft(light, p); }\n",
          "#define LIGHT (light)\nvoid main() { out_a = at(LIGHT, p); }\n",
          "#define AT(image, p) at(image, p)\nvoid main() { out_a = AT(light, p); }\n",
          "#define AT(image, p) at(image.x, p)\nvoid main() { out_a = AT(light, p); }\n",
          "uniform sampler2D own;\nvoid main() { out_a = at(light, p) + at(own, p); }\n"})
        EXPECT_EQ(Rewritten(fetches + other).author(), lines_of_text(fetches + other)) << other;
}

TEST(ImageLoads, FollowTheMacroThatNamesASampler) {
    const Rewritten shader(
        "#define FROM light\n"
        "#define HERE texelFetch(FROM, p, 0)\n"
        "void main() { out_a = HERE + texelFetch(FROM, p + 1, 0); }\n");
    EXPECT_EQ(shader.author(), (Lines{"#define FROM aftershade_image_0", "#define HERE imageLoad(FROM, p )",
                                      "void main() { out_a = HERE + imageLoad(FROM, p + 1 ); }"}));
    const std::string other =
        "#define FROM light\nvoid main() { out_a = texelFetch(FROM, p, 0) + texture(FROM, at); }\n";
    EXPECT_EQ(Rewritten(other).author(), lines_of_text(other));
}

/// As the defines of a manifest's pass do.
TEST(ImageLoads, FollowAMacroThatStandsBeforeItsSampler) {
    ShaderSource source{
        "#define FROM light\n"
        "layout(binding = 2) uniform sampler2D light;\n"
        "vec4 at(sampler2D image) { return texelFetch(image, p, 0); }\n"
        "void main() { out_a = at(FROM) + texelFetch(FROM, p, 0); }\n",
        {4, {"a.frag", 1}}};
    EXPECT_EQ(load_as_images(source, {{2, TextureFormat::r32f}}, 0, 8).size(), 1U);
    EXPECT_EQ(lines_of_text(source.text),
              (Lines{"#define FROM aftershade_image_0",
                     "layout(binding = 2) uniform sampler2D light; layout(binding = 0, r32f) restrict "
                     "readonly uniform "
                     "image2D aftershade_image_0;",
                     "vec4 at(restrict readonly image2D image) { return imageLoad(image, p ); }",
                     "void main() { out_a = at(FROM) + imageLoad(FROM, p ); }"}));
}

TEST(ImageLoads, AreNotMadeOfNamesThatMeanSomethingElse) {
    for (const std::string text :
         {"vec4 f(sampler2D light) { return texelFetch(light, p, 0); }\nvoid main() { f(other.light); }\n",
          "#define light ids\nvoid main() { out_a = texelFetch(light, p, 0); }\n",
          "#define F(light) texelFetch(light, p, 0)\nvoid main() { out_a = F(ids); }\n"})
        EXPECT_EQ(Rewritten(text).author(), lines_of_text(text)) << text;
    // Members and variables of that name are no uses of the sampler.
    const Rewritten shader(
        "struct Tap { vec4 light; };\n"
        "float amount(vec4 light) { return light.r; }\n"
        "vec4 at(sampler2D image) { return texelFetch(image, p, 0); }\n"
        "void main() { Tap tap; out_a = tap.light + amount(at(light)); }\n");
    EXPECT_EQ(shader.author().back(),
              "void main() { Tap tap; out_a = tap.light + amount(at(aftershade_image_0)); }");
}

TEST(ImageLoads, TakeThoseWithMostFetchesWhereUnitsAreFew) {
    const std::string text =
        "void main() {\n"
        "    out_a = texelFetch(light, p, 0);\n"
        "    out_b = texelFetch(ids, q, 0) + texelFetch(ids, q, 0);\n"
        "}\n";
    const Rewritten one(text, 7, 8);
    ASSERT_EQ(one.loads.size(), 1U);
    EXPECT_EQ(one.loads[0].sampler, 1);
    EXPECT_EQ(one.loads[0].unit, 7);
    EXPECT_EQ(Rewritten(text, 8, 8).loads.size(), 0U);
}

/// Each within a second on a slow machine: a stranger's shader of the largest size.
TEST(ImageLoads, TakeNoLongForAStrangersShader) {
    const auto repeated = [](const std::string& text) {
        std::string all;
        while (all.size() + text.size() < kMaxShaderBytes / 2) all += text;
        return all;
    };
    const std::string f = "vec4 f(sampler2D a) { return texelFetch(a, p, 0); }\n";
    std::string chain = "vec4 f0(sampler2D a) { return texelFetch(a, p, 0); }\n";
    for (int i = 1; chain.size() < kMaxShaderBytes / 2; ++i)
        chain +=
            "vec4 f" + std::to_string(i) + "(sampler2D a) { return f" + std::to_string(i - 1) + "(a); }\n";
    for (const std::string& text :
         {f + "void main() { " + repeated("f("), f + "void main() { " + repeated("texelFetch(light, "),
          repeated(f) + repeated("f(light)"), f + "void main() { f(" + repeated("light,"), chain,
          repeated("#define F light\n"), repeated("(")}) {
        const auto begin = std::chrono::steady_clock::now();
        const Rewritten shader(text);
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5)) << text.substr(0, 100);
    }
}

}  // namespace
}  // namespace aftershade
