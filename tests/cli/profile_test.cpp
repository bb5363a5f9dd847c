// describe and list of scattering profiles.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/cli/command.h"

namespace aftershade::test {
namespace {

class Profiles : public testing::Test {
protected:
    CommandResult command(const std::vector<std::string>& words, int exit_code = 0) {
        CommandResult result = run_aftershade(words, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result;
    }

    TemporaryFolder folder_;
};

TEST_F(Profiles, OfWhichThereAreSomeAreListed) {
    const auto listed = nlohmann::json::parse(command({"list", "--scattering-profiles", "--json"}).out);
    std::vector<std::string> names;
    for (const auto& profile : listed) {
        names.push_back(profile.at("name"));
        EXPECT_NE(profile.at("summary"), "") << names.back();
    }
    EXPECT_NE(std::find(names.begin(), names.end(), "marble"), names.end());
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
    EXPECT_EQ(lines_of_text(command({"list", "--scattering-profiles"}).out).size(), names.size());
}

// The six Gaussians by hand: the mean square is twice the sum of weight times variance, d^2 a fourteenth of
// that.
TEST_F(Profiles, AreDescribedByTheirWidths) {
    const std::string text = command({"describe", "skin"}).out;
    EXPECT_TRUE(text.starts_with("skin: gaussians\nCaucasian skin: ")) << text;
    for (const char* row :
         {R"(d of equal rms +0\.4445 +0\.09865 +0\.05949  mm)", R"(rms radius +1\.663 +0\.3691 +0\.2226  mm)",
          R"(Gaussian 6 variance +7\.41 +7\.41 +7\.41  mm\^2)", "\nsource: d'Eon and Luebke 2007"})
        EXPECT_TRUE(std::regex_search(text, std::regex(row))) << row << "\n" << text;
    EXPECT_EQ(text.find("direct"), std::string::npos);
    EXPECT_NE(command({"describe", "skin_artist"}).out.find("direct"), std::string::npos);
    EXPECT_NE(command({"describe", "marble"}).out.find("index of refraction          1.5"),
              std::string::npos);
}

TEST_F(Profiles, OfOnesOwnAreDescribedToo) {
    write_text(folder_ / "wax.json",
               R"({"aftershade": 1, "summary": "Wax.", "type": "burley", "d_mm": [3, 2, 1]})");
    const auto told = nlohmann::json::parse(command({"describe", "wax.json", "--json"}).out);
    EXPECT_EQ(told.at("type"), "burley");
    EXPECT_EQ(told.at("d_mm"), (std::vector<double>{3, 2, 1}));
    EXPECT_NEAR(told.at("rms_mm").at(2), std::sqrt(14.0), 1e-12);
    // Burley's quantiles: 1.5522, 6.062 and 12.953 d.
    EXPECT_NEAR(told.at("radius_mm").at("0.5").at(0), 3 * 1.5522, 1e-3);
    EXPECT_NEAR(told.at("radius_mm").at("0.9").at(1), 2 * 6.062, 1e-2);
    EXPECT_NEAR(told.at("radius_mm").at("0.99").at(2), 12.953, 1e-2);
}

/// The numbers of every "M x y L x y ..." path of a class, in the order of the file.
std::vector<std::vector<std::pair<double, double>>> paths_of(const std::string& svg,
                                                             const std::string& style) {
    std::vector<std::vector<std::pair<double, double>>> paths;
    const std::regex path("<path class=\"" + style + "\" d=\"(M[^\"]*)\""), point("[ML]([0-9.]+) ([0-9.]+)");
    for (std::sregex_iterator p(svg.begin(), svg.end(), path), end; p != end; ++p) {
        const std::string text = (*p)[1];
        paths.emplace_back();
        for (std::sregex_iterator q(text.begin(), text.end(), point); q != end; ++q)
            paths.back().emplace_back(std::stod((*q)[1]), std::stod((*q)[2]));
    }
    return paths;
}

TEST_F(Profiles, ArePlottedByChannel) {
    command({"describe", "skin_burley", "--plot", "out.svg"});
    const std::string svg = read_text(folder_ / "out.svg");
    for (const char* part :
         {"prefers-color-scheme: dark", "r [mm]", "x [mm]", "Share within a radius", ">red: d 0.445 mm"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    const std::regex box(
        "<rect class=\"box\" x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"");
    std::vector<std::array<double, 4>> boxes;
    for (std::sregex_iterator b(svg.begin(), svg.end(), box), end; b != end; ++b)
        boxes.push_back({std::stod((*b)[1]), std::stod((*b)[2]), std::stod((*b)[3]), std::stod((*b)[4])});
    ASSERT_EQ(boxes.size(), 4u);
    for (int c = 0; c < 3; ++c) {
        const auto lines = paths_of(svg, "line line" + std::to_string(c));
        ASSERT_EQ(lines.size(), 5u) << "one in the legend, one a panel";
        for (std::size_t i = 0; i < 4; ++i) {
            const auto& [x, y, width, height] = boxes[i];
            ASSERT_GT(lines[i + 1].size(), 100u);
            for (const auto& [px, py] : lines[i + 1])
                ASSERT_TRUE(px >= x - 0.01 && px <= x + width + 0.01 && py >= y - 0.01 &&
                            py <= y + height + 0.01)
                    << i;
        }
        // The second panel is the CDF, from 0 to 1, over as many mm as hold 99.5 % of the widest, 15.03 d.
        const auto& [x, y, width, height] = boxes[1];
        const double d = std::array{0.4445, 0.0987, 0.0595}[std::size_t(c)];
        for (const auto& [px, py] : lines[2]) {
            const double r = (px - x) / width * 15.03 * 0.4445 / d, within = 1 - (py - y) / height;
            ASSERT_NEAR(within, 1 - std::exp(-r) / 4 - 0.75 * std::exp(-r / 3), 3e-3) << r;
        }
    }
}

TEST_F(Profiles, OfAnEffectsParameterArePlotted) {
    const std::string effects = std::string(AFTERSHADE_SOURCE_DIR) + "/tests/schema";
    command({"describe", "every_form", "--effect-path", effects, "--plot", "out.svg"});
    EXPECT_NE(read_text(folder_ / "out.svg").find("red: d 1 mm"), std::string::npos);
    EXPECT_NE(command({"describe", "bokeh", "--plot", "out.svg"}, 2)
                  .err.find("'bokeh' has no scattering_profile to plot"),
              std::string::npos);
}

TEST_F(Profiles, ThatAreNotThereOrWrongAreRefused) {
    EXPECT_NE(command({"describe", "skni"}, 2)
                  .err.find("no effect or scattering profile 'skni'; did you mean 'skin'?"),
              std::string::npos);
    EXPECT_NE(command({"describe", "wax.json"}, 2).err.find("no file 'wax.json'"), std::string::npos);
    write_text(folder_ / "wax.json", R"({"aftershade": 1, "summary": "Wax.", "type": "burley"})");
    EXPECT_NE(command({"describe", "wax.json"}, 2)
                  .err.find("wax.json:1:1: error: the scattering profile has one of 'd_mm' and"),
              std::string::npos);
    command({"describe", "skin", "--plot", "nowhere/out.svg"}, 6);
    command({"describe", "skin", "--plot", "out.svg", "--json"}, 2);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.svg"));
}

}  // namespace
}  // namespace aftershade::test
