// What the samples of a PNG mean.
#include "framework/file/png_color.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <vector>

#include "framework/file/picture.h"
#include "framework/file/png_file.h"
#include "framework/image/srgb.h"
#include "tests/file/png_chunks.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

using test::png_number;

std::string numbers(const std::vector<std::uint32_t>& values) {
    std::string text;
    for (const std::uint32_t value : values) text += png_number(value);
    return text;
}

PngColor color_of(const std::vector<std::pair<std::string, std::string>>& chunks) {
    PngColorReader reader;
    for (const auto& [type, data] : chunks)
        reader.read(type, {reinterpret_cast<const unsigned char*>(data.data()), data.size()});
    return reader.color();
}

/// A display's profile of three colorants and one curve, by ICC.1:2022.
std::string icc_profile(const std::string& curve, bool exchanged = false) {
    const auto fixed = [](double value) {
        return png_number(std::uint32_t(std::int32_t(std::lround(value * 65536))));
    };
    const auto xyz = [&](double x, double y, double z) {
        return "XYZ " + png_number(0) + fixed(x) + fixed(y) + fixed(z);
    };
    const std::string red = xyz(0.4361, 0.2225, 0.0139), green = xyz(0.3851, 0.7169, 0.0971),
                      blue = xyz(0.1431, 0.0606, 0.7141);
    const std::vector<std::pair<std::string, std::string>> tags = {{"rXYZ", exchanged ? blue : red},
                                                                   {"gXYZ", green},
                                                                   {"bXYZ", exchanged ? red : blue},
                                                                   {"rTRC", curve},
                                                                   {"gTRC", curve},
                                                                   {"bTRC", curve}};
    std::string table = png_number(std::uint32_t(tags.size())), data;
    for (const auto& [name, tag] : tags) {
        table += name + png_number(std::uint32_t(132 + 12 * tags.size() + data.size())) +
                 png_number(std::uint32_t(tag.size()));
        data += tag + std::string((4 - tag.size() % 4) % 4, '\0');
    }
    return std::string(16, '\0') + "RGB XYZ " + std::string(104, '\0') + table + data;
}

std::string iccp(const std::string& profile) {
    uLongf size = compressBound(uLong(profile.size()));
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(profile.data()),
             uLong(profile.size()));
    packed.resize(size);
    return "my screen" + std::string(2, '\0') + packed;
}

std::string power(double gamma) {
    const int value = int(std::lround(gamma * 256));
    return "curv" + png_number(0) + png_number(1) + char(value >> 8) + char(value);
}

/// sRGB's own curve as a table and as numbers.
std::string srgb_table() {
    std::string text = "curv" + png_number(0) + png_number(1024);
    for (int i = 0; i < 1024; ++i) {
        const int value = int(std::lround(65535 * decode_srgb(i / 1023.0)));
        text += {char(value >> 8), char(value)};
    }
    return text;
}
std::string srgb_numbers() {
    std::string text = "para" + png_number(0) + std::string{0, 3, 0, 0};
    for (const double value : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045})
        text += png_number(std::uint32_t(std::lround(value * 65536)));
    return text;
}

const std::string kGamma1 = png_number(100000), kGamma22 = png_number(45455);
const std::string kWide = numbers({31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600});

TEST(PngColor, IsSrgbWithoutChunksAndByEachOfThem) {
    EXPECT_TRUE(color_of({}).is_srgb());
    const std::string same = numbers({31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000});
    for (const auto& chunk :
         std::vector<std::pair<std::string, std::string>>{{"sRGB", std::string(1, '\0')},
                                                          {"gAMA", kGamma22},
                                                          {"gAMA", png_number(45450)},
                                                          {"cHRM", same},
                                                          {"cICP", {1, 13, 0, 1}},
                                                          {"iCCP", iccp(icc_profile(power(2.2)))},
                                                          {"iCCP", iccp(icc_profile(srgb_table()))},
                                                          {"iCCP", iccp(icc_profile(srgb_numbers()))}}) {
        EXPECT_EQ(color_of({chunk}).space, "sRGB") << chunk.first;
        EXPECT_FALSE(color_of({chunk}).gamma) << chunk.first;
    }
}

