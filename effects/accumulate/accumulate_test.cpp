// The mean of sub-frames against weights in double precision, the renderer's truth, and what must stay as it
// is.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/file/exr_file.h"
#include "tests/backends.h"
#include "tests/cli/command.h"
#include "tests/crop.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::accumulate {
namespace {

constexpr int kWidth = 16, kHeight = 9;
const char* const kShapes[] = {"box", "triangle", "cosine"};

std::string look_of(const std::string& shape) {
    return R"({"aftershade": 1, "steps": [{"effect": "accumulate", "params": {"shape": ")" + shape + "\"}}]}";
}

Capture grey(float value, int frame = 1) {
    return make_capture(
        {.width = kWidth, .height = kHeight, .background = {value, 2 * value, -value}, .alpha = 1}, frame);
}

/// The result of the last sub-frame; those before give none.
Image accumulated(LookRunner& runner, const std::vector<Capture>& captures) {
    FrameInputs frame;
    frame.subframe_count = int(captures.size());
    FrameResult result;
    for (const Capture& capture : captures) {
        EXPECT_TRUE(result.images.empty());
        frame.capture = &capture;
        frame.centre = &captures[captures.size() / 2];
        result = runner.run(frame);
        ++frame.subframe;
    }
    return result.images.at("color");
}

Image accumulated(const std::string& shape, const std::vector<Capture>& captures) {
    LookRunner runner(look_of(shape), gpu::test_backend());
    return accumulated(runner, captures);
}

double weight_at(const std::string& shape, double t) {
    if (shape == "triangle") return 1 - std::abs(2 * t);
    return shape == "cosine" ? std::cos(std::numbers::pi * t) : 1;
}

std::vector<double> weights_of(const std::string& shape, int count) {
    std::vector<double> weights;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        weights.push_back(weight_at(shape, (i + 0.5) / count - 0.5));
        sum += weights.back();
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

TEST(Accumulate, GivesEverySubframeTheWeightOfItsShapeAndTheyAddUpToOne) {
    for (const std::string shape : kShapes)
        for (const int count : {2, 3, 4, 7, 16}) {
            const std::vector<double> expected = weights_of(shape, count);
            double sum = 0;
            LookRunner runner(look_of(shape), gpu::test_backend());
            for (int lit = 0; lit < count; ++lit) {
                std::vector<Capture> captures;
                for (int s = 0; s < count; ++s) captures.push_back(grey(s == lit ? 1.0f : 0.0f, lit + 1));
                const float got = accumulated(runner, captures).at(3, 4, 0);
                EXPECT_NEAR(got, expected[std::size_t(lit)], 2e-7) << shape << " " << lit << " of " << count;
                sum += double(got);
            }
            EXPECT_NEAR(sum, 1, 1e-6) << shape << " " << count;
        }
}

TEST(Accumulate, LeavesACaptureWithoutSubframesAsItIsBitForBit) {
    Capture capture = grey(0.1f);
    capture.images.at("color").at(2, 2, 0) = 1e-30f;
    capture.images.at("color").at(3, 2, 0) = 3e8f;
    capture.images.at("color").at(3, 2, 3) = 0.3f;
    for (const std::string shape : kShapes) {
        LookRunner runner(look_of(shape), gpu::test_backend());
        for (int frame = 1; frame <= 3; ++frame) {
            capture.header.frame = frame;
            EXPECT_TRUE(same_in_window(capture.images.at("color"), runner.color(capture), {0, 0, 15, 8}));
        }
    }
}

TEST(Accumulate, LeavesWhatIsAlikeInAllSubframesAsItIsBitForBit) {
    for (const std::string shape : kShapes)
        for (const int count : {3, 10, 13}) {
            const std::vector<Capture> captures(std::size_t(count), grey(0.1f));
            EXPECT_TRUE(
                same_in_window(captures[0].images.at("color"), accumulated(shape, captures), {0, 0, 15, 8}))
                << shape << " " << count;
        }
}

TEST(Accumulate, KeepsSmallLightBesideOneBrightMomentOverAThousandSubframes) {
    for (const std::string shape : kShapes) {
        const std::vector<double> weights = weights_of(shape, 1024);
        std::vector<Capture> captures;
        double expected = 0;
        for (int s = 0; s < 1024; ++s) {
            const float value = s == 300 ? 5000.0f : 0.001f * float(s % 7);
            captures.push_back(make_capture({.width = 4, .height = 4, .background = {value, 0, 0}}));
            expected += weights[std::size_t(s)] * double(value);
        }
        EXPECT_NEAR(accumulated(shape, captures).at(1, 1, 0), expected, 1e-6 * expected) << shape;
    }
}

TEST(Accumulate, TakesAlphaAlongAndNothingOfTheFrameBefore) {
    LookRunner runner(look_of("box"), gpu::test_backend());
    accumulated(runner, {grey(7, 1), grey(9, 1)});
    std::vector<Capture> second{grey(1, 2), grey(0, 2)};
    for (float& value : second[1].images.at("color").floats()) value = 0;
    const Image color = accumulated(runner, second);
    EXPECT_EQ(color.at(5, 5, 0), 0.5f);
    EXPECT_EQ(color.at(5, 5, 1), 1.0f);
    EXPECT_EQ(color.at(5, 5, 3), 0.5f);
}

Image rgb(const std::filesystem::path& path) {
    const std::vector<std::string> names{"R", "G", "B"};
    return ExrFile(path).read_floats(0, names);
}

TEST(Accumulate, OfSixtyFourSubframesFromTheCommandIsTheRenderersTruth) {
    const TemporaryFolder folder;
    const std::string scenes = std::string(AFTERSHADE_SOURCE_DIR) + "/scenes/";
    write_text(folder.path() / "look.json", look_of("box"));
    for (const std::string scene : {"wheel", "moving_box", "camera_checker"}) {
        const CommandResult rendered =
            run_aftershade({"render", scenes + scene, "-o", scene, "--size", "80x45", "--frames", "4-5",
                            "--subframes", "64", "--truth", "shutter", "--samples", "64"},
                           folder.path());
        ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
        const CommandResult ran = run_aftershade(
            {"run", "look.json", scene, "-o", scene + "/out_####.exr", "--pixel-type", "float"},
            folder.path());
        ASSERT_EQ(ran.exit_code, 0) << ran.err;
        EXPECT_EQ(ran.out, scene + "/out_0004.exr\n" + scene + "/out_0005.exr\n");
        for (const std::string frame : {"0004", "0005"}) {
            const Image truth = rgb(folder.path() / scene / ("truth_shutter_" + frame + ".exr"));
            const Image out = rgb(folder.path() / scene / ("out_" + frame + ".exr"));
            ASSERT_EQ(out.floats().size(), truth.floats().size());
            for (std::size_t i = 0; i < truth.floats().size(); ++i)
                ASSERT_NEAR(out.floats()[i], truth.floats()[i], 1e-5) << scene << " " << frame;
        }
    }
}

}  // namespace
}  // namespace aftershade::test::accumulate
