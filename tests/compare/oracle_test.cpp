// Figures against those of NVIDIA's flip-evaluator, scikit-image, SciPy and OpenImageIO's idiff: as they were
// stored by scripts/make compare-figures, and as the tools say now where they are installed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "framework/compare/compare_files.h"
#include "framework/compare/layer_file.h"
#include "framework/image/srgb.h"
#include "framework/image/window.h"
#include "tests/compare/pictures.h"
#include "tests/real_captures.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::hashed;
using test::picture;

struct Pair {
    Image reference, test;
};

Image display(const Image& linear) {
    return picture(linear.width(), linear.height(), 3, [&](int x, int y, int c) {
        return float(encode_srgb(std::clamp(double(linear.at(x, y, c)), 0.0, 1.0)));
    });
}

/// Combined or DiffCol of the repository's Blender frames.
Image blender(const char* frame, const char* pass) {
    const LayerFile file(fs::path(AFTERSHADE_SOURCE_DIR "/scenes/suzanne") / frame);
    for (const LayerInfo& layer : file.layers())
        if (layer.label() == fmt::format("ViewLayer.{}.RGB", pass)) return file.read(layer, layer.channels);
    throw std::runtime_error("no such pass");
}

/// 300 x 300 px of the ball in the left view of a frame of Beachball, where the captures are.
std::optional<Image> beachball(const char* frame) {
    const fs::path file = test::captures_folder() / "beachball" / frame;
    if (!fs::exists(file)) return std::nullopt;
    const LayerFile layers(file);
    for (const LayerInfo& layer : layers.layers())
        if (layer.label() == "rgba_left:RGB")
            return place_in_window(layers.read(layer, layer.channels), layer.data_window,
                                   {1000, 600, 1299, 899}, 0);
    return std::nullopt;
}

/// Soft blobs, hard bars and a gradient, as light up to `brightest`.
Image scene(int width, int height, float brightest, int shift) {
    return picture(width, height, 3, [=](int x, int y, int c) {
        const float u = float(x + shift) / float(width), v = float(y) / float(height);
        const float blob = std::exp(-40 * ((u - 0.3f) * (u - 0.3f) + (v - 0.4f) * (v - 0.4f)));
        const float bars = ((x + shift) / 9 + c) % 3 == 0 && v > 0.6f ? 0.4f : 0.05f;
        return 0.02f + 0.3f * u * float(c + 1) / 3 + bars + brightest * blob * (c == 0 ? 1.0f : 0.7f);
    });
}

/// 0 to `size` of noise on every value, none of them below 0.
Image noisy(const Image& image, float size, int seed) {
    return picture(image.width(), image.height(), 3, [&](int x, int y, int c) {
        return std::max(image.at(x, y, c) + size * (hashed(x, y, c, seed) - 0.5f), 0.0f);
    });
}

Image times(const Image& image, float factor) {
    return picture(image.width(), image.height(), 3,
                   [&](int x, int y, int c) { return factor * image.at(x, y, c); });
}

std::map<std::string, Pair> make_pairs() {
    std::map<std::string, Pair> pairs;
    const Image room = scene(200, 180, 0.5f, 0), sun = scene(200, 180, 300, 0);
    const Image noise1 = picture(64, 48, 3, [](int x, int y, int c) { return hashed(x, y, c, 1); });
    const Image noise2 = picture(64, 48, 3, [](int x, int y, int c) { return hashed(x, y, c, 2); });
    const Image checks =
        picture(96, 96, 3, [](int x, int y, int) { return (x / 4 + y / 4) % 2 ? 0.9f : 0.1f; });
    // .png
    pairs["ldr_room_shifted"] = {display(room), display(scene(200, 180, 0.5f, 1))};
    pairs["ldr_room_noisy"] = {display(room), display(noisy(room, 0.05f, 3))};
    pairs["ldr_room_darker"] = {display(room), display(times(room, 0.8f))};
    pairs["ldr_noise"] = {noise1, noise2};
    pairs["ldr_checks_grey"] = {checks, test::constant(96, 96, {0.5f, 0.5f, 0.5f})};
    pairs["ldr_green_blue"] = {test::constant(40, 30, {0, 1, 0}), test::constant(40, 30, {0, 0, 1})};
    pairs["ldr_blender_frames"] = {display(blender("gbuffer_0003.exr", "Combined")),
                                   display(blender("gbuffer_0004.exr", "Combined"))};
    // .exr
    pairs["hdr_sun_shifted"] = {sun, scene(200, 180, 300, 2)};
    pairs["hdr_sun_noisy"] = {sun, noisy(sun, 0.1f, 4)};
    pairs["hdr_sun_darker"] = {sun, times(sun, 0.7f)};
    pairs["hdr_dim"] = {times(room, 0.001f), times(noisy(room, 0.1f, 5), 0.001f)};
    pairs["hdr_noise"] = {times(noise1, 10), times(noise2, 10)};
    pairs["hdr_blender_frames"] = {blender("gbuffer_0003.exr", "Combined"),
                                   blender("gbuffer_0004.exr", "Combined")};
    pairs["hdr_blender_noisy"] = {blender("gbuffer_0003.exr", "Combined"),
                                  noisy(blender("gbuffer_0003.exr", "Combined"), 0.1f, 6)};
    const auto ball1 = beachball("multipart.0001.exr"), ball2 = beachball("multipart.0002.exr");
    if (ball1 && ball2) {
        pairs["ldr_beachball_frames"] = {display(*ball1), display(*ball2)};
        pairs["hdr_beachball_frames"] = {*ball1, *ball2};
        pairs["hdr_beachball_noisy"] = {*ball1, noisy(*ball1, 0.02f, 7)};
    }
    return pairs;
}

