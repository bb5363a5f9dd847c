#include "framework/run/output.h"
#include "framework/image/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "framework/base/error.h"
#include "framework/file/exr_file.h"
#include "framework/file/png_file.h"
#include "framework/file/stored_colors.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

Sequence sequence_of(const std::string& pattern, std::vector<int> frames) {
    Sequence sequence;
    sequence.files = FramePattern(pattern);
    sequence.frames = std::move(frames);
    return sequence;
}

std::string faults(const OutputOptions& options, const Sequence& sequence) {
    Diagnostics diagnostics;
    InputFiles inputs;
    inputs.add(files_of_sequence(sequence));
    check_outputs(options, sequence, inputs, diagnostics);
    std::ostringstream text;
    diagnostics.print(text);
    return text.str();
}

TEST(CheckOutputs, AcceptsBothFormatsInAnyCase) {
    EXPECT_EQ(faults({{"a.exr", "b.png", "C.EXR", "d.PNG"}}, sequence_of("in.exr", {1})), "");
    EXPECT_EQ(faults({{"a_####.exr", "b_%04d.png"}}, sequence_of("in_####.exr", {1, 2})), "");
}

TEST(CheckOutputs, ListsEveryFault) {
    EXPECT_EQ(faults({{"a.tif", "b"}, {"colour", "depth", "depth"}}, sequence_of("in_####.exr", {1, 2})),
              "path a.tif: error: the format '.tif' is not known; outputs end in .exr or .png\n"
              "path a.tif: error: 2 frames cannot share one file; write the number as #### or %04d\n"
              "path b: error: the format '' is not known; outputs end in .exr or .png\n"
              "path b: error: 2 frames cannot share one file; write the number as #### or %04d\n"
              "roles colour: error: not a role; did you mean 'color'?\n"
              "roles depth: error: this role is named twice\n");
}

TEST(CheckOutputs, RefusesTwoPatternsForOneFile) {
    EXPECT_EQ(faults({{"a_####.exr", "./a_%04d.exr"}}, sequence_of("in_####.exr", {1, 2})),
              "path ./a_%04d.exr: error: another output has this name\n");
}

TEST(CheckOutputs, RefusesAnInputOfAnyFrameAndByAnyPath) {
    const TemporaryFolder folder;
    for (const char* name : {"in_1.exr", "in_2.exr"}) write_text(folder / name, "");
    fs::create_symlink("in_2.exr", folder / "link.exr");
    fs::create_directory(folder / "sub");
    const Sequence sequence = sequence_of((folder / "in_#.exr").string(), {1, 2});
    for (const char* name : {"in_#.exr", "in_%d.exr", "sub/../in_@.exr"})
        EXPECT_NE(faults({{(folder / name).string()}}, sequence).find("would replace the input"),
                  std::string::npos)
            << name;
    const Sequence one = sequence_of((folder / "link.exr").string(), {1});
    EXPECT_NE(faults({{(folder / "in_2.exr").string()}}, one).find("would replace the input"),
              std::string::npos);
    EXPECT_EQ(faults({{(folder / "in_1.exr").string()}}, one), "");
    // Not there yet, but it would be: a missing frame of a range.
    EXPECT_NE(faults({{(folder / "in_#.exr").string()}}, sequence_of((folder / "in_#.exr").string(), {3})),
              "");
}

TEST(WantedRoles, AreThoseOfExrAndDisplayForPictures) {
    using Roles = std::vector<std::string>;
    EXPECT_EQ(wanted_roles({{"a.exr"}}), Roles{"color"});
    EXPECT_EQ(wanted_roles({{"a.png"}, {"depth"}}), (Roles{"color", "display"}));
    EXPECT_EQ(wanted_roles({{"a.png"}}, true), Roles{"display"});
    EXPECT_EQ(wanted_roles({{"a.png", "b.exr"}}, true), (Roles{"color", "display"}));
    EXPECT_EQ(wanted_roles({{"a.exr", "b.png"}, {"depth", "color"}}), (Roles{"color", "depth", "display"}));
}

TEST(EncodeSrgb, FollowsTheStandardInDoublePrecision) {
    for (int i = 0; i <= 4096; ++i) {
        const float linear = float(i) / 4096;
        const double expected =
            linear <= 0.0031308f ? 12.92 * double(linear) : 1.055 * std::pow(double(linear), 1 / 2.4) - 0.055;
        EXPECT_NEAR(encode_srgb(linear), expected, 1e-6) << linear;
    }
}

class Write : public testing::Test {
protected:
    /// The paths written, without the folder.
    std::vector<std::string> write(const std::vector<std::string>& patterns,
                                   const std::vector<std::string>& roles = {"color"}) {
        OutputOptions options;
        for (const std::string& pattern : patterns) options.patterns.push_back((folder_ / pattern).string());
        options.roles = roles;
        options.look = "look.json";
        for (const auto& [tap, pattern] : tap_patterns_)
            options.tap_patterns[tap] = (folder_ / pattern).string();
        std::vector<std::string> names;
        for (const fs::path& path : write_outputs(options, result_, capture_, reader_).paths) {
            EXPECT_TRUE(fs::is_regular_file(path)) << path;
            names.push_back(fs::relative(path, folder_.path()).string());
        }
        return names;
    }
    Image read(const std::string& name, const std::vector<std::string>& channels) {
        return ExrFile(folder_ / name).read_floats(0, channels);
    }

