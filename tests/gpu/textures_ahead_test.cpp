// Textures that a thread makes in a context beside the test's own: they are like any other, once.
#include "framework/gpu/textures_ahead.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

constexpr TextureDesc kColor{.width = 37, .height = 21, .format = TextureFormat::rgba32f};
constexpr TextureDesc kLevels{.width = 16, .height = 8, .format = TextureFormat::r32ui, .mips = 3};
constexpr TextureDesc kLayers{.width = 9, .height = 9, .format = TextureFormat::rg16f, .layers = 3};

/// Waits until the thread has made all `count` textures.
bool makes(const TexturesAhead& ahead, std::size_t count) {
    using namespace std::chrono_literals;
    for (int i = 0; i < 6000 && ahead.textures_made() < count; ++i) std::this_thread::sleep_for(10ms);
    return ahead.textures_made() == count;
}

class TexturesAheadOn : public SoftwareTest {};
ON_SOFTWARE_BACKENDS(TexturesAheadOn);

TEST_P(TexturesAheadOn, BelongToTheContextAndBeginAsZero) {
    const std::size_t before = context().objects().textures;
    {
        TexturesAhead ahead(context(), {kColor, kLevels, kLayers});
        ASSERT_TRUE(makes(ahead, 3));
        EXPECT_EQ(context().objects().textures, before) << "not taken yet";
        const std::optional<Texture> color = ahead.take(kColor, "color");
        const std::optional<Texture> levels = ahead.take(kLevels, "levels");
        const std::optional<Texture> layers = ahead.take(kLayers, "layers");
        ASSERT_TRUE(color && levels && layers);
        EXPECT_EQ(context().objects().textures, before + 3);
        EXPECT_EQ(color->desc(), kColor);
        EXPECT_EQ(layers->desc(), kLayers);
        EXPECT_EQ(color->label(), "color");
        EXPECT_EQ(color->read_floats(), std::vector<float>(37 * 21 * 4));
        EXPECT_EQ(levels->read_uints(2), std::vector<std::uint32_t>(4 * 2));
        EXPECT_EQ(layers->read_floats(0, 2), std::vector<float>(9 * 9 * 2));
    }
    EXPECT_EQ(context().objects().textures, before);
}

TEST_P(TexturesAheadOn, AreDrawnToReadAndUploadedAndOutliveTheirMaker) {
    std::optional<Texture> source, target;
    {
        TexturesAhead ahead(context(), {kColor, kColor});
        ASSERT_TRUE(makes(ahead, 2));
        source = ahead.take(kColor, "source");
        target = ahead.take(kColor, "target");
    }
    ASSERT_TRUE(source && target);
    std::vector<float> values(37 * 21 * 4);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) * 0.25F;
    source->upload(values);
    const Program program = fragment(R"(
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 result;
void main() { result = texelFetch(source, ivec2(gl_FragCoord.xy), 0) * 2.0; })");
    const SampledTexture textures[] = {{&*source, 0}};
    const Target targets[] = {{.texture = &*target}};
    draw(context(), program, targets, {.textures = textures});
    std::ranges::transform(values, values.begin(), [](float value) { return value * 2; });
    EXPECT_EQ(target->read_floats(), values);
}

TEST_P(TexturesAheadOn, AreAllThereOnceTheCallerHasHelped) {
    const std::vector<TextureDesc> descs(
        20, TextureDesc{.width = 700, .height = 300, .format = TextureFormat::rgba32f});
    TexturesAhead ahead(context(), descs);
    ahead.finish();
    EXPECT_EQ(ahead.textures_made(), descs.size());
    ahead.finish();
    std::vector<unsigned int> handles;
    for (const TextureDesc& desc : descs) {
        const std::optional<Texture> texture = ahead.take(desc, "one");
        ASSERT_TRUE(texture);
        EXPECT_EQ(texture->read_floats()[5], 0.0F);
        handles.push_back(texture->handle());
    }
    std::ranges::sort(handles);
    EXPECT_EQ(std::ranges::unique(handles).size(), 0U) << "each is made once";
}

TEST_P(TexturesAheadOn, AreTakenOnceAndByTheirDescriptionAlone) {
    TexturesAhead ahead(context(), {kColor});
    ASSERT_TRUE(makes(ahead, 1));
    TextureDesc other = kColor;
    other.format = TextureFormat::rgba32ui;
    EXPECT_FALSE(ahead.take(other, "another format"));
    EXPECT_TRUE(ahead.take(kColor, "the one"));
    EXPECT_FALSE(ahead.take(kColor, "a second one"));
}

TEST_P(TexturesAheadOn, LeaveToTheCallerWhatCannotBeMade) {
    constexpr TextureDesc kLarge{.width = 512, .height = 512, .format = TextureFormat::rgba32f};
    constexpr TextureDesc kTooWide{.width = 1 << 20, .height = 1, .format = TextureFormat::r8};
    TexturesAhead ahead(context(), {kTooWide, kLarge});
    ASSERT_TRUE(makes(ahead, 1)) << "the largest first";
    EXPECT_TRUE(ahead.take(kLarge, "large"));
    ahead.finish();
    EXPECT_FALSE(ahead.take(kTooWide, "too wide"));
    EXPECT_NO_THROW(context().check("the thread's fault is not the caller's"));
}

TEST_P(TexturesAheadOn, AreWorthAThreadWhereTheyAreLarge) {
    constexpr TextureDesc kLarge{.width = 1920, .height = 1080, .format = TextureFormat::rgba32f};
    EXPECT_FALSE(TexturesAhead::is_useful(context(), {kColor, kLevels}));
    EXPECT_TRUE(TexturesAhead::is_useful(context(), {kColor, kLarge}));
}

}  // namespace
}  // namespace aftershade::gpu
