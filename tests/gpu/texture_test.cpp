#include "framework/gpu/texture.h"

#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "framework/core/error.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

static_assert(std::is_nothrow_move_constructible_v<Texture> && std::is_nothrow_move_assignable_v<Texture>);
static_assert(!std::is_copy_constructible_v<Texture> && !std::is_copy_assignable_v<Texture>);

class TextureOn : public SoftwareTest {
protected:
    Texture make(const TextureDesc& desc) { return Texture(context(), desc, "made"); }
};
ON_SOFTWARE_BACKENDS(TextureOn);

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
    ids.clear_uint(4000000000U);
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

}  // namespace
}  // namespace aftershade::gpu
