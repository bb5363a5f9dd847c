// Conversions between spaces against OpenColorIO's own CPU processor.
#include <string>

#include <gtest/gtest.h>

#include "tests/ocio_oracle.h"

#ifdef AFTERSHADE_HAS_OPENCOLORIO

namespace aftershade::test::color_convert {
namespace {

using namespace colors;

std::string params_of(const std::string& config, const std::string& from, const std::string& to) {
    return R"("config": ")" + config + R"(", "source": ")" + from + R"(", "destination": ")" + to + "\"";
}

TEST(ColorConvert, EqualsOpenColorIosProcessorForEverySpaceAndBack) {
    const StudioConfig studio;
    const auto config = studio.config();
    const Image light = test_light();
    for (const char* space :
         {"matrix", "log", "camera", "cdl", "gamma", "curve", "long_curve", "cube", "tetrahedra", "ACEScct",
          "ACEScc", "ACEScg", "sRGB - Texture", "color_timing"}) {
        const Image there =
            drawn("color_convert", light, params_of(studio.path(), "lin_rec709", space), "color");
        const Image expected = by_cpu(light, config->getProcessor("lin_rec709", space));
        EXPECT_LT(largest_error(there, expected, Measure::linear), kLinearLimit) << space;
        const Image back =
            drawn("color_convert", expected, params_of(studio.path(), space, "lin_rec709"), "color");
        EXPECT_LT(
            largest_error(back, by_cpu(expected, config->getProcessor(space, "lin_rec709")), Measure::linear),
            kLinearLimit)
            << "from " << space;
    }
}

TEST(ColorConvert, TakesTheCapturesPrimariesWhereNoSpaceIsSaid) {
    const Image light = test_light();
    const auto config = StudioConfig::builtin();
    const Image expected = by_cpu(light, config->getProcessor("lin_rec709", "ACEScct"));
    EXPECT_LT(largest_error(drawn("color_convert", light, R"("destination": "ACEScct")", "color"), expected,
                            Measure::linear),
              kLinearLimit);
    Capture wide = capture_of(by_cpu(light, config->getProcessor("lin_rec709", "ACEScg")));
    wide.header.primaries = *color_space_primaries("acescg");
    const Image of_wide = run_step("color_convert", wide, R"("destination": "ACEScct")").images.at("color");
    EXPECT_LT(largest_error(of_wide, expected, Measure::linear), kLinearLimit);
    // And back to the capture's.
    Capture log = wide;
    log.images.at("color") = of_wide;
    const Image back = run_step("color_convert", log, R"("source": "ACEScct")").images.at("color");
    EXPECT_LT(largest_error(back, wide.images.at("color"), Measure::linear), kLinearLimit);
}

TEST(ColorConvert, GivesTheEncodingOfTheSpaceForFiles) {
    using Curve = ColorEncoding::Curve;
    const Capture capture = make_capture({.width = 4, .height = 4});
    const auto encoding = [&](const char* space) {
        return run_step("color_convert", capture, std::string(R"("destination": ")") + space + "\"")
            .color_encoding;
    };
    for (const auto& [space, name] :
         {std::pair{"ACEScg", "acescg"}, {"ACES2065-1", "ap0"}, {"lin_rec709", "rec709"}})
        EXPECT_EQ(encoding(space), (ColorEncoding{*color_space_primaries(name), Curve::linear, 1})) << space;
    EXPECT_EQ(encoding("sRGB - Texture"), kSrgbDisplay);
    EXPECT_EQ(encoding("ACEScct")->curve, Curve::unknown);
    EXPECT_EQ(encoding("Raw")->curve, Curve::unknown);
    EXPECT_FALSE(run_step("color_convert", capture, R"("source": "ACEScct")").color_encoding)
        << "back in the capture's primaries";
}

TEST(ColorConvert, ConvertsTheColorNotTheColorTimesItsCoverage) {
    const Capture half =
        make_capture({.width = 4, .height = 4, .background = {0.5f, 0.5f, 0.5f}, .alpha = 0.25f});
    const Capture whole = make_capture({.width = 4, .height = 4, .background = {0.5f, 0.5f, 0.5f}});
    const auto at_one = [](const Capture& capture) {
        return run_step("color_convert", capture, R"("destination": "ACEScct")")
            .images.at("color")
            .at(1, 1, 0);
    };
    EXPECT_NEAR(at_one(half), at_one(whole) * 0.25f, 1e-6);
}

}  // namespace
}  // namespace aftershade::test::color_convert
#endif
