// Texels through mapped buffers, which software renderers are made to use here: against GL's own copies.
#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/gpu/texture.h"
#include "tests/gpu/gpu_test.h"
#include "tests/scoped_variable.h"

namespace aftershade::gpu {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

class TransfersOn : public OnEachBackend {
protected:
    void SetUp() override {
        OnEachBackend::SetUp();
        if (IsSkipped()) return;
        variable_.set("mapped");
        mapped_.emplace(GetParam());
        variable_.set("direct");
        direct_.emplace(GetParam());
    }
    Context& mapped() { return *mapped_; }
    Context& direct() { return *direct_; }

private:
    test::ScopedVariable variable_{"AFTERSHADE_TRANSFERS"};
    std::optional<Context> mapped_, direct_;
};
ON_EACH_BACKEND(TransfersOn);

std::vector<std::uint32_t> some_words(std::size_t count, std::uint32_t seed = 1) {
    std::vector<std::uint32_t> words(count);
    for (std::uint32_t& word : words) word = seed = seed * 1664525U + 1013904223U;
    return words;
}

/// Numbers that halves and bytes have no way to keep.
std::vector<float> some_floats(std::size_t count, std::uint32_t seed = 1) {
    std::vector<float> floats;
    for (const std::uint32_t word : some_words(count, seed)) floats.push_back(float(word) / 65536.0F - 9.0F);
    return floats;
}

std::size_t value_count(const TextureDesc& desc, int level) {
    return std::size_t(std::max(1, desc.width >> level)) * std::size_t(std::max(1, desc.height >> level)) *
           std::size_t(channel_count(desc.format));
}

/// What a texture gives back that got other values in each level and layer.
struct Content {
    std::vector<std::vector<float>> floats;
    std::vector<std::vector<std::uint32_t>> words;
    bool operator==(const Content&) const = default;
};

Content given_back(Context& context, const TextureDesc& desc) {
    Texture texture(context, desc, "given");
    for (int level = 0; level < desc.mips; ++level)
        for (int layer = 0; layer < desc.layers; ++layer) {
            const std::uint32_t seed = std::uint32_t(100 * level + layer);
            if (is_integer(desc.format))
                texture.upload(some_words(value_count(desc, level), seed), layer, level);
            else texture.upload(some_floats(value_count(desc, level), seed), layer, level);
        }
    Content content;
    for (int level = 0; level < desc.mips; ++level)
        for (int layer = 0; layer < desc.layers; ++layer) {
            content.floats.push_back(texture.read_floats(level, layer));
            content.words.push_back(texture.read_uints(level, layer));
        }
    return content;
}

TEST_P(TransfersOn, KeepTheBitsOfGlsOwnCopiesInEveryFormatSizeLevelAndLayer) {
    EXPECT_TRUE(mapped().info().maps_transfers);
    EXPECT_FALSE(direct().info().maps_transfers);
    for (const std::string_view name : texture_format_names())
        for (const auto& [width, height] : {std::pair(1, 1), {3, 1}, {1, 7}, {17, 13}, {255, 129}})
            for (const int layers : {1, 3}) {
                TextureDesc desc{.width = width, .height = height, .format = *parse_texture_format(name)};
                desc.layers = layers;
                if (width > 200) desc.mips = 4;
                EXPECT_EQ(given_back(mapped(), desc), given_back(direct(), desc))
                    << name << " " << width << "x" << height << ", " << layers << " layers";
            }
    EXPECT_GT(mapped().transfer_use().buffer_bytes, 0U);
    EXPECT_EQ(direct().transfer_use().buffer_bytes, 0U);
}

TEST_P(TransfersOn, TakeATextureLargerThanABuffer) {
    const TextureDesc desc{.width = 2047, .height = 1031};  // 32 MiB, and rows that do not divide a buffer
    const std::vector<float> values = some_floats(value_count(desc, 0));
    Texture texture(mapped(), desc, "large");
    texture.upload(values);
    EXPECT_EQ(texture.read_floats(), values);
}

TEST_P(TransfersOn, WidenOnTheWayThereAndNarrowOnTheWayBack) {
    for (const int side : {5, 700}) {
        Texture texture(mapped(), {.width = side, .height = side - 1}, "wide");
        const std::size_t pixels = std::size_t(side) * std::size_t(side - 1);
        const std::vector<float> values = some_floats(3 * pixels);
        texture.upload(values, 0, 0, 3);
        std::vector<float> wide(4 * pixels);
        for (std::size_t i = 0; i < pixels; ++i) std::copy_n(&values[3 * i], 3, &wide[4 * i]);
        EXPECT_EQ(texture.read_floats(), wide);
        std::vector<float> narrow(3 * pixels), seen;
        std::mutex guard;
        texture.begin_read(3).finish(std::span(narrow), [&](std::span<const float> part) {
            const std::lock_guard lock(guard);
            seen.insert(seen.end(), part.begin(), part.end());
        });
        EXPECT_EQ(narrow, values);
        std::ranges::sort(seen);
        std::ranges::sort(narrow);
        EXPECT_EQ(seen, narrow);
    }
}

TEST_P(TransfersOn, ReadWhatATextureHeldWhenTheReadBegan) {
    Texture texture(mapped(), {.width = 64, .height = 64}, "changing");
    std::vector<TexelRead> reads;
    for (int i = 0; i < 20; ++i) {
        texture.upload(some_floats(value_count(texture.desc(), 0), std::uint32_t(i)));
        reads.push_back(texture.begin_read());
    }
    for (std::size_t i = reads.size(); i-- > 0;) {
        std::vector<float> got(value_count(texture.desc(), 0));
        reads[i].finish(std::span(got));
        EXPECT_EQ(got, some_floats(got.size(), std::uint32_t(i)));
    }
}

TEST_P(TransfersOn, StayWithinTheirMemoryHoweverManyFramesPass) {
    const TextureDesc desc{.width = 640, .height = 360};
    Texture texture(mapped(), desc, "frame");
    std::uint64_t after_ten = 0;
    for (int frame = 0; frame < 200; ++frame) {
        const std::vector<float> values = some_floats(value_count(desc, 0), std::uint32_t(frame % 7));
        texture.upload(values);
        TexelRead read = texture.begin_read();
        std::vector<float> got(values.size());
        read.finish(std::span(got));
        ASSERT_EQ(got, values) << frame;
        if (frame == 10) after_ten = mapped().transfer_use().buffer_bytes;
    }
    EXPECT_EQ(mapped().transfer_use().buffer_bytes, after_ten);
    EXPECT_LE(after_ten, 64 * kMiB);
}

TEST_P(TransfersOn, ReadAtOnceWhereAllBuffersAreHeld) {
    const TextureDesc desc{.width = 2048, .height = 1024};
    Texture texture(mapped(), desc, "held");
    std::vector<TexelRead> reads;
    for (int i = 0; i < 20; ++i) {  // 640 MiB, of which at most 512 lie in buffers
        texture.clear(float(i));
        reads.push_back(texture.begin_read());
    }
    EXPECT_LE(mapped().transfer_use().buffer_bytes, 512 * kMiB);
    std::vector<float> got(value_count(desc, 0));
    for (std::size_t i = 0; i < reads.size(); ++i) {
        reads[i].finish(std::span(got));
        ASSERT_TRUE(std::ranges::all_of(got, [&](float value) { return value == float(i); })) << i;
    }
}

TEST_P(TransfersOn, LeaveReadsThatNobodyFinishes) {
    Texture texture(mapped(), {.width = 300, .height = 300}, "dropped");
    for (int i = 0; i < 100; ++i) {
        texture.clear(float(i));
        const TexelRead dropped = texture.begin_read();
    }
    EXPECT_EQ(texture.read_floats()[5], 99.0F);
    EXPECT_LE(mapped().transfer_use().buffer_bytes, 8 * kMiB);
}

TEST(Transfers, RefuseAnUnknownWayByItsName) {
    SKIP_WITHOUT(test_backend());
    test::ScopedVariable variable("AFTERSHADE_TRANSFERS");
    variable.set("pinned");
    const std::string message = error_of([] { const Context context(test_backend()); });
    EXPECT_EQ(message, "AFTERSHADE_TRANSFERS: 'pinned' is not one of auto, direct, mapped");
    variable.set("auto");
    EXPECT_EQ(Context(test_backend()).info().maps_transfers, !Context(test_backend()).info().software);
}

}  // namespace
}  // namespace aftershade::gpu