    TemporaryFolder folder_;
    Capture capture_ =
        make_capture({.width = 6, .height = 4, .background = {0.25f, 0.5f, 0.75f}, .background_depth_m = 3});
    FrameResult result_;
    std::map<std::string, std::string> tap_patterns_;
    Sequence sequence_;
    CaptureReader reader_{sequence_, {}, {}};
};

TEST_F(Write, TakesARoleFromTheStepsElseFromTheCapture) {
    result_.images["color"] = Image(6, 4, 4);
    result_.images["color"].at(5, 3, 2) = 8;
    write({"out.exr"}, {"color", "depth"});
    EXPECT_EQ(read("out.exr", {"B"}).at(5, 3, 0), 8);
    EXPECT_EQ(read("out.exr", {"B"}).at(0, 0, 0), 0);
    EXPECT_EQ(read("out.exr", {"Z"}).at(0, 0, 0), 3);
}

TEST_F(Write, NamesARoleThatIsNowhere) {
    capture_.images.erase("velocity");
    capture_.header.roles = {"color", "depth"};
    try {
        write({"out.exr"}, {"color", "velocity"});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        EXPECT_STREQ(error.what(),
                     "synthetic: the role 'velocity', requested in the output, is in neither the capture nor "
                     "the look; the capture has 'color' and 'depth'");
    }
    EXPECT_EQ(folder_.file_count(), 0u);
}

TEST_F(Write, PrefersDisplayToColorForPictures) {
    result_.images["color"] = Image(6, 4, 4);
    write({"color.png"});
    EXPECT_EQ(read_png(folder_ / "color.png").channels(), 4) << "color without coverage";
    result_.images["display"] = Image(6, 4, 4);
    for (float& value : result_.images["display"].floats()) value = 1;
    write({"display.png"});
    const Image picture = read_png(folder_ / "display.png");
    EXPECT_EQ(picture.channels(), 3);
    EXPECT_EQ(picture.at(3, 2, 1), 1) << "display is not encoded a second time";
}

TEST_F(Write, GivesPngTheEncodingOfTheDisplayAndPqAndHlg16Bits) {
    result_.images["display"] = Image(6, 4, 4);
    result_.display_encoding = {*color_space_primaries("rec2020"), ColorEncoding::Curve::pq, 1};
    write({"out.png"});
    const PngColor color = read_png_color(folder_ / "out.png").value();
    EXPECT_EQ(color.encoding, result_.display_encoding);
    EXPECT_EQ(color.bits, 16);
    result_.display_encoding = kSrgbDisplay;
    write({"out.png"});
    EXPECT_EQ(read_png_color(folder_ / "out.png")->bits, 8);
}

TEST_F(Write, NamesTheSpaceThatAStepConvertedColorTo) {
    const auto attributes = [&] {
        write({"out.exr"});
        return ExrFile(folder_ / "out.exr").parts().at(0).metadata;
    };
    result_.color_encoding = {*color_space_primaries("acescg"), ColorEncoding::Curve::linear, 1};
    EXPECT_EQ(stored_colors(attributes(), attributes()).meaning(), "acescg");
    EXPECT_EQ(stored_primaries(attributes()), result_.color_encoding->primaries);
    result_.color_encoding = {kRec709, ColorEncoding::Curve::unknown, 1};
    EXPECT_EQ(attributes().text("colorInteropID"), "unknown");
    EXPECT_FALSE(attributes().value("chromaticities"));
}

TEST_F(Write, DividesAlphaOutBeforeItEncodes) {
    Image& color = capture_.images["color"];
    const float texel[] = {0.1f, 0.2f, 0.05f, 0.5f}, glow[] = {0.3f, 0.3f, 0.3f, 0};
    for (int c = 0; c < 4; ++c) {
        color.at(1, 1, c) = texel[c];
        color.at(2, 1, c) = glow[c];
    }
    write({"out.png"});
    const Image picture = read_png(folder_ / "out.png");
    ASSERT_EQ(picture.channels(), 4);
    const auto encoded = [](double linear) { return 1.055 * std::pow(linear, 1 / 2.4) - 0.055; };
    EXPECT_NEAR(picture.at(1, 1, 0), encoded(0.2), 0.501 / 255);
    EXPECT_NEAR(picture.at(1, 1, 1), encoded(0.4), 0.501 / 255);
    EXPECT_NEAR(picture.at(1, 1, 3), 0.5, 0.501 / 255);
    // Light without coverage has nothing to divide by.
    EXPECT_NEAR(picture.at(2, 1, 0), encoded(0.3), 0.501 / 255);
    EXPECT_EQ(picture.at(2, 1, 3), 0);
}

