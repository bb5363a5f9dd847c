#include "framework/compare/compare_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/compare/pictures.h"
#include "tests/not_finite.h"
#include "tests/real_captures.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using test::constant;
using test::kInfinity;
using test::kNan;

class CompareFiles : public testing::Test {
protected:
    /// Two files of one float channel "V".
    Comparison values(const Image& reference, const Image& test, const CompareRules& rules = {}) {
        test::write_exr_file(folder_ / "r.exr", {{{"V"}, reference}});
        test::write_exr_file(folder_ / "t.exr", {{{"V"}, test}});
        return compare_files(folder_ / "r.exr", folder_ / "t.exr", rules);
    }
    Comparison files(const CompareRules& rules = {}) {
        return compare_files(folder_ / "r.exr", folder_ / "t.exr", rules);
    }
    void write(const char* name, const std::vector<test::Channels>& layers, Window data = {},
               Window display = {}) {
        test::write_exr_file(folder_ / name, layers, data, display);
    }
    test::TemporaryFolder folder_;
};

/// `failing` of 100 pixels differ by `by`.
Image some_differ(int failing, float by) {
    Image image(10, 10, 1);
    for (int i = 0; i < failing; ++i) image.at(i % 10, i / 10, 0) = by;
    return image;
}

TEST_F(CompareFiles, FindThemselvesTheSame) {
    const std::string suzanne = AFTERSHADE_SOURCE_DIR "/scenes/suzanne/gbuffer_0003.exr";
    const Comparison comparison = compare_files(suzanne, suzanne, {});
    EXPECT_EQ(comparison.verdict, Verdict::same);
    EXPECT_EQ(comparison.layers.size(), 10);
    for (const LayerComparison& layer : comparison.layers) {
        EXPECT_TRUE(layer.differences.bits_equal) << layer.label;
        if (!is_perceptual(layer.role)) continue;
        EXPECT_EQ(layer.hdr_flip->mean, 0) << layer.label;
        EXPECT_EQ(*layer.ssim, 1) << layer.label;
    }
}

TEST_F(CompareFiles, FailAboveOneInAMillionByDefault) {
    EXPECT_EQ(values(constant(3, 3, {1}), constant(3, 3, {1.00002f})).verdict, Verdict::failure);
    EXPECT_EQ(values(constant(3, 3, {1}), constant(3, 3, {1.0000005f})).verdict, Verdict::same);
}

TEST_F(CompareFiles, LetThePercentPassAndWarnOfIt) {
    CompareRules rules;
    rules.fail.percent = 5;
    const Image none = some_differ(0, 0);
    EXPECT_EQ(values(none, some_differ(6, 1), rules).verdict, Verdict::failure);
    EXPECT_EQ(values(none, some_differ(5, 1), rules).verdict, Verdict::warning) << "as idiff's";
    rules.warn = Tolerance{.percent = 5};
    EXPECT_EQ(values(none, some_differ(5, 1), rules).verdict, Verdict::same);
}

TEST_F(CompareFiles, AllowSomeFailuresOfAnyAmount) {
    CompareRules rules;
    rules.fail.allowed = 3;
    rules.fail.hard = 0.5;
    const Image none = some_differ(0, 0);
    EXPECT_EQ(values(none, some_differ(3, 9), rules).verdict, Verdict::same);
    EXPECT_EQ(values(none, some_differ(4, 9), rules).verdict, Verdict::failure);
}

TEST_F(CompareFiles, LookAtHardFailBelowFailToo) {
    // idiff 2.4.7 passes both: it looks at -hardfail only where a pixel exceeds -fail.
    CompareRules rules;
    rules.fail = {.limit = 2000, .percent = 100, .hard = 1};
    EXPECT_EQ(values(some_differ(0, 0), some_differ(1, 1025), rules).verdict, Verdict::failure);
    rules.fail.percent = 0;
    EXPECT_EQ(values(some_differ(0, 0), some_differ(1, 1025), rules).verdict, Verdict::failure);
}

