// Shaders that reach outside what is bound. Mesa's software drivers return zero and drop the write; a driver
// with robust access may return another value of the same texture or buffer. None may touch what lies beside
// it.
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "framework/gpu/commands.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

class OutOfBoundsOn : public SoftwareTest {
protected:
    Buffer words(const std::vector<std::uint32_t>& values, const char* label) {
        Buffer buffer(context(), values.size() * sizeof(std::uint32_t), label);
        buffer.write(std::as_bytes(std::span(values)));
        return buffer;
    }

    static std::vector<std::uint32_t> read(const Buffer& buffer) {
        const std::vector<std::byte> bytes = buffer.read();
        std::vector<std::uint32_t> values(bytes.size() / sizeof(std::uint32_t));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }
};
ON_EACH_BACKEND(OutOfBoundsOn);

TEST_P(OutOfBoundsOn, TexelsAreZero) {
    Texture image = texture(2, 2, TextureFormat::r32f);
    image.upload(std::vector<float>{5, 6, 7, 8});
    const Program program = fragment(R"(layout(binding = 0) uniform sampler2D image;
layout(location = 0) out vec4 c;
void main() {
    const ivec2 places[] = ivec2[](ivec2(-1, 0), ivec2(0, 2), ivec2(1 << 24, 0), ivec2(-2147483647 - 1, 2147483647));
    const ivec2 place = places[int(gl_FragCoord.x)];
    c = vec4(texelFetch(image, place, 0).r, texelFetch(image, place & 1, 0).r, 0, 0);
})");
    const SampledTexture textures[] = {{.texture = &image}};
    const std::vector<float> got = drawn(program, 4, 1, {.textures = textures});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(got[4 * i], 0.0F) << i;
    // The shader itself has run: places within the texture give its texels.
    EXPECT_EQ(got[1], 6.0F);
}

/// The host puts one in the place of the other (framework/effect/image_loads.h).
TEST_P(OutOfBoundsOn, LoadsGiveWhatFetchesGive) {
    for (const std::string_view name : texture_format_names()) {
        const TextureFormat format = *parse_texture_format(name);
        Texture image = texture(2, 2, format);
        if (is_integer(format))
            image.upload(std::vector<std::uint32_t>(std::size_t(4 * channel_count(format)), 7));
        else image.upload(std::vector<float>(std::size_t(4 * channel_count(format)), 0.5F));
        const std::string prefix = !is_integer(format) ? "" : is_signed_integer(format) ? "i" : "u";
        std::string text = R"(layout(binding = 0) uniform $sampler2D sampled;
layout(binding = 0, $name) restrict readonly uniform $image2D image;
layout(location = 0) out vec4 c;
void main() {
    const ivec2 places[] = ivec2[](ivec2(1, 1), ivec2(-1, 0), ivec2(2, 0), ivec2(0, 1 << 20));
    const ivec2 place = places[int(gl_FragCoord.x)];
    c = gl_FragCoord.y < 1.0 ? vec4(texelFetch(sampled, place, 0)) : vec4(imageLoad(image, place));
})";
        for (std::size_t at; (at = text.find("$name")) != text.npos;) text.replace(at, 5, name);
        for (std::size_t at; (at = text.find('$')) != text.npos;) text.replace(at, 1, prefix);
        const Program program = fragment(text);
        const SampledTexture textures[] = {{.texture = &image}};
        const ImageBinding images[] = {{.texture = &image, .access = Access::read}};
        const std::vector<float> got = drawn(program, 4, 2, {.textures = textures, .images = images});
        const std::vector<float> fetched(got.begin(), got.begin() + 16), loaded(got.begin() + 16, got.end());
        EXPECT_EQ(loaded, fetched) << name;
        EXPECT_EQ(fetched[0], is_integer(format) ? 7.0F : fetched[0]) << name;
    }
}

TEST_P(OutOfBoundsOn, ImageLoadsAreZeroAndStoresAreDropped) {
    Texture image = texture(2, 2, TextureFormat::r32f);
    image.upload(std::vector<float>{5, 6, 7, 8});
    Texture beside = texture(2, 2, TextureFormat::r32f);
    beside.upload(std::vector<float>{1, 2, 3, 4});
    const Texture loaded = texture(4, 1, TextureFormat::r32f);
    const Program program = Program::compute(context(), R"(#version 450 core
layout(local_size_x = 4) in;
layout(binding = 0, r32f) uniform image2D image;
layout(binding = 1, r32f) uniform writeonly image2D loaded;
void main() {
    const ivec2 places[] = ivec2[](ivec2(-1, 0), ivec2(2, 1), ivec2(1 << 20, 0), ivec2(0, -(1 << 20)));
    const ivec2 place = places[gl_LocalInvocationIndex];
    imageStore(loaded, ivec2(gl_LocalInvocationIndex, 0), imageLoad(image, place));
    imageStore(image, place, vec4(99));
})",
                                             "outside an image");
    const ImageBinding images[] = {{.texture = &image, .binding = 0}, {.texture = &loaded, .binding = 1}};
    dispatch(context(), program, 1, 1, 1, {.images = images});
    EXPECT_EQ(loaded.read_floats(), std::vector<float>(4, 0.0F));
    EXPECT_EQ(image.read_floats(), (std::vector<float>{5, 6, 7, 8}));
    EXPECT_EQ(beside.read_floats(), (std::vector<float>{1, 2, 3, 4}));
}

TEST_P(OutOfBoundsOn, BufferReadsAreZeroOrOfTheBufferAndWritesAreDropped) {
    const Buffer before = words(std::vector<std::uint32_t>(16, 11U), "before");
    const Buffer buffer = words({5, 6, 7, 8}, "bound");
    const Buffer after = words(std::vector<std::uint32_t>(16, 22U), "after");
    const Buffer read_back = words(std::vector<std::uint32_t>(4, 77U), "read back");
    const Program program = Program::compute(context(), R"(#version 450 core
layout(local_size_x = 4) in;
layout(std430, binding = 0) buffer Bound { uint bound[]; };
layout(std430, binding = 1) buffer ReadBack { uint read_back[]; };
void main() {
    const uint places[] = uint[](4u, 1000u, 100000000u, 1073741823u);
    const uint place = places[gl_LocalInvocationIndex];
    read_back[gl_LocalInvocationIndex] = bound[place];
    bound[place] = 99u;
    atomicAdd(bound[place], 1u);
})",
                                             "outside a buffer");
    const BufferBinding storage[] = {{&buffer, 0}, {&read_back, 1}};
    dispatch(context(), program, 1, 1, 1, {.storage = storage});
    for (const std::uint32_t value : read(read_back))
        EXPECT_TRUE(value == 0U || (value >= 5U && value <= 8U)) << value;
    EXPECT_EQ(read(buffer), (std::vector<std::uint32_t>{5, 6, 7, 8}));
    EXPECT_EQ(read(before), std::vector<std::uint32_t>(16, 11U));
    EXPECT_EQ(read(after), std::vector<std::uint32_t>(16, 22U));
}

}  // namespace
}  // namespace aftershade::gpu
