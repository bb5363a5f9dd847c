// The example of a plug-in that reads lensfun's database, against lensfun itself, pixel by pixel.
#include <gtest/gtest.h>

#include "framework/file/exr_file.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"
#include "tests/temporary_folder.h"

#if __has_include(<lensfun/lensfun.h>)
#include <lensfun/lensfun.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

namespace aftershade::test {
namespace {

constexpr int kWidth = 320, kHeight = 200;
constexpr const char* kLens = "Canon EF 24-70mm f/2.8L II USM";

/// Red, green and blue say at which pixel they are: x in red and blue, y in green.
Capture positions() {
    Capture capture = make_capture(SyntheticScene{.width = kWidth, .height = kHeight}, 1);
    Image& color = capture.images.at("color");
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            for (const int channel : {0, 2}) color.at(x, y, channel) = float(x);
            color.at(x, y, 1) = float(y);
        }
    return capture;
}

class LensProfiles : public testing::Test {
protected:
    Image draw(const Capture& capture, const std::string& params) {
        write_capture(capture, folder_ / "in_0001.exr");
        write_text(folder_ / "look.json",
                   R"({ "aftershade": 1, "steps": [ { "effect": "lens_profile", "params": { "lens": ")" +
                       std::string(kLens) + R"(", "focal_length": "24 mm", "sensor_width": "36 mm",
                       "f_number": 2.8, "focus_distance": "10 m", )" +
                       params + " } } ] }");
        const CommandResult result = run_aftershade(
            {"run", "look.json", "in_0001.exr", "-o", "out_####.exr", "--pixel-type", "float",
             "--effect-path", std::string(AFTERSHADE_SOURCE_DIR) + "/examples/plugins/lens_profile",
             "--plugin-path", AFTERSHADE_EXAMPLES, "--backend", "software"},
            folder_.path());
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return ExrFile(folder_ / "out_0001.exr").read_floats(0, std::vector<std::string>{"R", "G", "B"});
    }

    TemporaryFolder folder_;
};

class Lensfun {
public:
    Lensfun(bool adds, int flags) {
        database_.Load();
        const lfLens** const found = database_.FindLenses(nullptr, nullptr, kLens);
        const lfLens* lens = found[0];
        for (int i = 0; found[i]; ++i)
            if (found[i]->Model == std::string(lens->Model) && found[i]->CropFactor == 1) lens = found[i];
        const double diagonal_mm = 36 * std::hypot(1.0, double(kHeight) / kWidth);
        modifier_ = std::make_unique<lfModifier>(lens, float(43.266615 / diagonal_mm), kWidth, kHeight);
        modifier_->Initialize(lens, LF_PF_F32, 24, 2.8f, 10, 1, lens->Type, flags, adds);
        lf_free(found);
    }
    std::array<float, 6> sources(int x, int y) const {
        std::array<float, 6> from{};
        modifier_->ApplySubpixelGeometryDistortion(float(x), float(y), 1, 1, from.data());
        return from;
    }
    float gain(int x, int y) const {
        std::array<float, 3> light{1, 1, 1};
        modifier_->ApplyColorModification(light.data(), float(x), float(y), 1, 1, LF_CR_3(RED, GREEN, BLUE),
                                          0);
        return light[1];
    }

private:
    lfDatabase database_;
    std::unique_ptr<lfModifier> modifier_;
};

TEST_F(LensProfiles, TakeEachColourFromWhereLensfunHasIt) {
    for (const bool adds : {true, false}) {
        const std::string direction = adds ? "add" : "remove";
        const Image out = draw(positions(), R"("fall_off": false, "direction": ")" + direction + "\"");
        const Lensfun lensfun(adds, LF_MODIFY_DISTORTION | LF_MODIFY_TCA);
        double farthest = 0, worst = 0;
        for (int y = 8; y < kHeight - 8; ++y)
            for (int x = 8; x < kWidth - 8; ++x) {
                const std::array<float, 6> from = lensfun.sources(x, y);
                if (std::min(from[0], from[4]) < 2 || std::max(from[0], from[4]) > kWidth - 4) continue;
                if (from[3] < 2 || from[3] > kHeight - 4) continue;
                const std::array<float, 3> is{out.at(x, y, 0), out.at(x, y, 1), out.at(x, y, 2)};
                const std::array<float, 3> should{from[0], from[3], from[4]};
                for (int i = 0; i < 3; ++i) worst = std::max(worst, double(std::abs(is[i] - should[i])));
                farthest = std::max(farthest, double(std::abs(from[0] - float(x))));
            }
        EXPECT_LT(worst, 0.01) << direction << ", px";
        EXPECT_GT(farthest, 1.5) << "this lens bends lines";
    }
}

TEST_F(LensProfiles, DarkenAsLensfunDoes) {
    const Capture grey =
        make_capture(SyntheticScene{.width = kWidth, .height = kHeight, .background = {0.5f, 0.5f, 0.5f}}, 1);
    const Image out = draw(grey, R"("distortion": false, "fringes": false)");
    const Lensfun lensfun(true, LF_MODIFY_VIGNETTING);
    double worst = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            worst = std::max(worst, std::abs(out.at(x, y, 1) / (0.5 * lensfun.gain(x, y)) - 1));
    EXPECT_LT(worst, 2e-4);
    EXPECT_LT(out.at(0, 0, 1), 0.4f) << "wide open this lens loses more than a fifth in its corners";
}

}  // namespace
}  // namespace aftershade::test

#else

TEST(LensProfiles, NeedLensfun) {
    GTEST_SKIP() << "no lensfun/lensfun.h; AFTERSHADE_TEST_ORACLES=1 scripts/test installs it";
}

#endif
