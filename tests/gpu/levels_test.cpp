// Single levels and layers: drawn to, read, cleared, stored to.
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "framework/base/error.h"
#include "framework/gpu/texture.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

using Floats = std::vector<float>;

class LevelsOn : public SoftwareTest {
protected:
    Program constant(const std::string& value) {
        return fragment("layout(location = 0) out vec4 c; void main() { c = vec4(" + value + "); }");
    }
    void draw_to(const Program& program, const Target& target, const Bindings& bindings = {}) {
        draw(context(), program, {&target, 1}, bindings);
    }
};
ON_EACH_BACKEND(LevelsOn);

TEST_P(LevelsOn, DrawsToOneLevelOfOneLayerAndLeavesTheOthers) {
    Texture array(context(), {.width = 5, .height = 4, .format = TextureFormat::r32f, .layers = 3, .mips = 3},
                  "array");
    array.clear(-1.0F);
    const Program program = fragment(
        "layout(location = 0) out vec4 c; void main() { c = vec4(gl_FragCoord.x + 100.0 * "
        "gl_FragCoord.y); }");
    draw_to(program, {&array, 1, 2});
    for (int level = 0; level < 3; ++level) {
        for (int layer = 0; layer < 3; ++layer) {
            const Floats got = array.read_floats(level, layer);
            if (level == 1 && layer == 2) {
                EXPECT_EQ(got, (Floats{50.5F, 51.5F, 150.5F, 151.5F}));
            } else {
                EXPECT_EQ(got, Floats(got.size(), -1.0F)) << level << ", " << layer;
            }
        }
    }
}

TEST_P(LevelsOn, ReadsOneLevelWhileItDrawsToTheNextOfTheSameTexture) {
    Texture pyramid(context(), {.width = 8, .height = 8, .format = TextureFormat::r32f, .mips = 4},
                    "pyramid");
    Floats level(64);
    for (std::size_t i = 0; i < level.size(); ++i) level[i] = static_cast<float>((i * 37) % 64);
    pyramid.upload(level);
    const Program largest = fragment(R"(layout(binding = 0) uniform sampler2D source;
layout(location = 0) out float c;
void main() {
    ivec2 p = 2 * ivec2(gl_FragCoord.xy);
    c = max(max(texelFetch(source, p, 0).r, texelFetch(source, p + ivec2(1, 0), 0).r),
            max(texelFetch(source, p + ivec2(0, 1), 0).r, texelFetch(source, p + ivec2(1, 1), 0).r));
    c += float(textureQueryLevels(source) - 1);  // other levels are not there
})");
    for (int to = 1; to < 4; ++to) {
        const SampledTexture textures[] = {{.texture = &pyramid, .level = to - 1}};
        draw_to(largest, {&pyramid, to, 0}, {.textures = textures});
        const std::size_t side = std::size_t{8} >> to;
        Floats expected(side * side);
        for (std::size_t y = 0; y < side; ++y) {
            for (std::size_t x = 0; x < side; ++x) {
                const auto at = [&](std::size_t dx, std::size_t dy) {
                    return level[(2 * y + dy) * 2 * side + 2 * x + dx];
                };
                expected[y * side + x] = std::max({at(0, 0), at(1, 0), at(0, 1), at(1, 1)});
            }
        }
        EXPECT_EQ(pyramid.read_floats(to), expected) << to;
        level = expected;
    }
}

TEST_P(LevelsOn, SamplesTwoLevelsOfOneTextureAtOnceAndFiltersWithinOne) {
    Texture pyramid(context(), {.width = 4, .height = 1, .format = TextureFormat::r32f, .mips = 3},
                    "pyramid");
    pyramid.upload(Floats{0, 8, 16, 24});
    pyramid.generate_mips();
    const Program program = fragment(R"(layout(binding = 0) uniform sampler2D fine;
layout(binding = 1) uniform sampler2D coarse;
layout(location = 0) out vec4 c;
void main() {
    c = vec4(textureLod(fine, vec2(0.25, 0.5), 0).r, textureLod(coarse, vec2(0.5), 0).r,
             textureLod(coarse, vec2(0.5), 5).r, textureSize(coarse, 0).x);
})");
    const SampledTexture textures[] = {{&pyramid, 0, Filter::linear, Wrap::clamp, 0},
                                       {&pyramid, 1, Filter::linear, Wrap::clamp, 1}};
    EXPECT_EQ(drawn(program, 1, 1, {.textures = textures}), (Floats{4, 12, 12, 2}));
}