TEST_F(CompareFiles, WarnWhereNothingFails) {
    // idiff 2.4.7 passes: no pixel exceeds -fail.
    CompareRules rules;
    rules.fail.limit = 1e30;
    rules.warn = Tolerance{.limit = 0.001};
    EXPECT_EQ(values(some_differ(0, 0), some_differ(1, 0.01f), rules).verdict, Verdict::warning);
    rules.warn = Tolerance{.limit = 1, .hard = 0.005};
    EXPECT_EQ(values(some_differ(0, 0), some_differ(1, 0.01f), rules).verdict, Verdict::warning);
}

TEST_F(CompareFiles, FailOnNanWhateverTheLimit) {
    CompareRules rules;
    rules.fail = {.limit = kInfinity, .hard = kInfinity};
    EXPECT_EQ(values(some_differ(1, kNan), some_differ(1, kNan), rules).verdict, Verdict::failure);
    EXPECT_EQ(values(some_differ(0, 0), some_differ(1, kNan), rules).verdict, Verdict::failure);
    rules.nan_equal = true;
    EXPECT_EQ(values(some_differ(1, kNan), some_differ(1, kNan), rules).verdict, Verdict::same);
    EXPECT_EQ(values(some_differ(0, 0), some_differ(1, kNan), rules).verdict, Verdict::failure);
}

TEST_F(CompareFiles, OfDifferentSizeAreMeasuredWhereBothHavePixels) {
    const Comparison comparison = values(constant(10, 8, {1}), constant(7, 9, {1}));
    EXPECT_EQ(comparison.verdict, Verdict::different_size);
    ASSERT_EQ(comparison.layers.size(), 1);
    const LayerComparison& layer = comparison.layers[0];
    EXPECT_EQ(layer.differences.pixels, 7 * 8);
    EXPECT_EQ(layer.absent_in_test, 80 - 56);
    EXPECT_EQ(layer.absent_in_reference, 63 - 56);
    EXPECT_EQ(layer.differences.failing.count, 0);
}

TEST_F(CompareFiles, LineUpDataWindows) {
    // The same picture, of which the test image has a part: pixels are where the windows say.
    const auto value = [](int x, int y) { return test::hashed(x, y, 0, 3); };
    const Image whole = test::picture(20, 10, 1, [&](int x, int y, int) { return value(x, y); });
    const Image part = test::picture(6, 5, 1, [&](int x, int y, int) { return value(x + 4, y + 2); });
    write("r.exr", {{{"V"}, whole}}, {-5, 3, 14, 12}, {0, 0, 9, 9});
    write("t.exr", {{{"V"}, part}}, {-1, 5, 4, 9}, {0, 0, 9, 9});
    const Comparison comparison = files();
    EXPECT_EQ(comparison.verdict, Verdict::different_size);
    const LayerComparison& layer = comparison.layers.at(0);
    EXPECT_EQ(layer.window, (Window{-1, 5, 4, 9}));
    EXPECT_EQ(layer.differences.failing.count, 0);
    EXPECT_EQ(layer.absent_in_test, 200 - 30);
    EXPECT_EQ(layer.absent_in_reference, 0);
}

TEST_F(CompareFiles, OfCroppedDataWindowsAreTheSameWhereOutsideIsFilled) {
    Image rgb(10, 10, 3), depth = constant(10, 10, {kInfinity});
    for (int c = 0; c < 3; ++c) rgb.at(4, 5, c) = 1;
    depth.at(4, 5, 0) = 3;
    const Image one = constant(1, 1, {1, 1, 1}), near = constant(1, 1, {3});
    write("r.exr", {{{"R", "G", "B"}, rgb}, {{"Z"}, depth}});
    write("t.exr", {{{"R", "G", "B"}, one}, {{"Z"}, near}}, {4, 5, 4, 5}, {0, 0, 9, 9});
    EXPECT_EQ(files().verdict, Verdict::different_size);
    CompareRules rules;
    rules.fill_outside = true;
    const Comparison comparison = files(rules);
    EXPECT_EQ(comparison.verdict, Verdict::same);
    EXPECT_EQ(comparison.layers.at(0).differences.pixels, 100);
    EXPECT_EQ(comparison.layers.at(0).absent_in_test, 99);
    write("t.exr", {{{"R", "G", "B"}, one}, {{"Z"}, near}}, {5, 5, 5, 5}, {0, 0, 9, 9});
    EXPECT_EQ(files(rules).verdict, Verdict::failure) << "the pixel is elsewhere";
    write("t.exr", {{{"R", "G", "B"}, one}, {{"Z"}, near}}, {1000000000, 5, 1000000000, 5}, {0, 0, 9, 9});
    EXPECT_GE(files(rules).verdict, Verdict::different_size) << "too far away to be filled";
}

