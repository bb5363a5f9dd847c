// Views against OpenColorIO's own CPU processor, and what is said of configs that cannot give one.
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/look_runner.h"
#include "tests/ocio_oracle.h"
#include "tests/scoped_variable.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::ocio_view {
namespace {

/// The message of a look that has one step with these params; "" where it is sound.
std::string fault_of(const std::string& params) {
    try {
        run_step("ocio_view", make_capture({.width = 4, .height = 4}), params);
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

#ifdef AFTERSHADE_HAS_OPENCOLORIO

using namespace colors;

std::string params_of(const std::string& config, const std::string& display, const std::string& view,
                      const std::string& more = "") {
    return R"("config": ")" + config + R"(", "display": ")" + display + R"(", "view": ")" + view + "\"" +
           more;
}

TEST(OcioView, EqualsOpenColorIosProcessorForEveryViewOfTheBuiltInConfig) {
    const auto config = StudioConfig::builtin();
    const Image light = test_light();
    int views = 0;
    for (int d = 0; d < config->getNumDisplays(); ++d) {
        const std::string display = config->getDisplay(d);
        for (int v = 0; v < config->getNumViews(display.c_str()); ++v, ++views) {
            const std::string view = config->getView(display.c_str(), v);
            const auto transform = ocio::DisplayViewTransform::Create();
            transform->setSrc("lin_rec709");
            transform->setDisplay(display.c_str());
            transform->setView(view.c_str());
            const bool is_raw = view == "Raw";
            const Image image =
                drawn("ocio_view", light,
                      params_of("", display, view, is_raw ? R"(, "source": "lin_rec709")" : ""), "display");
            EXPECT_LT(largest_error(image, by_cpu(light, config->getProcessor(transform)), Measure::display),
                      kDisplayLimit)
                << display << ", " << view;
        }
    }
    EXPECT_EQ(views, 13);
}

TEST(OcioView, EqualsTheProcessorForNumbersFarFromLightToo) {
    constexpr float kNumbers[] = {0.0f,   -0.0f, 1e-38f,    -1e-38f,  3e-8f,
                                  -0.02f, -7.0f, -65504.0f, 65504.0f, 1e9f};
    constexpr int kCount = int(std::size(kNumbers));
    Image light(kCount, kCount, 4);
    for (int y = 0; y < kCount; ++y)
        for (int x = 0; x < kCount; ++x) {
            light.at(x, y, 0) = kNumbers[x];
            light.at(x, y, 1) = light.at(x, y, 3) = 1;
            light.at(x, y, 2) = kNumbers[y];
        }
    const auto config = StudioConfig::builtin();
    const auto transform = ocio::DisplayViewTransform::Create();
    transform->setSrc("lin_rec709");
    transform->setDisplay("sRGB - Display");
    transform->setView("ACES 1.0 - SDR Video");
    const std::string params = params_of("", "sRGB - Display", "ACES 1.0 - SDR Video");
    EXPECT_LT(largest_error(drawn("ocio_view", light, params, "display"),
                            by_cpu(light, config->getProcessor(transform)), Measure::display),
              kDisplayLimit);
    light.at(0, 0, 0) = light.at(0, 0, 1) = light.at(0, 0, 2) = std::numeric_limits<float>::infinity();
    const Image bright = drawn("ocio_view", light, params, "display");
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(bright.at(0, 0, c) >= 0 && bright.at(0, 0, c) <= 1);
}

TEST(OcioView, FindsHowEachDisplayIsEncoded) {
    using Curve = ColorEncoding::Curve;
    const Chromaticities wide = *color_space_primaries("rec2020");
    const std::vector<std::pair<std::string, ColorEncoding>> displays = {
        {"sRGB - Display", kSrgbDisplay},
        {"Rec.1886 Rec.709 - Display", {kRec709, Curve::gamma, 2.4}},
        {"P3-D65 - Display", {*color_space_primaries("p3d65"), Curve::gamma, 2.6}},
        {"Rec.2100-PQ - Display", {wide, Curve::pq, 1}},
        {"Rec.2100-HLG - Display", {wide, Curve::hlg, 1}}};
    const Capture capture = make_capture({.width = 4, .height = 4});
    for (const auto& [display, encoding] : displays)
        EXPECT_EQ(run_step("ocio_view", capture, R"("view": "Un-tone-mapped", "display": ")" + display + "\"")
                      .display_encoding,
                  encoding)
            << display;
    EXPECT_EQ(run_step("ocio_view", capture, R"("view": "Raw")").display_encoding.curve, Curve::unknown);
    EXPECT_EQ(run_step("view_transform", capture, "").display_encoding, kSrgbDisplay);
    const StudioConfig studio;
    EXPECT_EQ(
        run_step("ocio_view", capture, params_of(studio.path(), "Monitor", "Film")).display_encoding.curve,
        Curve::unknown)
        << "a LUT";
}

TEST(OcioView, TakesTheEncodingOfAViewByALutFromItsDisplaysSpaceOrName) {
    const StudioConfig studio;
    const auto config = studio.config()->createEditableCopy();
    for (const char* display : {"sRGB", "Rec.2100-PQ - Display"})
        config->addDisplayView(display, "Film", "cube", "");
    config->addDisplayView("sRGB", "Numbers", "Raw", "");
    const std::string path = studio.folder() / "displays.ocio";
    std::ofstream(path) << *config;
    const Capture capture = make_capture({.width = 4, .height = 4});
    const auto encoding = [&](const std::string& display, const std::string& view) {
        return run_step("ocio_view", capture, params_of(path, display, view, R"(, "source": "lin_rec709")"))
            .display_encoding;
    };
    EXPECT_EQ(encoding("sRGB", "Film"), kSrgbDisplay);
    EXPECT_EQ(encoding("Rec.2100-PQ - Display", "Film").curve, ColorEncoding::Curve::pq);
    EXPECT_EQ(encoding("sRGB", "Numbers").curve, ColorEncoding::Curve::unknown) << "not colours";
}

TEST(OcioView, EqualsOpenColorIosProcessorForAViewByALutAndForLooks) {
    const StudioConfig studio;
    const auto config = studio.config();
    const Image light = test_light();
    const Image film = drawn("ocio_view", light, params_of(studio.path(), "Monitor", "Film"), "display");
    EXPECT_LT(
        largest_error(film, by_cpu(light, config->getProcessor("lin_rec709", "cube")), Measure::display),
        kDisplayLimit);
    const auto look = ocio::LookTransform::Create();
    look->setSrc("lin_rec709");
    look->setDst("cube");
    look->setLooks("+warm");
    const Image warm = drawn("ocio_view", light,
                             params_of(studio.path(), "Monitor", "Film", R"(, "looks": "+warm")"), "display");
    EXPECT_LT(largest_error(warm, by_cpu(light, config->getProcessor(look)), Measure::display),
              kDisplayLimit);
    EXPECT_GT(largest_error(warm, film, Measure::display), 0.01);
}

/// A view from linear Rec. 709 by these LUTs of the studio's folder, against OpenColorIO's CPU processor.
double error_by_luts(StudioConfig& studio,
                     const std::vector<std::pair<const char*, ocio::Interpolation>>& luts,
                     const Image& light) {
    const auto config = studio.config()->createEditableCopy();
    config->setProcessorCacheFlags(ocio::PROCESSOR_CACHE_OFF);
    const auto all = ocio::GroupTransform::Create();
    for (const auto& [name, interpolation] : luts) {
        const auto file = ocio::FileTransform::Create();
        file->setSrc(name);
        file->setInterpolation(interpolation);
        all->appendTransform(file);
    }
    const auto space = ocio::ColorSpace::Create();
    space->setName("by_luts");
    space->setTransform(all, ocio::COLORSPACE_DIR_FROM_REFERENCE);
    config->addColorSpace(space);
    config->addDisplayView("Monitor", "LUTs", "by_luts", "");
    const std::string path = studio.folder() / "by_luts.ocio";
    std::ofstream(path) << *config;
    const std::string params = params_of(path, "Monitor", "LUTs", R"(, "source": "ACES2065-1")");
    return largest_error(drawn("ocio_view", light, params, "display"),
                         by_cpu(light, config->getProcessor(all)), Measure::display);
}

/// OpenColorIO's cache of processors takes LUTs of one size for the same.
TEST(OcioView, KeepsTheNumbersOfTwoCubesOfOneSize) {
    StudioConfig studio;
    const auto write_cube = [&](const char* name, const auto& value_of) {
        std::ofstream file(studio.folder() / "luts" / name);
        file << "LUT_3D_SIZE 9\n";
        for (int b = 0; b < 9; ++b)
            for (int g = 0; g < 9; ++g)
                for (int r = 0; r < 9; ++r)
                    file << value_of(r / 8.0, g / 8.0) << " " << value_of(g / 8.0, b / 8.0) << " "
                         << value_of(b / 8.0, r / 8.0) << "\n";
    };
    write_cube("a.cube", [](double own, double next) { return own * (0.5 + 0.5 * next); });
    write_cube("b.cube", [](double own, double next) { return 1 - own * own * (1 - 0.25 * next); });
    std::ofstream(studio.folder() / "luts/mid.cube") << "LUT_1D_SIZE 3\n0 0 0\n.6 .5 .4\n1 1 1\n";
    EXPECT_LT(error_by_luts(studio,
                            {{"a.cube", ocio::INTERP_LINEAR},
                             {"mid.cube", ocio::INTERP_LINEAR},
                             {"b.cube", ocio::INTERP_TETRAHEDRAL}},
                            test_light()),
              kDisplayLimit);
}

/// A contour of a false colour: a few points of a long LUT, between two numbers of a curve's table.
TEST(OcioView, ShowsALineOfAFewPointsOfALongLut) {
    StudioConfig studio;
    constexpr int kPoints = 4096, kFirst = 2817, kLast = 2821;
    {
        std::ofstream file(studio.folder() / "luts/line.cube");
        file << "LUT_1D_SIZE " << kPoints << "\n";
        for (int i = 0; i < kPoints; ++i) {
            const double value = i >= kFirst && i <= kLast ? 1 : 0.5 * i / (kPoints - 1);
            file << value << " " << value << " " << value << "\n";
        }
    }
    Image light(64, 1, 4);
    for (int x = 0; x < 64; ++x)
        for (int c = 0; c < 4; ++c)
            light.at(x, 0, c) = c == 3 ? 1 : float(kFirst - 30 + x) / float(kPoints - 1);
    EXPECT_LT(error_by_luts(studio, {{"line.cube", ocio::INTERP_LINEAR}}, light), kDisplayLimit);
}

/// --on-nan would miss a NaN that had become a number.
TEST(OcioView, ReadsNoNumberForNanFromATable) {
    Image light(2, 1, 4);
    for (int c = 0; c < 3; ++c) light.at(0, 0, c) = std::numeric_limits<float>::quiet_NaN();
    for (int c = 0; c < 3; ++c) light.at(1, 0, c) = 0.5f;
    const Image encoded =
        LookRunner(look_of_step("color_convert", R"("destination": "sRGB - Texture")"), gpu::test_backend())
            .run(capture_of(light))
            .images.at("color");
    EXPECT_TRUE(std::isnan(encoded.at(0, 0, 0)));
    EXPECT_NEAR(encoded.at(1, 0, 0), 0.7353570, 1e-4);
}

TEST(OcioView, ExposesBeforeTheViewAndRaisesAfterIt) {
    const auto value = [](float light, const std::string& params) {
        const Capture capture = make_capture({.width = 4, .height = 4, .background = {light, light, light}});
        return run_step("ocio_view", capture, params).images.at("display").at(1, 1, 1);
    };
    const float plain = value(0.36f, "");
    EXPECT_NEAR(value(0.09f, R"("exposure": 2)"), plain, 1e-5);
    EXPECT_NEAR(value(0.36f, R"("gamma": 2)"), std::sqrt(plain), 1e-5);
}

TEST(OcioView, TakesTheConfigOfTheVariableWhereTheLookNamesNone) {
    const StudioConfig studio;
    ScopedVariable variable("OCIO");
    variable.set(studio.path());
    EXPECT_EQ(fault_of(R"("display": "Monitor")"), "");
    EXPECT_NE(fault_of(R"("display": "Wall")").find("of $OCIO has no display 'Wall'"), std::string::npos);
}

TEST(OcioView, SaysWhichNameTheConfigLacksAndWhereItIsWritten) {
    const StudioConfig studio;
    const std::string view = fault_of(params_of(studio.path(), "Monitor", "Flim"));
    EXPECT_NE(view.find("test look:1:"), std::string::npos) << view;
    EXPECT_NE(view.find("ocio_view.view: "), std::string::npos) << view;
    EXPECT_NE(view.find("has no view 'Flim'; did you mean 'Film'?"), std::string::npos) << view;
    EXPECT_NE(fault_of(R"("source": "lin_rec708")").find("no color space or role 'lin_rec708'"),
              std::string::npos);
    EXPECT_NE(fault_of(R"("looks": "+grade")").find("no look 'grade'"), std::string::npos);
    EXPECT_NE(fault_of(R"("config": "absent.ocio")").find("no file 'absent.ocio'"), std::string::npos);
    write_text(studio.folder() / "newer.ocio", "ocio_profile_version: 2.99\n");
    const std::string newer = fault_of(params_of(studio.folder() / "newer.ocio", "", ""));
    EXPECT_NE(
        newer.find("too old for this config, which needs 2.99; bake its views with `scripts/make ocio-bake"),
        std::string::npos)
        << newer;
    const std::string address = fault_of(R"("config": "ocio://none")");
    EXPECT_NE(address.find("the config 'ocio://none' cannot be used"), std::string::npos) << address;
}

TEST(OcioView, RefusesConfigsAndLutsThatAreBrokenOrLieElsewhere) {
    const StudioConfig studio;
    const std::string params = params_of(studio.path(), "Monitor", "Film");
    write_text(studio.folder() / "luts/cube.cube", "LUT_3D_SIZE 17\n0 0\n");
    EXPECT_NE(fault_of(params).find("cube.cube"), std::string::npos) << fault_of(params);
    std::filesystem::remove(studio.folder() / "luts/cube.cube");
    EXPECT_NE(fault_of(params).find("cube.cube"), std::string::npos) << fault_of(params);
    write_text(studio.folder() / "bad.ocio", "displays: [");
    EXPECT_NE(fault_of(params_of(studio.folder() / "bad.ocio", "", "")).find("bad.ocio' cannot be used"),
              std::string::npos);
    const TemporaryFolder elsewhere;
    write_text(elsewhere / "far.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
    const auto config = studio.config()->createEditableCopy();
    const auto far_away = ocio::FileTransform::Create();
    far_away->setSrc(("../../" + elsewhere.path().filename().string() + "/far.cube").c_str());
    const auto space = ocio::ColorSpace::Create();
    space->setName("far");
    space->setTransform(far_away, ocio::COLORSPACE_DIR_FROM_REFERENCE);
    config->addColorSpace(space);
    config->addDisplayView("Monitor", "Far", "far", "");
    std::ofstream(studio.folder() / "far.ocio") << *config;
    const std::string fault = fault_of(params_of(studio.folder() / "far.ocio", "Monitor", "Far"));
    EXPECT_NE(fault.find("lies outside of its folder and its search path"), std::string::npos) << fault;
}

#else

TEST(OcioView, SaysWhatToInstallWhereTheLibraryIsAbsent) {
    EXPECT_NE(fault_of("").find("libopencolorio-dev"), std::string::npos) << fault_of("");
}

#endif

}  // namespace
}  // namespace aftershade::test::ocio_view
