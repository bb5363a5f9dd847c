// How values go from key to key: handles of curves as CSS has them.
#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/look/ease.h"

namespace aftershade::test {
namespace {

std::optional<Ease> read(const std::string& interpolation, std::string& faults) {
    Diagnostics diagnostics;
    const auto node = parse_document(R"({ "interpolation": )" + interpolation + " }", "look", diagnostics);
    ObjectReader reader(*node, "shown.reach", diagnostics);
    const auto ease = read_ease(reader, "shown.reach", diagnostics);
    std::ostringstream text;
    diagnostics.print(text);
    faults = text.str();
    return ease;
}

/// De Casteljau's construction, which knows no polynomial.
std::array<double, 2> point_of(const std::array<double, 4>& handles, double s) {
    std::array<std::array<double, 2>, 4> points = {
        {{0, 0}, {handles[0], handles[1]}, {handles[2], handles[3]}, {1, 1}}};
    for (std::size_t left = 3; left > 0; --left)
        for (std::size_t i = 0; i < left; ++i)
            for (std::size_t axis = 0; axis < 2; ++axis)
                points[i][axis] += s * (points[i + 1][axis] - points[i][axis]);
    return points[0];
}

TEST(Ease, OfACurvePassesThroughThePointsOfItsConstruction) {
    for (const std::array<double, 4> handles : {std::array<double, 4>{0.4, 0, 0.6, 1},
                                                {0, 0, 0, 1},
                                                {1, 0, 0, 1},
                                                {0, 1, 1, 0},
                                                {0.2, 0.9, 0.1, 0.3}}) {
        const Ease ease{Ease::Kind::curve, handles};
        EXPECT_NEAR(ease.share(0), 0, 1e-7);
        EXPECT_NEAR(ease.share(1), 1, 1e-7);
        for (int i = 1; i < 32; ++i) {
            const auto [x, y] = point_of(handles, i / 32.0);
            EXPECT_NEAR(ease.share(x), y, 1e-5) << x;  // where the curve is steep, x decides little
        }
    }
}

TEST(Ease, HasTheValuesThatBrowsersHave) {
    const Ease css_ease{Ease::Kind::curve, {0.25, 0.1, 0.25, 1}};  // `ease` in CSS Easing Functions Level 1
    EXPECT_NEAR(css_ease.share(0.5), 0.8024034, 1e-6);             // of Chromium's getComputedStyle
    EXPECT_NEAR((Ease{Ease::Kind::curve, {0.42, 0, 0.58, 1}}).share(0.5), 0.5, 1e-12);
}

TEST(Ease, OfAWordOrHandlesIsReadAndWrittenInTheSameForm) {
    std::string faults;
    for (const char* text : {"\"linear\"", "\"smooth\"", "\"step\"", "[0.25, 0, 1, 0.5]"}) {
        const auto ease = read(text, faults);
        ASSERT_TRUE(ease) << faults;
        EXPECT_EQ(format_ease(*ease), text);
    }
}

TEST(Ease, ThatIsNeitherIsAnErrorWithItsPlaceAndWhatItMayBe) {
    const std::string may_be =
        "'interpolation' is 'linear', 'smooth' or 'step', or the handles of a curve, [x1, y1, x2, y2], four "
        "numbers "
        "from 0 to 1";
    for (const auto& [text, more] : {std::pair(R"("smoth")", "; did you mean 'smooth'?"),
                                     {"[0.4, 0, 0.6]", ""},
                                     {"[0.4, -0.1, 0.6, 1]", ""},
                                     {"[0.4, 0, 1.2, 1]", ""},
                                     {"[0.4, 0, 0.6, \"1\"]", ""},
                                     {"3", ""}}) {
        std::string faults;
        EXPECT_FALSE(read(text, faults)) << text;
        EXPECT_EQ(faults, "look:1:20: error: shown.reach: " + may_be + more + "\n");
    }
}

}  // namespace
}  // namespace aftershade::test