TEST(PngColor, NamesWhatIsNotSrgb) {
    EXPECT_EQ(color_of({{"cICP", {9, 16, 0, 1}}}).space, "cICP 9 16 0 1");
    EXPECT_EQ(color_of({{"cHRM", kWide}}).space,
              "primaries 0.7080 0.2920 0.1700 0.7970 0.1310 0.0460 0.3127 0.3290");
    for (const std::string& profile : {icc_profile(power(2.2), true), icc_profile(power(1.8)),
                                       icc_profile(power(1)), std::string("no profile")})
        EXPECT_TRUE(
            color_of({{"iCCP", iccp(profile)}}).space.starts_with("ICC profile 'my screen' (checksum "));
    EXPECT_NE(color_of({{"iCCP", iccp(icc_profile(power(1.8)))}}).space,
              color_of({{"iCCP", iccp(icc_profile(power(1)))}}).space);
    EXPECT_EQ(color_of({{"gAMA", kGamma1}}).gamma, 1.0);
    EXPECT_EQ(color_of({{"gAMA", png_number(55556)}}).gamma, 0.55556);
}

TEST(PngColor, TakesTheStrongerChunk) {
    // PNG specification, third edition, 4.3.
    const std::pair<std::string, std::string> intent{"sRGB", std::string(1, '\0')}, gamma{"gAMA", kGamma1},
        wide{"cHRM", kWide}, pq{"cICP", {9, 16, 0, 1}}, icc{"iCCP", iccp(icc_profile(power(1)))};
    EXPECT_TRUE(color_of({gamma, wide, intent}).is_srgb());
    EXPECT_FALSE(color_of({gamma, wide, intent}).gamma);
    EXPECT_EQ(color_of({pq, icc, intent}).space, "cICP 9 16 0 1");
    EXPECT_TRUE(color_of({icc, intent}).space.starts_with("ICC"));
    EXPECT_FALSE(color_of({icc, gamma}).gamma);
    EXPECT_TRUE(color_of({gamma, wide}).gamma);
}

TEST(PngColor, OfDamagedChunksIsNoFault) {
    std::string profile = iccp(icc_profile(srgb_table()));
    for (std::size_t bytes = 0; bytes < profile.size(); bytes += 7)
        color_of({{"iCCP", profile.substr(0, bytes)}});
    std::string plain = icc_profile(srgb_table());
    for (std::size_t at = 128; at < plain.size() && at < 260; ++at) {
        std::string damaged = plain;
        damaged[at] = char(0xff);
        is_srgb_profile({reinterpret_cast<const unsigned char*>(damaged.data()), damaged.size()});
    }
    EXPECT_TRUE(color_of({{"gAMA", png_number(0)}, {"gAMA", "x"}, {"cHRM", "x"}, {"cICP", "x"}}).is_srgb());
}

TEST(Picture, DecodesAPngByItsGammaAndRefusesOtherSpaces) {
    const test::TemporaryFolder folder;
    Image grey(2, 2, 3);
    for (float& value : grey.floats()) value = 128 / 255.0f;
    const std::string plain = encode_png("", grey);
    const auto light = [&](const std::string& png, PictureSpace space = PictureSpace::srgb) {
        test::write_text(folder / "a.png", png);
        return read_picture(folder / "a.png", space).at(1, 1, 0);
    };
    EXPECT_FLOAT_EQ(light(plain), float(decode_srgb(128 / 255.0)));
    EXPECT_FLOAT_EQ(light(test::png_with_chunk(plain, "gAMA", kGamma1)), 128 / 255.0f);
    EXPECT_FLOAT_EQ(light(test::png_with_chunk(plain, "gAMA", png_number(50000))),
                    float(std::pow(128 / 255.0, 2)));
    EXPECT_FLOAT_EQ(light(test::png_with_chunk(plain, "cHRM", kWide), PictureSpace::data), 128 / 255.0f);
    for (const auto& [type, data] : {std::pair{std::string("cHRM"), kWide}, {"cICP", {9, 16, 0, 1}}})
        EXPECT_THROW(light(test::png_with_chunk(plain, type, data)), Error) << type;
}

