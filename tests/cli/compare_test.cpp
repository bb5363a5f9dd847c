#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "framework/compare/difference_rules.h"
#include "framework/file/exr_file.h"
#include "tests/cli/command.h"
#include "tests/compare/pictures.h"

namespace aftershade::test {
namespace {

using Json = nlohmann::json;

/// Two pictures of 32 x 24 px as r.exr and t.exr, r.png and t.png: t has 7 of 768 pixels 0.25 brighter.
class CompareCommand : public testing::Test {
protected:
    CompareCommand() {
        const Image reference =
            picture(32, 24, 3, [](int x, int y, int c) { return 0.5f * hashed(x, y, c, 1); });
        Image test = reference;
        for (int i = 0; i < 7; ++i)
            for (int c = 0; c < 3; ++c) test.at(3 * i + 2, i + 5, c) += 0.25f;
        write_rgb(folder_ / "r.exr", reference);
        write_rgb(folder_ / "t.exr", test);
        write_png(folder_ / "r.png", reference);
        write_png(folder_ / "t.png", test);
    }

    CommandResult compare(std::vector<std::string> words) {
        words.insert(words.begin(), "compare");
        // No GL is needed, and none is there.
        return run_aftershade(words, folder_.path(), without_gl(folder_ / "no_gl"));
    }
    int code(std::vector<std::string> words) {
        words.insert(words.begin(), {"r.exr", "t.exr"});
        return compare(words).exit_code;
    }
    Json json(std::vector<std::string> words) {
        words.push_back("--json");
        return Json::parse(compare(words).out);
    }
    TemporaryFolder folder_;
};

TEST_F(CompareCommand, EndsWithTheCodesOfIdiff) {
    EXPECT_EQ(compare({"r.exr", "r.exr"}).exit_code, 0);
    EXPECT_EQ(code({"--fail", "1", "--warn", "0.1"}), 1);
    EXPECT_EQ(code({}), 2);
    write_rgb(folder_ / "small.exr", constant(8, 8, {0, 0, 0}));
    EXPECT_EQ(compare({"r.exr", "small.exr"}).exit_code, 3);
    EXPECT_EQ(compare({"r.exr", "none.exr"}).exit_code, 4);
    EXPECT_EQ(compare({"none.exr", "r.exr"}).exit_code, 4);
}

TEST_F(CompareCommand, EndsWith64ForWrongWords) {
    EXPECT_EQ(compare({}).exit_code, 64);
    EXPECT_EQ(compare({"r.exr"}).exit_code, 64);
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"--fial", "1"},
                                               {"--fail", "x"},
                                               {"--fail", "-1"},
                                               {"--fail", "nan"},
                                               {"--failpercent", "101"},
                                               {"--allowfailures", "-1"},
                                               {"--flip", "maybe"},
                                               {"--tone-mapper", "acse"},
                                               {"--ppd", "0"},
                                               {"--viewing", "1", "2"},
                                               {"--viewing", "0.7", "3840", "0.7", "--ppd", "60"},
                                               {"--exposures", "0"},
                                               {"--start-exposure", "2", "--stop-exposure", "1"},
                                               {"--role", "RGB"},
                                               {"--role", "RGB=colour"},
                                               {"--role", "RGX=data"},
                                               {"-o", "d.jpg"},
                                               {"--side-by-side", "d.exr"},
                                               {"-o", "r.exr"},
                                               {"-o", "d.png", "--heat-map", "d.png"},
                                               {"--scale", "0"},
                                               {"--flip", "none", "--fail-flip", "0.1"},
                                               {"--no-ssim", "--fail-ssim", "0.9"}}) {
        std::vector<std::string> all = words;
        all.insert(all.begin(), {"r.exr", "t.exr"});
        const CommandResult result = compare(all);
        EXPECT_EQ(result.exit_code, 64) << words[0] << " " << words[1];
        EXPECT_NE(result.err, "") << words[0];
        EXPECT_EQ(result.out, "") << words[0];
    }
    EXPECT_NE(compare({"r.exr", "t.exr", "--tone-mapper", "acse"}).err.find("did you mean 'aces'"),
              std::string::npos);
    EXPECT_NE(compare({"r.exr", "t.exr", "--role", "RGX=data"}).err.find("did you mean 'RGB'"),
              std::string::npos);
}