TEST_P(LevelsOn, SamplesOneLevelOfAnArray) {
    Texture array(context(), {.width = 2, .height = 2, .format = TextureFormat::r32f, .layers = 2, .mips = 2},
                  "array");
    array.clear(0.0F);
    draw_to(constant("3.0"), {&array, 1, 0});
    draw_to(constant("5.0"), {&array, 1, 1});
    const Program program = fragment(R"(layout(binding = 0) uniform sampler2DArray image;
layout(location = 0) out vec4 c;
void main() { c = vec4(texelFetch(image, ivec3(0), 0).r, texelFetch(image, ivec3(0, 0, 1), 0).r, 0, 0); })");
    const SampledTexture textures[] = {{.texture = &array, .level = 1}};
    EXPECT_EQ(drawn(program, 1, 1, {.textures = textures}), (Floats{3, 5, 0, 0}));
}

TEST_P(LevelsOn, RefusesToReadTheLevelThatItDrawsToAndLevelsThatAreNotThere) {
    const Texture pyramid(context(), {.width = 4, .height = 4, .format = TextureFormat::r32f, .mips = 2},
                          "pyramid");
    const Program program = constant("1.0");
    const auto drawing = [&](int read, int to) {
        const SampledTexture textures[] = {{.texture = &pyramid, .level = read}};
        return error_of([&] { draw_to(program, {&pyramid, to, 0}, {.textures = textures}); });
    };
    EXPECT_EQ(drawing(1, 1), "test: texture 'pyramid' is read and drawn to by the same pass");
    EXPECT_NE(drawing(-1, 1), "");
    EXPECT_EQ(drawing(0, 1), "");
    EXPECT_EQ(drawing(2, 1), "test: texture 'pyramid' has no level 2");
    EXPECT_NE(drawing(0, 2).find("the target is level 2 of layer 0"), std::string::npos);
}

TEST_P(LevelsOn, ComparesTheSizesOfTheLevelsThatATargetNames) {
    const Texture pyramid(context(), {.width = 5, .height = 4, .format = TextureFormat::r32f, .mips = 3},
                          "pyramid");
    const Texture half = texture(2, 2, TextureFormat::r32f);
    const Program program = constant("1.0");
    const Target fits[] = {{&pyramid, 1, 0}, {.texture = &half}};
    EXPECT_EQ(error_of([&] { draw(context(), program, fits, {}); }), "");
    const Target differs[] = {{.texture = &pyramid}, {.texture = &half}};
    EXPECT_EQ(error_of([&] { draw(context(), program, differs, {}); }),
              "test: targets differ in size: 'pyramid' is 5x4, 'test' is 2x2");
}

TEST_P(LevelsOn, ClearsOneLevelOfOneLayer) {
    for (const TextureFormat format : {TextureFormat::rg32f, TextureFormat::rg32ui, TextureFormat::r32i,
                                       TextureFormat::rgba16f, TextureFormat::rg8}) {
        Texture array(context(), {.width = 4, .height = 4, .format = format, .layers = 2, .mips = 2},
                      "array");
        array.clear_to({0, 0, 0, 0});
        array.clear_to({1, 0, 1, 0}, 1, 1);
        const auto channels = static_cast<std::size_t>(channel_count(format));
        Floats one(4 * channels);
        for (std::size_t i = 0; i < one.size(); ++i) one[i] = i % channels % 2 == 0 ? 1.0F : 0.0F;
        EXPECT_EQ(array.read_floats(1, 1), one) << texture_format_name(format);
        EXPECT_EQ(array.read_floats(1, 0), Floats(4 * channels)) << texture_format_name(format);
        EXPECT_EQ(array.read_floats(0, 1), Floats(16 * channels)) << texture_format_name(format);
    }
}

TEST_P(LevelsOn, ClearsToAValueForEachChannelRoundedIntoIntegers) {
    Texture floats = texture(2, 1);
    floats.clear_to({0.1, -2.5, 1e30, std::numeric_limits<double>::infinity()});
    const float inf = std::numeric_limits<float>::infinity();
    EXPECT_EQ(floats.read_floats(), (Floats{0.1F, -2.5F, 1e30F, inf, 0.1F, -2.5F, 1e30F, inf}));
    Texture ids = texture(1, 1, TextureFormat::rgba32ui);
    ids.clear_to({4294967295.0, -3, 2.6, 1e20});
    EXPECT_EQ(ids.read_uints(), (std::vector<std::uint32_t>{0xFFFFFFFFU, 0U, 3U, 0xFFFFFFFFU}));
    Texture number = texture(1, 1, TextureFormat::r32i);
    number.clear_to({-2147483648.0, 0, 0, 0});
    EXPECT_EQ(number.read_uints(), (std::vector<std::uint32_t>{0x80000000U}));
}