TEST_F(CompareFiles, WithoutACommonPixelAreOfDifferentSize) {
    write("r.exr", {{{"V"}, constant(2, 2, {1})}}, {0, 0, 1, 1}, {0, 0, 9, 9});
    write("t.exr", {{{"V"}, constant(2, 2, {1})}}, {5, 5, 6, 6}, {0, 0, 9, 9});
    const Comparison comparison = files();
    EXPECT_EQ(comparison.verdict, Verdict::different_size);
    EXPECT_EQ(comparison.layers.at(0).differences.pixels, 0);
}

TEST_F(CompareFiles, OfDifferentDisplayWindowsAreNotTheSame) {
    write("r.exr", {{{"V"}, constant(4, 4, {1})}}, {0, 0, 3, 3}, {0, 0, 9, 9});
    write("t.exr", {{{"V"}, constant(4, 4, {1})}}, {0, 0, 3, 3}, {0, 0, 3, 3});
    const Comparison comparison = files();
    EXPECT_EQ(comparison.verdict, Verdict::different_size);
    EXPECT_EQ(comparison.layers.at(0).differences.failing.count, 0);
}

TEST_F(CompareFiles, TellTheLayersAndChannelsThatOneHas) {
    write("r.exr", {{{"R", "G", "B"}, constant(4, 4, {1, 1, 1})}, {{"Z"}, constant(4, 4, {1})}});
    write("t.exr", {{{"R", "G", "B", "A"}, constant(4, 4, {1, 1, 1, 1})}});
    const Comparison comparison = files();
    EXPECT_EQ(comparison.verdict, Verdict::different_size);
    EXPECT_EQ(comparison.faults, (std::vector<std::string>{"layer 'Z' is only in the reference",
                                                           "layer 'A' is only in the test image"}));
    EXPECT_EQ(comparison.layers.size(), 1) << "what both have is compared";
    write("t.exr", {{{"R", "B"}, constant(4, 4, {1, 1})}, {{"Z"}, constant(4, 4, {1})}});
    EXPECT_EQ(files().faults, std::vector<std::string>{"channel 'G' is only in the reference"});
}

TEST_F(CompareFiles, DoNotCompareIntegersWithFloats) {
    write("r.exr", {{{"object_id.I"}, test::ids({1, 2})}});
    write("t.exr", {{{"object_id.I"}, test::row({1, 2})}});
    EXPECT_EQ(files().verdict, Verdict::different_size);
}

TEST_F(CompareFiles, DoNotCompareEncodedColoursWithLight) {
    const Image grey = constant(4, 4, {0.5f, 0.5f, 0.5f});
    test::write_rgb(folder_ / "r.exr", grey);
    write_png(folder_ / "t.png", grey);
    EXPECT_EQ(compare_files(folder_ / "r.exr", folder_ / "t.png", {}).verdict, Verdict::different_size);
    CompareRules rules;
    rules.roles["RGB"] = LayerRole::display;
    rules.fail.limit = 0.004;
    EXPECT_EQ(compare_files(folder_ / "r.exr", folder_ / "t.png", rules).verdict, Verdict::same);
}