/// The pairs as files, in $AFTERSHADE_COMPARE_PAIRS where that is set, for scripts/make compare-figures.
class CompareOracle : public testing::Test {
protected:
    static void SetUpTestSuite() {
        const char* chosen = std::getenv("AFTERSHADE_COMPARE_PAIRS");
        if (!chosen) temporary_ = std::make_unique<test::TemporaryFolder>();
        folder_ = chosen ? fs::path(chosen) : temporary_->path();
        for (const auto& [name, pair] : make_pairs()) {
            names_.push_back(name);
            for (const auto& [which, image] :
                 {std::pair{"ref", &pair.reference}, std::pair{"test", &pair.test}})
                if (name.starts_with("ldr")) write_png(file(name, which), *image);
                else test::write_rgb(file(name, which), *image);
        }
    }
    static void TearDownTestSuite() { temporary_.reset(); }

    static fs::path file(const std::string& name, const char* which) {
        return folder_ / fmt::format("{}.{}.{}", name, which, name.starts_with("ldr") ? "png" : "exr");
    }

    static void expect_figures(const Json& all) {
        ASSERT_GE(names_.size(), 14);
        for (const std::string& name : names_) {
            for (const auto& [variant, flip] : all.at(name).at("flip").items()) {
                SCOPED_TRACE(name + " " + variant);
                const Comparison comparison =
                    compare_files(file(name, "ref"), file(name, "test"), rules_of(variant));
                ASSERT_EQ(comparison.layers.size(), 1);
                expect_flip(comparison.layers[0], flip);
                if (variant == "default") expect_others(comparison.layers[0], all.at(name));
            }
        }
    }

    /// VARIANTS of oracle.py.
    static CompareRules rules_of(const std::string& variant) {
        CompareRules rules;
        if (variant == "far") rules.flip.pixels_per_degree = 110;
        if (variant == "reinhard") rules.flip.tone_mapper = ToneMapper::reinhard;
        if (variant == "hable") rules.flip.tone_mapper = ToneMapper::hable;
        if (variant == "exposed") {
            rules.flip.start_exposure = -1;
            rules.flip.stop_exposure = 2;
            rules.flip.exposures = 5;
        }
        return rules;
    }

    static void expect_flip(const LayerComparison& layer, const Json& flip) {
        const bool hdr = layer.hdr_flip.has_value();
        const FlipResult& ours = hdr ? *layer.hdr_flip : *layer.ldr_flip;
        EXPECT_NEAR(ours.mean, flip.at("mean").get<double>(), hdr ? 1e-4 : 1e-5);
        EXPECT_NEAR(ours.max, flip.at("max").get<double>(), 1e-3);
        if (!hdr) return;
        EXPECT_NEAR(ours.start_exposure, flip.at("start").get<double>(), 1e-5);
        EXPECT_NEAR(ours.stop_exposure, flip.at("stop").get<double>(), 1e-5);
        EXPECT_EQ(ours.exposures, flip.at("exposures").get<int>());
    }

    static void expect_others(const LayerComparison& layer, const Json& figures) {
        EXPECT_NEAR(*layer.ssim, figures.at("ssim").get<double>(), 1e-5);
        ASSERT_EQ(layer.ms_ssim.has_value(), !figures.at("ms_ssim").is_null());
        if (layer.ms_ssim) {
            EXPECT_NEAR(*layer.ms_ssim, figures.at("ms_ssim").get<double>(), 1e-5);
        }
        if (figures.at("idiff").is_null()) return;
        // idiff prints six digits.
        const auto expect = [&](double value, const char* name) {
            const double theirs = figures["idiff"].at(name).get<double>();
            EXPECT_NEAR(value, theirs, 1e-6 + 6e-6 * theirs) << name;
        };
        expect(layer.differences.mean_absolute, "mean");
        expect(layer.differences.rmse, "rms");
        expect(layer.differences.largest.value, "max");
    }

    static inline std::unique_ptr<test::TemporaryFolder> temporary_;
    static inline fs::path folder_;
    static inline std::vector<std::string> names_;
};

TEST_F(CompareOracle, FiguresAreThoseStored) {
    std::ifstream in(AFTERSHADE_SOURCE_DIR "/tests/compare/oracle_figures.json");
    ASSERT_TRUE(in) << "scripts/make compare-figures makes it";
    expect_figures(Json::parse(in));
}

TEST_F(CompareOracle, FiguresAreThoseOfTheInstalledTools) {
    const fs::path python = AFTERSHADE_SOURCE_DIR "/build/compare-venv/bin/python";
    if (!fs::exists(python.parent_path().parent_path() / "complete"))
        GTEST_SKIP()
            << "SKIPPED: no flip-evaluator in build/compare-venv; AFTERSHADE_TEST_ORACLES=1 scripts/test "
               "installs it";
    const test::TemporaryFolder out;
    const std::string command =
        fmt::format("'{}' '{}/tests/compare/oracle.py' '{}' > '{}'", python.string(), AFTERSHADE_SOURCE_DIR,
                    folder_.string(), (out / "figures.json").string());
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    expect_figures(Json::parse(test::read_text(out / "figures.json")));
}

}  // namespace
}  // namespace aftershade
