#include "framework/golden/report_pictures.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <limits>
#include <string>
#include <vector>

namespace aftershade::test {
namespace {

std::string encoded(std::string_view text) {
    return base64(std::as_bytes(std::span(text)));
}

TEST(PagePixels, WritesTheBase64OfRfc4648) {
    // Section 10 of the RFC.
    const std::array<std::pair<const char*, const char*>, 7> vectors = {{{"", ""},
                                                                         {"f", "Zg=="},
                                                                         {"fo", "Zm8="},
                                                                         {"foo", "Zm9v"},
                                                                         {"foob", "Zm9vYg=="},
                                                                         {"fooba", "Zm9vYmE="},
                                                                         {"foobar", "Zm9vYmFy"}}};
    for (const auto& [text, expected] : vectors) EXPECT_EQ(encoded(text), expected);
    EXPECT_EQ(encoded("\xfb\xff\xbf"), "+/+/") << "the digits above letters and numbers";
}

std::vector<unsigned char> inflated(const std::string& text, std::size_t size) {
    std::vector<unsigned char> packed;
    std::uint32_t group = 0, bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        group = group << 6 | std::uint32_t(digits.find(c));
        if (bits += 6; bits >= 8) packed.push_back(static_cast<unsigned char>(group >> (bits -= 8) & 255));
    }
    std::vector<unsigned char> bytes(size + 1);
    uLongf length = bytes.size();
    EXPECT_EQ(uncompress(bytes.data(), &length, packed.data(), packed.size()), Z_OK);
    bytes.resize(length);
    return bytes;
}

/// What the page's script does: sums of differences, planes into values.
std::vector<std::uint32_t> bits_of(const PagePixels& stored, std::size_t pixels, std::size_t channels,
                                   std::size_t bytes) {
    const std::vector<unsigned char> planes = inflated(stored.text, pixels * channels * bytes);
    EXPECT_EQ(planes.size(), pixels * channels * bytes);
    std::vector<std::uint32_t> values(pixels * channels);
    std::size_t at = 0;
    for (std::size_t c = 0; c < channels; ++c)
        for (std::size_t byte = 0; byte < bytes; ++byte) {
            unsigned char sum = 0;
            for (std::size_t i = 0; i < pixels; ++i) {
                sum = static_cast<unsigned char>(sum + planes[at++]);
                values[i * channels + c] |= std::uint32_t(sum) << (8 * byte);
            }
        }
    return values;
}

TEST(PagePixels, KeepsEveryBitOfFloats) {
    Image image(5, 3, 3);
    for (std::size_t i = 0; i < image.floats().size(); ++i)
        image.floats()[i] = float(i) * 0.1f - 1e-30f / (float(i) + 1);
    image.floats()[4] = std::numeric_limits<float>::infinity();
    image.floats()[7] = -0.0f;
    const PagePixels stored = page_pixels(image);
    EXPECT_EQ(stored.type, "float");
    const std::vector<std::uint32_t> bits = bits_of(stored, 15, 3, 4);
    for (std::size_t i = 0; i < bits.size(); ++i)
        EXPECT_EQ(bits[i], std::bit_cast<std::uint32_t>(image.floats()[i])) << i;
}

TEST(PagePixels, TakesHalfOfTheRoomWhereEveryValueIsAHalf) {
    Image image(3, 1, 1);
    image.floats()[0] = 0.333251953125f;  // 0x3555, the half nearest to 1 / 3
    image.floats()[1] = -65504;           // 0xfbff
    image.floats()[2] = std::numeric_limits<float>::quiet_NaN();
    const PagePixels stored = page_pixels(image);
    EXPECT_EQ(stored.type, "half");
    const std::vector<std::uint32_t> bits = bits_of(stored, 3, 1, 2);
    EXPECT_EQ(bits[0], 0x3555u);
    EXPECT_EQ(bits[1], 0xfbffu);
    EXPECT_GT(bits[2] & 0x7fffu, 0x7c00u) << "NaN: all of the exponent and some of the fraction";
    image.floats()[0] = 0.333f;
    EXPECT_EQ(page_pixels(image).type, "float") << "no half is 0.333f";
    image.floats()[0] = 65520;
    EXPECT_EQ(page_pixels(image).type, "float") << "infinity as a half";
}

TEST(PagePixels, KeepsIds) {
    Image image(2, 2, 1, ComponentType::uint32);
    image.uints()[0] = 4294967295u;
    image.uints()[3] = 77;
    const PagePixels stored = page_pixels(image);
    EXPECT_EQ(stored.type, "uint");
    EXPECT_EQ(bits_of(stored, 4, 1, 4), (std::vector<std::uint32_t>{4294967295u, 0, 0, 77}));
}

}  // namespace
}  // namespace aftershade::test