TEST(PngColor, IsNotAppliedToDataAndThatIsSaid) {
    const test::TemporaryFolder folder;
    const std::string plain = encode_png("", Image(2, 2, 1));
    const auto note = [&](const std::string& bytes) {
        test::write_text(folder / "a.png", bytes);
        const auto color = read_png_color(folder / "a.png");
        return color ? color->note_of_data() : "no PNG";
    };
    const std::string end = " is not applied: the numbers of data are read as they are stored";
    EXPECT_EQ(note(plain), "");
    EXPECT_EQ(note(test::png_with_chunk(plain, "gAMA", kGamma22)), "");
    EXPECT_EQ(note(test::png_with_chunk(plain, "gAMA", kGamma1)), "its gAMA 1" + end);
    EXPECT_EQ(note(test::png_with_chunk(plain, "cICP", {9, 16, 0, 1})), "its cICP 9 16 0 1" + end);
    EXPECT_EQ(note(test::png_with_chunk(plain, "iCCP", iccp(icc_profile(power(1)))))
                  .find("its ICC profile 'my screen'"),
              0u);
    EXPECT_EQ(note(plain.substr(0, 50)), "no PNG") << "cut off";
    EXPECT_EQ(note("xxxx" + plain.substr(4)), "no PNG");
    EXPECT_FALSE(read_png_color(folder / "none.png"));
    EXPECT_FALSE(read_png_color(folder.path()));
}

TEST(Png, SaysThatItIsSrgbWhereItIs) {
    const test::TemporaryFolder folder;
    const Image grey(2, 2, 3);
    const std::string chunk = png_number(1) + "sRGB" + std::string(1, '\0');
    EXPECT_EQ(encode_png("", grey).find("sRGB"), std::string::npos);
    // PNG specification, 5.6: before the pixels.
    EXPECT_EQ(encode_png("", grey, {{"Title", "x"}}, {.display = kSrgbDisplay}).find(chunk), 8u + 25u);
}

TEST(Png, CarriesTheEncodingOfItsDisplay) {
    using Curve = ColorEncoding::Curve;
    const Chromaticities rec2020 = *color_space_primaries("rec2020"), p3 = *color_space_primaries("p3d65");
    const test::TemporaryFolder folder;
    struct Written {
        ColorEncoding encoding;
        std::string cicp;
        bool has_gamma;
    };
    for (const auto& [encoding, cicp, has_gamma] :
         {Written{{rec2020, Curve::pq, 1}, {9, 16, 0, 1}, false},
          Written{{rec2020, Curve::hlg, 1}, {9, 18, 0, 1}, false},
          Written{{kRec709, Curve::gamma, 2.4}, {1, 1, 0, 1}, true},
          Written{{p3, Curve::srgb, 1}, {12, 13, 0, 1}, true}, Written{{p3, Curve::gamma, 2.6}, "", true}}) {
        const std::string file = encode_png("", Image(2, 2, 3), {}, {.display = encoding});
        test::write_text(folder / "a.png", file);
        EXPECT_EQ(file.find("cICP") != std::string::npos, !cicp.empty());
        if (!cicp.empty()) EXPECT_NE(file.find("cICP" + cicp), std::string::npos);
        EXPECT_EQ(file.find("gAMA") != std::string::npos, has_gamma);
        EXPECT_NE(file.find("cHRM"), std::string::npos);
        const PngColor color = read_png_color(folder / "a.png").value();
        EXPECT_EQ(color.encoding->primaries, encoding.primaries) << cicp;
        EXPECT_EQ(color.encoding->curve, encoding.curve);
        EXPECT_NEAR(color.encoding->gamma, encoding.gamma, 1e-3);
    }
    EXPECT_FALSE(color_of({{"cICP", {9, 16, 0, 0}}}).encoding) << "of a part of the range";
    EXPECT_FALSE(color_of({{"iCCP", iccp(icc_profile(power(1)))}}).encoding);
}

}  // namespace
}  // namespace aftershade