TEST_F(CompareCommand, LetsTheLastPlacesOfHalfsPassAtEveryBrightnessAndNoRealChange) {
    // Light from 0.001 to 10,000 as halfs; noise of up to two units in the last place, then one pixel off by
    // 2 %.
    Image reference(64, 16, 3);
    const auto half = [](double value) {
        const double unit = kStoredHalf.unit_at(value);
        return float(std::round(value / unit) * unit);
    };
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) reference.at(x, y, c) = half(std::pow(10, x / 9.0 - 3) * (1 + c));
    Image noisy = reference;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c)
                noisy.at(x, y, c) += float((x + y + c) % 3 * kStoredHalf.unit_at(reference.at(x, y, c)));
    Image changed = noisy;
    changed.at(40, 3, 1) = half(reference.at(40, 3, 1) * 1.02);
    write_rgb_halfs(folder_ / "reference.exr", reference);
    write_rgb_halfs(folder_ / "noisy.exr", noisy);
    write_rgb_halfs(folder_ / "changed.exr", changed);
    const std::vector<std::string> limits = {"--fail", "1e-5", "--hardfail", "1e-4"};
    const auto code = [&](const char* test, std::vector<std::string> words) {
        words.insert(words.begin(), {"reference.exr", test});
        words.insert(words.end(), limits.begin(), limits.end());
        return compare(words).exit_code;
    };
    EXPECT_EQ(code("noisy.exr", {}), 2);
    EXPECT_EQ(code("noisy.exr", {"--fail-ulp", "1"}), 2);
    EXPECT_EQ(code("noisy.exr", {"--fail-ulp", "2"}), 0);
    EXPECT_EQ(code("changed.exr", {"--fail-ulp", "2"}), 2);
    EXPECT_EQ(code("noisy.exr", {"--fail-ulp", "-1"}), 64);
    // The coarser of both files counts.
    write_rgb(folder_ / "noisy.exr", noisy);
    EXPECT_EQ(code("noisy.exr", {"--fail-ulp", "2"}), 0);
    write_rgb(folder_ / "reference.exr", reference);
    EXPECT_EQ(code("noisy.exr", {"--fail-ulp", "2"}), 2);
}

TEST_F(CompareCommand, KnowsEachTolerance) {
    const std::string percent = "0.92";  // 7 of 768 are 0.9115 %
    EXPECT_EQ(code({"--fail", "0.3"}), 0);
    EXPECT_EQ(code({"--fail", "0.2"}), 2);
    EXPECT_EQ(code({"--failpercent", percent}), 1) << "what percent lets pass warns";
    EXPECT_EQ(code({"--failpercent", percent, "--warnpercent", percent}), 0);
    EXPECT_EQ(code({"--failpercent", "0.9"}), 2);
    EXPECT_EQ(code({"--fail", "1", "--hardfail", "0.2"}), 2) << "below --fail";
    EXPECT_EQ(code({"--failpercent", "100", "--hardfail", "0.2"}), 2);
    EXPECT_EQ(code({"--allowfailures", "7"}), 0);
    EXPECT_EQ(code({"--allowfailures", "7", "--hardfail", "0.1"}), 0);
    EXPECT_EQ(code({"--allowfailures", "6"}), 2);
    EXPECT_EQ(code({"--fail", "1e30", "--warn", "0.001"}), 1);
    EXPECT_EQ(code({"--fail", "1", "--warn", "0.001", "--warnpercent", "0.9"}), 1);
    EXPECT_EQ(code({"--fail", "1", "--warn", "0.001", "--warnpercent", percent}), 0);
    EXPECT_EQ(code({"--fail", "1", "--hardwarn", "0.2"}), 1);
    EXPECT_EQ(code({"--fail", "1", "--hardwarn", "0.3"}), 0);
    EXPECT_EQ(code({"--fail", "1", "--warn", "0.001", "--allowwarnings", "7"}), 0);
    EXPECT_EQ(code({"--fail", "1", "--warn", "0.001", "--allowwarnings", "6"}), 1);
    EXPECT_EQ(code({"--fail", "1", "--fail-flip", "1e-4"}), 2);
    EXPECT_EQ(code({"--fail", "1", "--warn-flip", "1e-4"}), 1);
    EXPECT_EQ(code({"--fail", "1", "--fail-flip", "0.5"}), 0);
    EXPECT_EQ(code({"--fail", "1", "--fail-ssim", "0.9999"}), 2);
    EXPECT_EQ(code({"--fail", "1", "--warn-ssim", "0.9999"}), 1);
    EXPECT_EQ(code({"--fail", "1", "--fail-ssim", "0.5"}), 0);
    EXPECT_EQ(code({"--role", "RGB=ignore"}), 3) << "nothing is left to compare";
}

