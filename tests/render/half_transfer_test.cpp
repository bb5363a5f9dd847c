// Texels that travel as halfs: against Imath, by which EXR files are written.
#include <Imath/half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "framework/base/half_values.h"
#include "framework/gpu/texture.h"
#include "tests/backends.h"
#include "tests/scoped_variable.h"

namespace aftershade::test {
namespace {

constexpr int kSide = 512;
constexpr std::size_t kValues = std::size_t(kSide) * kSide * 4;  // a million
constexpr std::uint64_t kMiB = 1 << 20;

std::uint32_t bits_of(float value) {
    return std::bit_cast<std::uint32_t>(value);
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
    std::vector<std::uint32_t> bits(values.size());
    std::ranges::transform(values, bits.begin(), [](float value) { return bits_of(value); });
    return bits;
}

float float_of(int half_bits) {
    return float(Imath::half(Imath::half::FromBits, std::uint16_t(half_bits)));
}

/// Every half, what lies between two, their neighbours, and random bits, repeated to a million; all of a size
/// that is a half.
std::vector<float> plain_floats() {
    constexpr float kLargest = 65504;
    std::vector<float> values;
    for (int bits = 0; bits < 0x7c00; ++bits)
        for (const float sign : {1.0F, -1.0F}) {
            const float value = sign * float_of(bits);
            const float next = sign * (bits + 1 < 0x7c00 ? float_of(bits + 1) : kLargest);
            const float tie = (value + next) / 2;
            values.insert(values.end(), {value, tie, std::nextafter(tie, 0.0F), std::nextafter(tie, next)});
        }
    values.insert(values.end(), {1e-45F, -1e-40F, std::ldexp(1.0F, -25), std::ldexp(1.0F, -126), -0.0F});
    std::uint32_t seed = 1;
    while (values.size() < kValues) {
        seed = seed * 1664525U + 1013904223U;
        const float value = std::bit_cast<float>(seed);
        if (std::abs(value) <= kLargest) values.push_back(value);
    }
    return values;
}

class HalfTransfers : public gpu::OnEachBackend {
protected:
    void SetUp() override {
        OnEachBackend::SetUp();
        if (IsSkipped()) return;
        if (!converts_halfs()) GTEST_SKIP() << "the processor has no instruction for halfs";
        ScopedVariable way("AFTERSHADE_TRANSFERS");
        way.set("mapped");
        context_.emplace(GetParam());
    }
    gpu::Texture texture(int layers = 1) {
        gpu::TextureDesc desc{.width = kSide, .height = kSide};
        desc.layers = layers;
        return {*context_, desc, "half"};
    }
    std::vector<float> read_as_halfs(const gpu::Texture& texture, int channels = 4) {
        std::vector<float> values(kValues / 4 * std::size_t(channels));
        texture.begin_read(channels, gpu::ReadAs::halfs).finish(std::span(values));
        return values;
    }
    std::uint64_t buffer_bytes() const { return context_->transfer_use().buffer_bytes; }

private:
    std::optional<gpu::Context> context_;
};
ON_EACH_BACKEND(HalfTransfers);

TEST_P(HalfTransfers, RoundAMillionFloatsAsTheWriterOfFilesDoes) {
    const std::vector<float> values = plain_floats();
    gpu::Texture of = texture();
    of.upload(values);
    const std::vector<float> got = read_as_halfs(of);
    for (std::size_t i = 0; i < kValues; ++i)
        ASSERT_EQ(bits_of(got[i]), bits_of(float(Imath::half(values[i])))) << values[i];
    EXPECT_EQ(bits_of(of.read_floats()), bits_of(values)) << "and the texture has them unrounded";
}

TEST_P(HalfTransfers, GiveFloatsWhereAValueIsBeyondHalfs) {
    const float inf = std::numeric_limits<float>::infinity();
    for (const std::uint32_t bits : {bits_of(65505.0F), bits_of(65520.0F), bits_of(-3e38F), bits_of(inf),
                                     bits_of(-inf), 0x7fc00000U, 0x7f800001U, 0xffc12345U, 0x7fa00000U}) {
        std::vector<float> values = plain_floats();
        values[kValues / 3] = std::bit_cast<float>(bits);
        gpu::Texture of = texture();
        of.upload(values);
        EXPECT_EQ(bits_of(read_as_halfs(of)), bits_of(values)) << bits;
    }
}

TEST_P(HalfTransfers, UploadWhatIsAHalfWithHalfTheBytesAndTheSameBits) {
    std::vector<float> values(kValues);
    for (std::size_t i = 0; i < kValues; ++i) {
        const int half = int(i) & 0xffff;
        const bool is_signalling = (half & 0x7c00) == 0x7c00 && (half & 0x3ff) && !(half & 0x200);
        values[i] = float_of(is_signalling ? 0 : half);
    }
    gpu::Texture of = texture(3);
    const std::uint64_t before = buffer_bytes();
    of.upload(values, 1);
    EXPECT_EQ(buffer_bytes() - before, 2 * kMiB);
    EXPECT_EQ(bits_of(of.read_floats(0, 1)), bits_of(values));
    values[kValues - 1] = 0.1F;  // the last of them is no half
    of.upload(values, 2);
    EXPECT_EQ(bits_of(of.read_floats(0, 2)), bits_of(values));
    values[5] = std::bit_cast<float>(0x7f802000U);  // a signalling NaN
    of.upload(values, 0);
    EXPECT_EQ(bits_of(of.read_floats(0, 0)), bits_of(values));
}

TEST_P(HalfTransfers, WidenAndNarrowOnTheWay) {
    std::vector<float> values(kValues / 4 * 3);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float_of(int(i % 0x7bff));
    gpu::Texture of = texture();
    of.upload(values, 0, 0, 3);
    EXPECT_EQ(bits_of(read_as_halfs(of, 3)), bits_of(values));
    const std::vector<float> all = of.read_floats();
    for (std::size_t i = 0; i < kValues; i += 4) ASSERT_EQ(all[i + 3], 0.0F);
}

}  // namespace
}  // namespace aftershade::test