TEST_F(CompareFiles, CompareByTheRoleGiven) {
    write("r.exr", {{{"Z"}, constant(4, 4, {100})}});
    write("t.exr", {{{"Z"}, constant(4, 4, {100.5f})}});
    CompareRules rules;
    rules.fail.limit = 0.01;
    EXPECT_EQ(files(rules).verdict, Verdict::same);
    rules.roles["Z"] = LayerRole::data;
    EXPECT_EQ(files(rules).verdict, Verdict::failure);
    rules.roles["Z"] = std::nullopt;
    EXPECT_TRUE(files(rules).layers.empty());
    rules.roles["ZZ"] = LayerRole::data;
    EXPECT_EQ(files(rules).unknown_roles, std::vector<std::string>{"ZZ"});
}

TEST_F(CompareFiles, LeaveAlphaOutOfWhatIsSeen) {
    const Image rgb = test::picture(32, 32, 3, [](int x, int y, int c) { return test::hashed(x, y, c, 1); });
    write("r.exr", {{{"R", "G", "B"}, rgb}, {{"A"}, constant(32, 32, {1})}});
    write("t.exr", {{{"R", "G", "B"}, rgb}, {{"A"}, constant(32, 32, {0})}});
    const Comparison comparison = files();
    EXPECT_EQ(comparison.verdict, Verdict::failure);
    for (const LayerComparison& layer : comparison.layers) {
        if (layer.label == "RGB") {
            EXPECT_EQ(layer.verdict, Verdict::same);
            EXPECT_EQ(layer.hdr_flip->mean, 0);
        } else {
            EXPECT_EQ(layer.label, "A");
            EXPECT_FALSE(layer.hdr_flip || layer.ldr_flip || layer.ssim);
        }
    }
}

TEST_F(CompareFiles, FailOnWhatIsSeen) {
    const Image black = constant(32, 32, {0, 0, 0}), white = constant(32, 32, {1, 1, 1});
    write_png(folder_ / "r.png", black);
    write_png(folder_ / "t.png", white);
    CompareRules rules;
    rules.fail.limit = 2;
    const auto verdict = [&] { return compare_files(folder_ / "r.png", folder_ / "t.png", rules).verdict; };
    EXPECT_EQ(verdict(), Verdict::same);
    rules.fail_flip = 0.5;
    EXPECT_EQ(verdict(), Verdict::failure);
    rules.fail_flip.reset();
    rules.warn_flip = 0.5;
    EXPECT_EQ(verdict(), Verdict::warning);
    rules.warn_flip.reset();
    rules.fail_ssim = 0.9;
    EXPECT_EQ(verdict(), Verdict::failure);
}

TEST_F(CompareFiles, OfOnePixelAreCompared) {
    for (const float value : {0.0f, 1.0f, kNan}) {
        test::write_rgb(folder_ / "r.exr", constant(1, 1, {0, 0, 0}));
        test::write_rgb(folder_ / "t.exr", constant(1, 1, {value, value, value}));
        const Comparison comparison = files();
        EXPECT_EQ(comparison.verdict, value == 0 ? Verdict::same : Verdict::failure) << value;
        EXPECT_EQ(comparison.layers.at(0).hdr_flip->mean > 0, value != 0) << value;
        EXPECT_FALSE(comparison.layers.at(0).ms_ssim) << "no five scales in one pixel";
    }
}

TEST_F(CompareFiles, ThatCannotBeReadAreFileErrors) {
    test::write_rgb(folder_ / "r.exr", constant(64, 64, {1, 1, 1}));
    EXPECT_EQ(files().verdict, Verdict::file_error);
    const std::string whole = test::read_text(folder_ / "r.exr");
    for (const double share : {0.02, 0.5, 0.99}) {
        // idiff 2.4.7 reads what is missing as zeros.
        test::write_text(folder_ / "t.exr", whole.substr(0, std::size_t(double(whole.size()) * share)));
        const Comparison comparison = files();
        EXPECT_EQ(comparison.verdict, Verdict::file_error) << share;
        ASSERT_EQ(comparison.faults.size(), 1);
        EXPECT_TRUE(comparison.faults[0].starts_with((folder_ / "t.exr").string())) << comparison.faults[0];
    }
    write_png(folder_ / "r.png",
              test::picture(64, 64, 3, [](int x, int y, int c) { return test::hashed(x, y, c, 1); }));
    const std::string png = test::read_text(folder_ / "r.png");
    test::write_text(folder_ / "t.png", png.substr(0, png.size() / 2));
    EXPECT_EQ(compare_files(folder_ / "r.png", folder_ / "t.png", {}).verdict, Verdict::file_error);
}