TEST_F(CompareCommand, TakesNanForEqualOnlyWhenAsked) {
    write_rgb(folder_ / "n.exr", constant(4, 4, {kNan, 1, 1}));
    EXPECT_EQ(compare({"n.exr", "n.exr"}).exit_code, 2);
    EXPECT_EQ(compare({"n.exr", "n.exr", "--nan-equal"}).exit_code, 0);
}

TEST_F(CompareCommand, TellsEverythingAsJson) {
    const CommandResult result = compare({"r.exr", "t.exr", "--json", "--fail", "0.1"});
    EXPECT_NE(result.err.find("7 pixels"), std::string::npos) << "people read stderr then";
    const Json document = Json::parse(result.out);
    EXPECT_EQ(document["verdict"], "failure");
    EXPECT_EQ(document["exit_code"], 2);
    const Json& layer = document["layers"].at(0);
    EXPECT_EQ(layer["layer"], "RGB");
    EXPECT_EQ(layer["role"], "color");
    EXPECT_EQ(layer["failing"]["pixels"], 7);
    EXPECT_NEAR(layer["failing"]["percent"].get<double>(), 100 * 7 / 768.0, 1e-9);
    EXPECT_EQ(layer["failing"]["box"], Json::parse(R"({"min": [2, 5], "max": [20, 11]})"));
    EXPECT_NEAR(layer["max_error"]["value"].get<double>(), 0.25, 1e-6);
    EXPECT_NEAR(layer["rmse"].get<double>(), 0.25 * std::sqrt(7 / 768.0), 1e-7);
    EXPECT_EQ(layer["hdr_flip"]["tone_mapper"], "aces");
    EXPECT_TRUE(layer["ldr_flip"].is_null());
    EXPECT_TRUE(layer["ms_ssim"].is_null()) << "too small for five scales";
    EXPECT_EQ(document["rules"]["fail"]["hard"], "inf");
    EXPECT_EQ(json({"r.exr", "r.exr"})["layers"][0]["psnr_db"], "inf");
    EXPECT_EQ(json({"r.png", "t.png"})["layers"][0]["role"], "display");
    EXPECT_TRUE(json({"r.png", "t.png"})["layers"][0]["ldr_flip"].is_object());
    EXPECT_TRUE(json({"r.png", "t.png", "--flip", "both"})["layers"][0]["hdr_flip"].is_object());
}

TEST_F(CompareCommand, TellsOfFilesThatCannotBeReadAsJson) {
    const Json document = json({"r.exr", "none.exr"});
    EXPECT_EQ(document["verdict"], "file error");
    EXPECT_EQ(document["exit_code"], 4);
    EXPECT_EQ(document["faults"].size(), 1);
}

TEST_F(CompareCommand, TellsPlacesInTheFilesPixels) {
    const Image reference = constant(6, 6, {0});
    Image test = reference;
    test.at(1, 4, 0) = 1;
    write_exr_file(folder_ / "a.exr", {{{"V"}, reference}}, {10, -20, 15, -15}, {0, 0, 99, 99});
    write_exr_file(folder_ / "b.exr", {{{"V"}, test}}, {10, -20, 15, -15}, {0, 0, 99, 99});
    const Json layer = json({"a.exr", "b.exr"})["layers"][0];
    EXPECT_EQ(layer["max_error"]["x"], 11);
    EXPECT_EQ(layer["max_error"]["y"], -16);
    EXPECT_EQ(layer["failing"]["box"], Json::parse(R"({"min": [11, -16], "max": [11, -16]})"));
}