TEST_F(Write, LeavesWhatLiesOutsideTheDataWindowTransparent) {
    capture_.header.data_window = {-2, 1, 3, 4};
    capture_.header.display_window = {0, 0, 7, 5};
    write({"out.png"});
    const Image picture = read_png(folder_ / "out.png");
    ASSERT_EQ(picture.width(), 8);
    ASSERT_EQ(picture.height(), 6);
    ASSERT_EQ(picture.channels(), 4);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x)
            EXPECT_EQ(picture.at(x, y, 3), capture_.header.data_window.contains(x, y) ? 1 : 0)
                << x << ", " << y;
}

TEST_F(Write, NamesTapsAfterTheFirstOutputTheStepTheTextureAndTheFrame) {
    result_.taps["bokeh.coc"] = Image(6, 4, 1);
    struct Case {
        const char* pattern;
        int frame;
        const char* tap;
    };
    for (const Case& c : {Case{"out.exr", 5, "out.bokeh.coc.0005.exr"},
                          {"out_####.exr", 4, "out.bokeh.coc.0004.exr"},
                          {"out.%04d.exr", 40, "out.bokeh.coc.0040.exr"},
                          {"take10_####.exr", 3, "take10.bokeh.coc.0003.exr"},
                          {"take10####.exr", 0, "take10.bokeh.coc.0000.exr"},
                          {"v1_####_v1.exr", 1, "v1_v1.bokeh.coc.0001.exr"},
                          {"####_v1.exr", 1, "v1.bokeh.coc.0001.exr"},
                          {"####.exr", 12345, "bokeh.coc.12345.exr"},
                          {"@.exr", 7, "bokeh.coc.0007.exr"},
                          {"out_####.exr", -3, "out.bokeh.coc.-003.exr"},
                          {"still.png", 2, "still.bokeh.coc.0002.exr"}}) {
        capture_.header.frame = c.frame;
        const auto written = write({c.pattern, "second_####.png"});
        ASSERT_EQ(written.size(), 3u);
        EXPECT_EQ(written[2], c.tap) << c.pattern;
    }
}

TEST_F(Write, GivesATapOfAnotherSizeWindowsOfItsOwn) {
    capture_.header.data_window = {2, 1, 7, 4};
    capture_.header.display_window = {0, 0, 9, 9};
    result_.taps["a.same"] = Image(6, 4, 4);
    result_.taps["a.tiles"] = Image(2, 1, 2);
    write({"out.exr"});
    const ExrFile same(folder_ / "out.a.same.0001.exr"), tiles(folder_ / "out.a.tiles.0001.exr");
    EXPECT_EQ(same.parts()[0].data_window, (Window{2, 1, 7, 4}));
    EXPECT_EQ(same.parts()[0].display_window, (Window{0, 0, 9, 9}));
    EXPECT_EQ(tiles.parts()[0].data_window, (Window{0, 0, 1, 0}));
    EXPECT_EQ(tiles.parts()[0].display_window, (Window{0, 0, 1, 0}));
}

TEST_F(Write, DrawsASignedTapInBlueAndRedAroundWhiteWhereAPngIsNamed) {
    Image& coc = result_.taps["bokeh.coc"] = Image(6, 4, 1);
    coc.at(1, 2, 0) = -8;
    coc.at(2, 2, 0) = 8;
    coc.at(3, 2, 0) = -4;
    tap_patterns_["bokeh.coc"] = "coc_####.png";
    const auto written = write({"out.exr"});
    ASSERT_EQ(written.size(), 2u);
    EXPECT_EQ(written[1], "coc_0001.png");
    const Image picture = read_png(folder_ / "coc_0001.png");
    const auto rgb = [&](int x) {
        std::array<long, 3> bytes{};
        for (int c = 0; c < 3; ++c) bytes[std::size_t(c)] = std::lround(picture.at(x, 2, c) * 255);
        return bytes;
    };
    EXPECT_EQ(rgb(0), (std::array<long, 3>{0xf7, 0xf7, 0xf7}));
    EXPECT_EQ(rgb(1), (std::array<long, 3>{0x21, 0x66, 0xac}));
    EXPECT_EQ(rgb(2), (std::array<long, 3>{0xb2, 0x18, 0x2b}));
    EXPECT_EQ(rgb(3), (std::array<long, 3>{0x92, 0xc5, 0xde}));
}

TEST_F(Write, StoresTapsWithoutLoss) {
    Image& values = result_.taps["a.values"] = Image(6, 4, 2);
    values.at(1, 2, 0) = 1.2345678e-20f;
    values.at(1, 2, 1) = -3e30f;
    Image& ids = result_.taps["a.ids"] = Image(6, 4, 1, ComponentType::uint32);
    ids.uint_at(5, 3, 0) = 4'000'000'001u;
    write({"out.exr"});
    const Image stored = read("out.a.values.0001.exr", {"R", "G"});
    EXPECT_EQ(stored.at(1, 2, 0), 1.2345678e-20f);
    EXPECT_EQ(stored.at(1, 2, 1), -3e30f);
    const std::vector<std::string> y{"Y"};
    EXPECT_EQ(ExrFile(folder_ / "out.a.ids.0001.exr").read_uints(0, y).uint_at(5, 3, 0), 4'000'000'001u);
}

}  // namespace
}  // namespace aftershade::test