TEST_F(CompareFiles, ThatAreDamagedAreFileErrorsThoughNoLayerMatches) {
    write("r.exr", {{{"V"}, constant(8, 8, {1})}});
    write("t.exr",
          {{{"W"}, test::picture(64, 64, 1, [](int x, int y, int c) { return test::hashed(x, y, c, 1); })}});
    EXPECT_EQ(files().verdict, Verdict::different_size);
    const std::string whole = test::read_text(folder_ / "t.exr");
    test::write_text(folder_ / "t.exr", whole.substr(0, whole.size() - 100));
    EXPECT_EQ(files().verdict, Verdict::file_error);
}

TEST_F(CompareFiles, ThatAreDamagedEndCleanly) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "exr-damaged");
    test::write_rgb(folder_ / "r.exr", constant(8, 8, {1, 1, 1}));
    int files = 0;
    for (const auto& entry : fs::directory_iterator(*folder)) {
        const Comparison comparison = compare_files(folder_ / "r.exr", entry.path(), {});
        EXPECT_GE(comparison.verdict, Verdict::different_size) << entry.path();
        files += comparison.verdict == Verdict::file_error;
    }
    EXPECT_GT(files, 150);
}

TEST_F(CompareFiles, OfThePartsOfAMultiPartFileMatchByName) {
    AFTERSHADE_REQUIRE_CAPTURE(captures, "beachball");
    CompareRules rules;
    rules.flip_choice = FlipChoice::none;
    rules.ssim = false;
    const fs::path one = *captures / "multipart.0001.exr", two = *captures / "multipart.0002.exr";
    const Comparison same = compare_files(one, one, rules);
    EXPECT_EQ(same.verdict, Verdict::same);
    EXPECT_GE(same.layers.size(), 10u);
    EXPECT_NE(compare_files(one, two, rules).verdict, Verdict::same);
    // In one part the same channels have one data window.
    const fs::path single = *captures / "singlepart.0001.exr";
    const Comparison parts = compare_files(one, single, rules);
    EXPECT_EQ(parts.verdict, Verdict::different_size);
    EXPECT_TRUE(parts.faults.empty()) << parts.faults.front();
    EXPECT_EQ(parts.layers.size(), same.layers.size()) << "every layer is compared";
    rules.fill_outside = true;
    for (const LayerComparison& layer : compare_files(one, single, rules).layers) {
        if (layer.role == LayerRole::depth) continue;  // 0 outside of the windows here, infinite there
        EXPECT_EQ(layer.verdict, Verdict::same) << layer.label;
    }
}

TEST_F(CompareFiles, GiveTheSameFiguresOnAnyNumberOfThreads) {
    const fs::path scene = AFTERSHADE_SOURCE_DIR "/scenes/suzanne";
    CompareRules rules;
    std::vector<Comparison> found;
    for (const int threads : {1, 2, 5}) {
        rules.threads = threads;
        found.push_back(compare_files(scene / "gbuffer_0003.exr", scene / "gbuffer_0004.exr", rules));
    }
    for (std::size_t i = 0; i < found[0].layers.size(); ++i)
        for (const Comparison& other : found) {
            const LayerComparison &a = found[0].layers[i], &b = other.layers[i];
            EXPECT_EQ(a.differences.rmse, b.differences.rmse) << a.label;
            EXPECT_EQ(a.ssim, b.ssim) << a.label;
            EXPECT_EQ(a.ms_ssim, b.ms_ssim) << a.label;
            EXPECT_EQ(a.hdr_flip ? a.hdr_flip->mean : 0, b.hdr_flip ? b.hdr_flip->mean : 0) << a.label;
        }
}

}  // namespace
}  // namespace aftershade