TEST_F(CompareCommand, WritesALineForEachLayer) {
    EXPECT_EQ(compare({"r.exr", "t.exr", "--csv", "d.csv"}).exit_code, 2);
    const std::vector<std::string> lines = lines_of_text(read_text(folder_ / "d.csv"));
    ASSERT_EQ(lines.size(), 2);
    EXPECT_EQ(std::ranges::count(lines[0], ','), std::ranges::count(lines[1], ','));
    EXPECT_TRUE(lines[1].starts_with("r.exr,t.exr,RGB,color,failure,768,7,"));
}

TEST_F(CompareCommand, WritesDifferencesAsIdiffDoes) {
    ASSERT_EQ(compare({"r.exr", "t.exr", "-o", "d.exr", "--scale", "2"}).exit_code, 2);
    ASSERT_EQ(compare({"r.exr", "t.exr", "-o", "a.exr", "--abs"}).exit_code, 2);
    const std::vector<std::string> rgb = {"R", "G", "B"};
    const Image difference = ExrFile(folder_ / "d.exr").read_floats(0, rgb);
    EXPECT_NEAR(difference.at(2, 5, 1), -0.5, 1e-6) << "reference - test, times the scale";
    EXPECT_EQ(difference.at(3, 5, 1), 0);
    EXPECT_NEAR(ExrFile(folder_ / "a.exr").read_floats(0, rgb).at(2, 5, 1), 0.25, 1e-6);
    ASSERT_EQ(compare({"r.exr", "t.exr", "-o", "d.png"}).exit_code, 2);
    EXPECT_NEAR(read_png(folder_ / "d.png").at(2, 5, 1), 0.25, 1 / 255.0);
}

TEST_F(CompareCommand, WritesAHeatMapOfFlip) {
    ASSERT_EQ(compare({"r.exr", "t.exr", "--heat-map", "h.exr"}).exit_code, 2);
    ASSERT_EQ(compare({"r.exr", "t.exr", "--heat-map", "h.png"}).exit_code, 2);
    const std::vector<std::string> flip = {"flip"};
    const Image errors = ExrFile(folder_ / "h.exr").read_floats(0, flip);
    double sum = 0;
    for (const float error : errors.floats()) sum += double(error);
    EXPECT_NEAR(sum / 768, json({"r.exr", "t.exr"})["layers"][0]["hdr_flip"]["mean"].get<double>(), 1e-7);
    const Image map = read_png(folder_ / "h.png");
    EXPECT_GT(map.at(2, 5, 0), map.at(30, 1, 0));
}

TEST_F(CompareCommand, PutsEverythingSideBySide) {
    ASSERT_EQ(compare({"r.exr", "t.exr", "--side-by-side", "s.png"}).exit_code, 2);
    const Image sheet = read_png(folder_ / "s.png");
    EXPECT_GT(sheet.width(), 3 * 320);
    EXPECT_GT(sheet.height(), 240);
}

TEST_F(CompareCommand, LeavesOldFilesWholeWhereANewOneCannotBeWritten) {
    const CommandResult result = compare({"r.exr", "t.exr", "-o", "nowhere/d.exr"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_NE(result.err.find("nowhere"), std::string::npos);
    const auto before = contents(folder_.path());
    write_exr_file(folder_ / "z.exr", {{{"Z"}, constant(4, 4, {1})}});
    EXPECT_EQ(compare({"z.exr", "z.exr", "--heat-map", "h.png"}).exit_code, 4) << "depth has no FLIP";
    EXPECT_FALSE(std::filesystem::exists(folder_ / "h.png"));
}

TEST_F(CompareCommand, DrawsOnlyWhatDiffersWhenAsked) {
    EXPECT_EQ(compare({"r.exr", "r.exr", "--side-by-side", "s.png", "--only-different"}).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "s.png"));
    EXPECT_EQ(compare({"r.exr", "t.exr", "--side-by-side", "s.png", "--only-different"}).exit_code, 2);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "s.png"));
    EXPECT_EQ(compare({"r.exr", "r.exr", "--side-by-side", "same.png"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "same.png"));
}

