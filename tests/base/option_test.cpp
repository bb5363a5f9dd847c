#include "framework/base/option.h"

#include <array>

#include <gtest/gtest.h>

#include "framework/base/diagnostics.h"

namespace aftershade {
namespace {

TEST(Option, HasTheNameOfItsEnumerator) {
    EXPECT_EQ(option_name(Option::allow_path), "allow_path");
    EXPECT_EQ(option_name(Option::color_space), "color_space");
    EXPECT_EQ(option_name(Option::warmup), "warmup");
}

TEST(Option, IsSaidWithoutACommandLineWhereNoFrontEndSaysHow) {
    using enum Option;
    for (const Option option : std::array{AFTERSHADE_OPTIONS})
        EXPECT_EQ(spelled(option, "x").find('-'), std::string::npos) << option_name(option);
    EXPECT_EQ(spelled(Option::alpha, "opaque"), "alpha_is_opaque");
    EXPECT_EQ(spelled(Option::on_nan, "mend"), "non_finite=mend");
    EXPECT_EQ(spelled(Option::output), "path");
}

TEST(Option, IsARemedyOnlyForWhoHasIt) {
    EXPECT_EQ(advice(" (choose with ", Option::color_space, "", ")"), " (choose with color_space)");
    EXPECT_EQ(advice(" (choose with ", Option::pass_timeout, "", ")"), "");
}

TEST(Option, IsAPlaceWithItsValue) {
    const Place place = option_place(Option::tap, "bokeh.coc");
    EXPECT_EQ(place.file, "bokeh.coc");
    EXPECT_EQ(to_string(place), "taps bokeh.coc");
    EXPECT_EQ(to_string(option_place(Option::compression)), "compression");
}

}  // namespace
}  // namespace aftershade
