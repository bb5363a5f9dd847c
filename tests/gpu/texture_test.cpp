#include "framework/gpu/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <type_traits>

#include "framework/base/error.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

static_assert(std::is_nothrow_move_constructible_v<Texture> && std::is_nothrow_move_assignable_v<Texture>);
static_assert(!std::is_copy_constructible_v<Texture> && !std::is_copy_assignable_v<Texture>);

class TextureOn : public SoftwareTest {
protected:
    Texture make(const TextureDesc& desc) { return Texture(context(), desc, "made"); }
};
ON_EACH_BACKEND(TextureOn);

std::vector<TextureFormat> all_formats() {
    std::vector<TextureFormat> formats;
    for (std::string_view name : texture_format_names()) formats.push_back(*parse_texture_format(name));
    return formats;
}

bool is_normalised(TextureFormat format) {
    return format <= TextureFormat::rgba8;
}

TEST_P(TextureOn, GivesBackTheFloatsThatWereUploadedInEveryFormat) {
    for (TextureFormat format : all_formats()) {
        Texture texture = make({.width = 5, .height = 3, .format = format});
        std::vector<float> values(15U * static_cast<unsigned>(channel_count(format)));
        // Values that every format holds exactly.
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = is_normalised(format) ? static_cast<float>(i % 256) / 255.0F : static_cast<float>(i);
        }
        texture.upload(values);
        const std::vector<float> got = texture.read_floats();
        ASSERT_EQ(got.size(), values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            // Mesa multiplies by 1/255 where the specification divides by 255: one unit in the last place.
            EXPECT_NEAR(got[i], values[i], is_normalised(format) ? 1e-7F : 0.0F)
                << texture_format_name(format);
        }
    }
}

TEST_P(TextureOn, GivesBackTheIntegersThatWereUploadedInEveryFormat) {
    for (TextureFormat format : all_formats()) {
        Texture texture = make({.width = 3, .height = 5, .format = format});
        std::vector<std::uint32_t> values(15U * static_cast<unsigned>(channel_count(format)));
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = static_cast<std::uint32_t>(is_normalised(format) ? i % 2 : i);
        }
        if (is_integer(format)) values.back() = 0xFFFFFFFFU;
        texture.upload(values);
        EXPECT_EQ(texture.read_uints(), values) << texture_format_name(format);
    }
}

TEST_P(TextureOn, ShowsEachValueThatWasReadOnce) {
    // More than a processor's cache has, and a height that bands do not divide.
    Texture texture = make({.width = 1000, .height = 331});
    std::vector<float> values(4U * 1000U * 331U);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    texture.upload(values);
    std::vector<float> got(values.size()), shown;
    int bands = 0;
    std::mutex guard;
    texture.begin_read().finish(std::span(got), [&](std::span<const float> band) {
        const std::lock_guard lock(guard);
        shown.insert(shown.end(), band.begin(), band.end());
        ++bands;
    });
    EXPECT_EQ(got, values);
    std::ranges::sort(shown);  // bands come in no order; the values rise
    EXPECT_EQ(shown, values);
    EXPECT_GT(bands, 5);
}

TEST_P(TextureOn, KeepsEveryBitOfAFloat) {
    Texture texture = make({.width = 2, .height = 2});
    const float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> values = {-1.5F, 65536.0F, 1e30F, 1e-40F, inf,  -inf,   std::nanf(""), -0.0F,
                                       0.1F,  3.25F,    -1e6F, 1.0F,   2.0F, 1e-30F, 16777217.0F,   0.0F};
    texture.upload(values);
    const std::vector<float> got = texture.read_floats();
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(std::bit_cast<std::uint32_t>(got[i]), std::bit_cast<std::uint32_t>(values[i])) << values[i];
    }
}

TEST_P(TextureOn, KeepsTheSignOfASignedInteger) {
    Texture texture = make({.width = 3, .height = 1, .format = TextureFormat::r32i});
    texture.upload(std::vector<float>{-7.0F, 2147483648.0F, 5.0F});
    EXPECT_EQ(texture.read_floats(), (std::vector<float>{-7.0F, 2147483648.0F, 5.0F}));
    EXPECT_EQ(texture.read_uints(), (std::vector<std::uint32_t>{0xFFFFFFF9U, 0x7FFFFFFFU, 5U}));
}

TEST_P(TextureOn, RoundsFloatsThatGoIntoIntegersAndKeepsThemInRange) {
    Texture texture = make({.width = 4, .height = 1, .format = TextureFormat::r32ui});
    texture.upload(std::vector<float>{2.6F, -3.0F, 1e20F, std::nanf("")});
    EXPECT_EQ(texture.read_uints(), (std::vector<std::uint32_t>{3U, 0U, 0xFFFFFFFFU, 0U}));
}