TEST_F(CompareCommand, SaysNothingWhenQuiet) {
    const CommandResult result = compare({"r.exr", "t.exr", "-q"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out + result.err, "");
}

TEST_F(CompareCommand, LeavesOutAreasAndSaysSo) {
    // Pixel i is (3 i + 2, i + 5), 0 to 6: the seven lie in 19 x 7 px from (2, 5).
    EXPECT_EQ(code({"--ignore", "2,5,19,7"}), 0);
    EXPECT_EQ(code({"--ignore", "2,5,19,6"}), 2);
    const CommandResult text = compare({"r.exr", "t.exr", "--ignore", "2,5,4,2", "--ignore", "8,7,13,5"});
    EXPECT_EQ(text.exit_code, 0) << text.out;
    EXPECT_NE(text.out.find("left out: 73 of 768 pixels (9.505 %): 2,5,4,2; 8,7,13,5"), std::string::npos)
        << text.out;
    EXPECT_NE(text.out.find("same (9.505 % of the pixels left out)\n"), std::string::npos) << text.out;
    const Json report = json({"r.exr", "t.exr", "--ignore", "2,5,19,7"});
    EXPECT_EQ(report["layers"][0]["left_out_pixels"], 133);
    EXPECT_EQ(report["rules"]["ignore"], Json::array({"2,5,19,7"}));
    const Image mask = picture(32, 24, 1, [](int, int y, int) { return y >= 5 && y < 12 ? 1.0f : 0.0f; });
    write_png(folder_ / "mask.png", mask);
    EXPECT_EQ(code({"--ignore", "mask:mask.png"}), 0);
    EXPECT_EQ(code({"--ignore", "mask:none.png"}), 4);
    const CommandResult all = compare({"r.exr", "r.exr", "--ignore", "0,0,32,24"});
    EXPECT_EQ(all.exit_code, 3) << "nothing was compared";
    EXPECT_NE(all.out.find("every pixel is left out"), std::string::npos) << all.out;
    for (const char* where : {"1,2,3", "1,2,3,4,5", "1,2,3,0", "1,2,3,x", "0.5,0,1,1", "mask", "object:"})
        EXPECT_EQ(code({"--ignore", where}), 64) << where;
    EXPECT_EQ(code({"--ignore", "40,0,8,8"}), 3) << "outside of the picture";
}

TEST_F(CompareCommand, HoldsAreasAndLayersToLimitsOfTheirOwn) {
    EXPECT_EQ(code({"--area", "2,5,19,7=0.3"}), 0);
    EXPECT_EQ(code({"--area", "2,5,19,7=0.2"}), 2);
    EXPECT_EQ(code({"--layer", "RGB=0.3"}), 0);
    EXPECT_EQ(code({"--fail", "0.3", "--layer", "RGB=0.2"}), 2);
    const CommandResult wrong = compare({"r.exr", "t.exr", "--layer", "RGX=0.3"});
    EXPECT_EQ(wrong.exit_code, 64);
    EXPECT_NE(wrong.err.find("did you mean 'RGB'"), std::string::npos) << wrong.err;
    for (const char* word : {"2,5,19,7", "2,5,19,7=-1", "2,5,19,7=x", "=1"})
        EXPECT_EQ(code({"--area", word}), 64) << word;
}

TEST_F(CompareCommand, ForgivesAShiftOrABlurWhereItIsAskedAndNamesIt) {
    const auto value = [](int x, int y, int c) { return hashed(x / 4, y / 4, c, 2); };
    write_rgb(folder_ / "r.exr", picture(32, 24, 3, value));
    write_rgb(folder_ / "t.exr",
              picture(32, 24, 3, [&](int x, int y, int c) { return value(std::min(x + 1, 31), y, c); }));
    EXPECT_EQ(code({}), 2);
    const CommandResult shift = compare({"r.exr", "t.exr", "--forgive-shift", "1"});
    EXPECT_EQ(shift.exit_code, 0) << shift.out;
    EXPECT_NE(shift.out.find("same (forgives a shift of up to 1 px)\n"), std::string::npos) << shift.out;
    EXPECT_NE(shift.out.find("forgiven: 168 pixels, by a shift of up to 1 px"), std::string::npos)
        << shift.out;
    EXPECT_EQ(json({"r.exr", "t.exr", "--forgive-shift", "1"})["layers"][0]["forgiven_pixels"], 168);
    EXPECT_EQ(code({"--forgive-blur", "8", "--fail", "0.2"}), 0);
    EXPECT_EQ(code({"--forgive-shift", "1", "--forgive-blur", "1"}), 64);
    EXPECT_EQ(code({"--forgive-shift", "65"}), 64);
}

TEST_F(CompareCommand, LeavesOutObjectsByTheirIds) {
    Image ids(32, 24, 1, ComponentType::uint32);
    for (int y = 5; y < 12; ++y)
        for (int x = 0; x < 32; ++x) ids.uint_at(x, y, 0) = 7;
    const Image reference = picture(32, 24, 3, [](int x, int y, int c) { return 0.5f * hashed(x, y, c, 1); });
    Image test = reference;
    for (int i = 0; i < 7; ++i) test.at(3 * i + 2, i + 5, 0) += 0.25f;
    write_exr_file(folder_ / "r.exr", {{{"R", "G", "B"}, reference}, {{"object_id.I"}, ids}});
    write_exr_file(folder_ / "t.exr", {{{"R", "G", "B"}, test}, {{"object_id.I"}, ids}});
    EXPECT_EQ(code({}), 2);
    EXPECT_EQ(code({"--ignore", "object:7"}), 0);
    EXPECT_EQ(code({"--ignore", "object:8"}), 2);
    write_rgb(folder_ / "plain.exr", reference);
    EXPECT_EQ(compare({"plain.exr", "t.exr", "--ignore", "object:7"}).exit_code, 4) << "which has no ids";
    EXPECT_EQ(
        compare({"plain.exr", "plain.exr", "--ignore", "object:7", "--objects-from", "t.exr"}).exit_code, 0);
}

/// The recipes of a page: their options, without file names.
std::vector<std::vector<std::string>> recipes_of(const std::filesystem::path& page) {
    std::vector<std::vector<std::string>> recipes;
    std::istringstream lines(read_text(page));
    for (std::string line; std::getline(lines, line);) {
        const std::string begin = "    aftershade compare ";
        if (!line.starts_with(begin)) continue;
        std::istringstream words(line.substr(begin.size()));
        std::vector<std::string> options;
        for (std::string word; words >> word && word != ">" && word != "||" && word != "#";)
            options.push_back(word);
        options.erase(options.begin(), options.begin() + 2);
        recipes.push_back(std::move(options));
    }
    return recipes;
}

TEST_F(CompareCommand, FindsInvertedNormalsByEveryRecipeOfItsPage) {
    const auto write = [&](const char* name, float sign) {
        write_exr_file(folder_ / name,
                       {{{"R", "G", "B", "A"}, constant(64, 64, {0.5f, 0.2f, 0.1f, 1})},
                        {{"Z"}, constant(64, 64, {3})},
                        {{"velocity.X", "velocity.Y"}, constant(64, 64, {1, 2})},
                        {{"normal.X", "normal.Y", "normal.Z"}, constant(64, 64, {0, 0, sign})}});
    };
    write("a.exr", 1), write("b.exr", -1);
    const auto recipes = recipes_of(AFTERSHADE_SOURCE_DIR "/docs/compare.md");
    ASSERT_GE(recipes.size(), 6u);
    for (std::vector<std::string> words : recipes) {
        words.insert(words.begin(), {"a.exr", "b.exr"});
        const CommandResult result = compare(words);
        EXPECT_EQ(result.exit_code, 2) << words.back() << "\n" << result.out << result.err;
    }
}

TEST_F(CompareCommand, NamesWhatNoLimitHolds) {
    for (const bool inverted : {false, true})
        write_exr_file(folder_ / (inverted ? "b.exr" : "a.exr"),
                       {{{"R", "G", "B"}, constant(8, 8, {0.5f, 0.2f, 0.1f})},
                        {{"Z"}, constant(8, 8, {inverted ? 3.0f : 2.0f})}});
    const CommandResult result = compare({"a.exr", "b.exr", "--fail", "inf", "--fail-flip", "0.05"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(result.out.ends_with("same (not judged: Z)\n")) << result.out;
    EXPECT_EQ(result.out.find("Z (depth): same"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace aftershade::test