/// Arrays are cleared in memory, textures of one layer by a draw where that is faster.
TEST_P(LevelsOn, ClearsATextureToTheBitsThatItClearsAnArrayTo) {
    const double inf = std::numeric_limits<double>::infinity();
    const std::vector<std::array<double, 4>> colours = {
        {0, 0, 0, 0},          {1, 0.5, 0.25, 1},         {0.1, 0.7, 1.0 / 3, 254.5 / 255},
        {-1, 2, 65504, 65519}, {1e-8, -6e-8, 1e-40, 1e9}, {inf, -inf, std::nan(""), -0.0}};
    for (const std::string_view name : texture_format_names()) {
        const TextureFormat format = *parse_texture_format(name);
        Texture array(context(), {.width = 70, .height = 65, .format = format, .layers = 2}, "array");
        Texture single(context(), {.width = 70, .height = 65, .format = format}, "single");
        for (const auto& colour : colours) {
            array.clear_to(colour);
            single.clear_to(colour);
            const Floats a = array.read_floats(0, 1), b = single.read_floats();
            EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0)
                << name << ": " << a[0] << ", " << b[0];
        }
    }
}

TEST_P(LevelsOn, ClearsBetweenTheDrawsAroundIt) {
    Texture target(context(), {.width = 70, .height = 65, .format = TextureFormat::r32f}, "target");
    draw_to(constant("7.0"), {&target, 0, 0});
    target.clear(2.0F);
    Texture copied(context(), {.width = 70, .height = 65, .format = TextureFormat::r32f}, "copied");
    copied.clear(5.0F);
    copy(context(), target, copied);
    target.clear(3.0F);
    EXPECT_EQ(copied.read_floats(), Floats(70 * 65, 2.0F));
    EXPECT_EQ(target.read_floats(), Floats(70 * 65, 3.0F));
}

TEST_P(LevelsOn, ClearsOneLevelThatWasDrawnToAndReadBefore) {
    Texture pyramid(context(), {.width = 4, .height = 4, .format = TextureFormat::r32f, .mips = 2},
                    "pyramid");
    pyramid.clear(0.0F);
    draw_to(constant("7.0"), {&pyramid, 1, 0});
    EXPECT_EQ(pyramid.read_floats(1), Floats(4, 7.0F));
    pyramid.clear_to({9, 0, 0, 0}, 1, 0);
    EXPECT_EQ(pyramid.read_floats(1), Floats(4, 9.0F));
    EXPECT_EQ(pyramid.read_floats(0), Floats(16, 0.0F));
}

TEST_P(LevelsOn, TakesTheLeastAndTheLargestByImageAtomicsAtALevel) {
    Texture least(context(), {.width = 4, .height = 4, .format = TextureFormat::r32ui, .mips = 2}, "least");
    Texture largest(context(), {.width = 4, .height = 4, .format = TextureFormat::r32i, .mips = 2},
                    "largest");
    least.clear_to({1000, 0, 0, 0});
    largest.clear(-1000.0F);
    const Program program = Program::compute(context(), R"(#version 450 core
layout(local_size_x = 8, local_size_y = 8) in;
layout(r32ui, binding = 0) uniform uimage2D least;
layout(r32i, binding = 1) uniform iimage2D largest;
void main() {
    uvec2 p = gl_GlobalInvocationID.xy;
    int value = int((p.x * 7u + p.y * 13u) % 61u) - 30;
    imageAtomicMin(least, ivec2(p / 8u), uint(value + 30));
    imageAtomicMax(largest, ivec2(p / 8u), value);
}
)",
                                             "extremes");
    const ImageBinding images[] = {{.texture = &least, .binding = 0, .level = 1},
                                   {.texture = &largest, .binding = 1, .level = 1}};
    dispatch(context(), program, 2, 2, 1, {.images = images});
    std::vector<std::uint32_t> expected_least(4, 1000U);
    Floats expected_largest(4, -1000.0F);
    for (unsigned y = 0; y < 16; ++y) {
        for (unsigned x = 0; x < 16; ++x) {
            const std::uint32_t value = (x * 7 + y * 13) % 61;
            const std::size_t tile = y / 8 * 2 + x / 8;
            expected_least[tile] = std::min(expected_least[tile], value);
            expected_largest[tile] = std::max(expected_largest[tile], static_cast<float>(value) - 30.0F);
        }
    }
    EXPECT_EQ(least.read_uints(1), expected_least);
    EXPECT_EQ(largest.read_floats(1), expected_largest);
    EXPECT_EQ(least.read_uints(0), std::vector<std::uint32_t>(16, 1000U));
}

}  // namespace
}  // namespace aftershade::gpu