TEST_P(TextureOn, ClearsEveryLevelAndLayer) {
    Texture texture = make({.width = 4, .height = 4, .format = TextureFormat::rg16f, .layers = 3, .mips = 3});
    texture.clear(-2.5F);
    for (int level = 0; level < 3; ++level) {
        const auto count = static_cast<std::size_t>(2 * (4 >> level) * (4 >> level));
        for (int layer = 0; layer < 3; ++layer) {
            EXPECT_EQ(texture.read_floats(level, layer), std::vector<float>(count, -2.5F));
        }
    }
    Texture ids = make({.width = 2, .height = 1, .format = TextureFormat::rg32ui});
    ids.clear_to({4000000000.0, 4000000000.0, 0, 0});
    EXPECT_EQ(ids.read_uints(), std::vector<std::uint32_t>(4, 4000000000U));
}

TEST_P(TextureOn, UploadsOneLayerAndLeavesTheOthers) {
    Texture texture = make({.width = 2, .height = 1, .format = TextureFormat::r32f, .layers = 2});
    texture.clear(0.0F);
    texture.upload(std::vector<float>{1.0F, 2.0F}, 1);
    EXPECT_EQ(texture.read_floats(0, 0), (std::vector<float>{0.0F, 0.0F}));
    EXPECT_EQ(texture.read_floats(0, 1), (std::vector<float>{1.0F, 2.0F}));
}

TEST_P(TextureOn, AveragesFourTexelsIntoTheNextMipLevel) {
    Texture texture = make({.width = 4, .height = 2, .format = TextureFormat::r32f, .mips = 3});
    texture.upload(std::vector<float>{0, 4, 8, 8, 4, 8, 8, 8});
    texture.generate_mips();
    EXPECT_EQ(texture.read_floats(1), (std::vector<float>{4.0F, 8.0F}));
    EXPECT_EQ(texture.read_floats(2), (std::vector<float>{6.0F}));
}

TEST_P(TextureOn, RefusesASideOfZeroAndASideOverTheLimitByName) {
    for (const TextureDesc& desc :
         {TextureDesc{.width = 0, .height = 0}, TextureDesc{.width = 1 << 20, .height = 4}}) {
        const std::string message = error_of([&] { Texture(context(), desc, "coc"); });
        EXPECT_NE(message.find("texture 'coc'"), std::string::npos) << message;
        EXPECT_NE(message.find(desc.width == 0 ? "0x0" : "1048576x4"), std::string::npos) << message;
        EXPECT_NE(message.find("GL_MAX_TEXTURE_SIZE"), std::string::npos) << message;
    }
    EXPECT_NE(error_of([&] { make({.width = 4, .height = 4, .mips = 4}); }), "");
    EXPECT_NE(error_of([&] { make({.width = 4, .height = 4, .layers = 1 << 20}); }), "");
    EXPECT_NO_THROW(context().check("after the refusals"));
}

TEST_P(TextureOn, TakesALabelLongerThanGlDoes) {
    EXPECT_NO_THROW(Texture(context(), {.width = 1, .height = 1}, std::string(5000, 'x')));
}

TEST(TextureFormat, NamesAreThoseOfTheManifest) {
    EXPECT_EQ(parse_texture_format("rgba16f"), TextureFormat::rgba16f);
    EXPECT_EQ(parse_texture_format("rgb16f"), std::nullopt);
    EXPECT_EQ(texture_format_names().size(), 13U);
    EXPECT_EQ(texture_format_name(TextureFormat::r32i), "r32i");
    EXPECT_TRUE(is_integer(TextureFormat::r32ui) && is_integer(TextureFormat::r32i));
    EXPECT_FALSE(is_integer(TextureFormat::rgba32f));
    EXPECT_TRUE(is_signed_integer(TextureFormat::r32i));
    EXPECT_FALSE(is_signed_integer(TextureFormat::rgba32ui));
}

TEST(TextureDesc, CountsTheBytesOfAllLevelsAndLayers) {
    EXPECT_EQ(byte_size({.width = 4, .height = 2, .format = TextureFormat::rgba32f}), 128U);
    EXPECT_EQ(byte_size({.width = 4, .height = 2, .format = TextureFormat::r16f, .layers = 2, .mips = 3}),
              44U);
    EXPECT_EQ(byte_size({.width = 16384, .height = 16384, .format = TextureFormat::rgba32f}), 4294967296U);
}

// ---- views ----

/// Numbers whose bits every format keeps as they are: no NaN, no half or float below the normal ones.
std::vector<std::uint32_t> words(std::size_t count) {
    std::vector<std::uint32_t> result(count);
    for (std::size_t i = 0; i < count; ++i)
        result[i] = 0x40803C01U + static_cast<std::uint32_t>(i % 7) * 0x00110010U;
    return result;
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
    std::vector<std::uint32_t> result;
    for (const float value : values) result.push_back(std::bit_cast<std::uint32_t>(value));
    return result;
}

