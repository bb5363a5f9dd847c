// What sanitize does to each kind of fault, against values written by hand.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/not_finite.h"
#include "tests/synthetic_capture.h"
#include "tests/wide_capture.h"

namespace aftershade::test::sanitize {
namespace {

/// A ramp, so that a median has one value: red of (x, y) is 1 + x.
Capture ramp() {
    Capture capture = make_capture({.width = 16, .height = 9, .background = {1, 0.5f, 0.25f}});
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 16; ++x) capture.images["color"].at(x, y, 0) = 1 + float(x);
    return capture;
}

FrameResult sanitized(const Capture& capture, const std::string& step) {
    const std::string look = R"({"aftershade": 1, "steps": [{"effect": "sanitize")" + step + "}]}";
    return LookRunner(look, gpu::test_backend(), {"sanitize.faults"}).run(capture);
}

TEST(Sanitize, LeavesASoundImageAloneBitForBit) {
    const Capture capture = ramp();
    const FrameResult result = sanitized(capture, R"(, "preset": "all")");
    const auto expected = capture.images.at("color").floats(), out = result.images.at("color").floats();
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), out.begin()));
    for (const float fault : result.taps.at("sanitize.faults").floats()) ASSERT_EQ(fault, 0);
}

TEST(Sanitize, TakesTheMedianOfTheSoundNeighbours) {
    Capture capture = ramp();
    capture.images["color"].at(5, 4, 1) = kNan;
    capture.images["color"].at(6, 4, 0) = kInfinity;  // a neighbour of it that is no better
    const FrameResult result = sanitized(capture, "");
    const Image& out = result.images.at("color");
    // Red of the seven sound neighbours of (5, 4): 5 5 5 6 6 7 7; of (6, 4): 6 6 7 7 8 8 8.
    EXPECT_EQ(out.at(5, 4, 0), 6);
    EXPECT_EQ(out.at(5, 4, 1), 0.5f);
    EXPECT_EQ(out.at(6, 4, 0), 7);
    EXPECT_EQ(result.taps.at("sanitize.faults").at(5, 4, 0), 1);
    EXPECT_EQ(result.taps.at("sanitize.faults").at(6, 4, 1), 1);
    EXPECT_EQ(out.at(4, 4, 0), 5);
}

TEST(Sanitize, ClampsEachKindToItsOwnValue) {
    Capture capture = ramp();
    Image& color = capture.images["color"];
    color.at(2, 2, 0) = kNan;
    color.at(5, 2, 0) = kInfinity;
    color.at(8, 2, 0) = -kInfinity;
    color.at(11, 2, 0) = -3;
    const Image out = sanitized(capture, R"(, "params": {"nan": "clamp", "inf": "clamp", "max_value": 100})")
                          .images.at("color");
    EXPECT_EQ(out.at(2, 2, 0), 0);
    EXPECT_EQ(out.at(5, 2, 0), 100);
    EXPECT_EQ(out.at(8, 2, 0), 0);
    EXPECT_EQ(out.at(11, 2, 0), 0);
    EXPECT_EQ(out.at(2, 2, 1), 0.5f);  // the other channels of a clamped pixel stay
}

TEST(Sanitize, ReportLeavesThePixelAndMarksIt) {
    Capture capture = ramp();
    capture.images["color"].at(3, 3, 2) = kNan;
    capture.images["color"].at(9, 3, 2) = -1;
    const FrameResult result = sanitized(capture, R"(, "preset": "report")");
    EXPECT_TRUE(std::isnan(result.images.at("color").at(3, 3, 2)));
    EXPECT_EQ(result.images.at("color").at(9, 3, 2), -1);
    EXPECT_EQ(result.taps.at("sanitize.faults").at(3, 3, 0), 1);
    EXPECT_EQ(result.taps.at("sanitize.faults").at(9, 3, 2), 1);
}

TEST(Sanitize, DimsAFireflyToItsFactorOfTheMedian) {
    Capture capture =
        make_capture({.width = 9, .height = 9, .background = {0.5f, 0.5f, 0.5f}, .points = {{4, 4, 999.5f}}});
    const Image out =
        sanitized(capture, R"(, "params": {"firefly": "clamp", "firefly_factor": 4})").images.at("color");
    EXPECT_NEAR(out.at(4, 4, 0), 2, 1e-4);
    EXPECT_EQ(out.at(3, 4, 0), 0.5f);
    const FrameResult reported = sanitized(capture, "");
    EXPECT_EQ(reported.images.at("color").at(4, 4, 0), 1000);
    EXPECT_EQ(reported.taps.at("sanitize.faults").at(4, 4, 3), 1);
}

TEST(Sanitize, CountsTheFaultsOfEachKind) {
    Capture capture = ramp();
    Image& color = capture.images["color"];
    for (const int x : {1, 4, 7}) color.at(x, 2, 0) = kNan;
    for (const int x : {2, 8}) color.at(x, 6, 1) = kInfinity;
    color.at(12, 4, 2) = -1;
    host::Host host({.data = AFTERSHADE_SOURCE_DIR, .backend = host::Backend(int(gpu::test_backend()))});
    host::Session session =
        host.parse_look(R"({"aftershade": 1, "steps": [{"effect": "sanitize"}]})").session();
    const FrameResult frame = host::Access::frame(session.render(
        host::Access::capture({capture, {}, 1}), {.telemetry = true, .non_finite = host::NonFinite::ignore}));
    const auto& told = frame.telemetry->steps.at("sanitize");
    const double pixels = 16 * 9;
    EXPECT_EQ(told.at("nan").sum, 3);
    EXPECT_DOUBLE_EQ(told.at("nan").mean, 3 / pixels);
    EXPECT_EQ(told.at("infinite").sum, 2);
    EXPECT_EQ(told.at("negative").sum, 1);
    EXPECT_EQ(told.at("fireflies").sum, 0);
}

TEST(Sanitize, WorksInTheCornerWhereNeighboursAreFew) {
    Capture capture = ramp();
    capture.images["color"].at(0, 0, 0) = kNan;
    EXPECT_EQ(sanitized(capture, "").images.at("color").at(0, 0, 0), 2);  // of 1, 2 and 2
}

TEST(Sanitize, ClampsTheSameFirefliesOfCapturesInWiderPrimaries) {
    Capture capture = make_capture({.width = 16, .height = 9, .background = {1, 0.5f, 0.25f}});
    for (int c = 0; c < 3; ++c) {  // one of each primary
        Image& color = capture.images.at("color");
        for (int other = 0; other < 3; ++other) color.at(3 + 4 * c, 4, other) = other == c ? 200.0f : 1.0f;
    }
    const std::string step = R"(, "params": {"firefly": "clamp"})";
    const FrameResult expected = sanitized(capture, step);
    for (const char* space : {"rec2020", "acescg"}) {
        const FrameResult result = sanitized(in_space(capture, space), step);
        EXPECT_LT(largest_share(in_rec709(result.images.at("color"), space), expected.images.at("color")),
                  1e-4)
            << space;
        EXPECT_TRUE(std::ranges::equal(result.taps.at("sanitize.faults").floats(),
                                       expected.taps.at("sanitize.faults").floats()))
            << space;
    }
}

}  // namespace
}  // namespace aftershade::test::sanitize