struct WordFormats {
    TextureFormat floats, integers;
};
constexpr WordFormats kWordFormats[] = {{TextureFormat::r32f, TextureFormat::r32ui},
                                        {TextureFormat::rg32f, TextureFormat::rg32ui},
                                        {TextureFormat::rgba32f, TextureFormat::rgba32ui}};

TEST_P(TextureOn, AViewReadsTheBitsOfItsMemoryAndWritesThem) {
    for (const auto& [floats, integers] : kWordFormats) {
        const Texture memory = make({.width = 6, .height = 4, .format = floats});
        Texture view(memory, integers, "view");
        const std::vector<std::uint32_t> content = words(24U * static_cast<unsigned>(channel_count(floats)));
        view.upload(content);
        EXPECT_EQ(bits_of(memory.read_floats()), content) << texture_format_name(floats);
        EXPECT_EQ(view.read_uints(), content);
        view.clear_to({double(0x3F800000U), 0, 0, 0});
        EXPECT_EQ(memory.read_floats().front(), 1.0F);
    }
}

TEST_P(TextureOn, ClearsAViewOfEverySizeToItsOwnValues) {
    for (const TextureFormat memory_format : all_formats())
        for (const TextureFormat format : all_formats()) {
            const TextureDesc desc{.width = 5, .height = 3, .format = memory_format};
            TextureDesc other = desc;
            other.format = format;
            if (!may_share_memory(desc, other)) continue;
            const Texture memory = make(desc);
            Texture view(memory, format, "view");
            view.clear_to({1, 0, 1, 0});
            const std::vector<float> got = view.read_floats();
            for (std::size_t i = 0; i < got.size(); ++i) {
                const std::size_t channel = i % static_cast<std::size_t>(channel_count(format));
                ASSERT_EQ(got[i], channel % 2 == 0 ? 1.0F : 0.0F)
                    << texture_format_name(memory_format) << " as " << texture_format_name(format);
            }
        }
}

TEST_P(TextureOn, DrawsIntoAViewAndFetchesFromIt) {
    const Program numbers = fragment(R"(layout(location = 0) out uvec4 c;
void main() { c = uvec4(gl_FragCoord.x, gl_FragCoord.y, 7u, 0xFFFFFFFFu); })");
    const Program twice = fragment(R"(layout(binding = 0) uniform usampler2D source;
layout(location = 0) out vec4 c;
void main() { c = 2.0 * vec4(texelFetch(source, ivec2(gl_FragCoord.xy), 0).xyz, 0.5); })");
    const Texture memory = make({.width = 6, .height = 4, .format = TextureFormat::rgba32f});
    const Texture view(memory, TextureFormat::rgba32ui, "view"),
        copied(make(memory.desc()), TextureFormat::rgba32ui, "copy");
    const Target targets[] = {{.texture = &view}};
    draw(context(), numbers, targets, {});
    copy(context(), view, copied);
    EXPECT_EQ(copied.read_uints(), view.read_uints());
    EXPECT_EQ(bits_of(memory.read_floats()), view.read_uints());
    const SampledTexture textures[] = {{.texture = &copied}};
    const std::vector<float> got = drawn(twice, 6, 4, {.textures = textures});
    for (std::size_t y = 0; y < 4; ++y)
        for (std::size_t x = 0; x < 6; ++x) {
            const float* const texel = &got[4 * (6 * y + x)];
            EXPECT_EQ(texel[0], 2 * x);
            EXPECT_EQ(texel[1], 2 * y);
            EXPECT_EQ(texel[2], 14);
        }
}

TEST_P(TextureOn, AViewOutlivesTheTextureItWasMadeOf) {
    std::optional<Texture> memory = make({.width = 2, .height = 2, .format = TextureFormat::r32f});
    memory->clear(1);
    const Texture view(*memory, TextureFormat::r32ui, "view");
    memory.reset();
    EXPECT_EQ(view.read_uints(), std::vector<std::uint32_t>(4, 0x3F800000U));
}

TEST(TextureDescs, ShareMemoryWhereNothingButAFormatOfTheSameBytesDiffers) {
    const TextureDesc desc{.width = 8, .height = 4, .format = TextureFormat::rgba8, .layers = 2, .mips = 2};
    const auto with = [&](const auto& change) {
        TextureDesc other = desc;
        change(other);
        return may_share_memory(desc, other);
    };
    for (const TextureFormat format : all_formats())
        EXPECT_EQ(with([&](TextureDesc& other) { other.format = format; }), bytes_per_texel(format) == 4);
    EXPECT_FALSE(with([](TextureDesc& other) { other.width = 4; }));
    EXPECT_FALSE(with([](TextureDesc& other) { other.height = 8; }));
    EXPECT_FALSE(with([](TextureDesc& other) { other.layers = 1; }));
    EXPECT_FALSE(with([](TextureDesc& other) { other.mips = 1; }));
}

}  // namespace
}  // namespace aftershade::gpu
