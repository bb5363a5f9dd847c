#include "framework/inspect/velocity_check.h"

#include "framework/base/error.h"
#include "framework/image/color_space.h"
#include "framework/inspect/velocity_report.h"
#include "framework/inspect/velocity_warp.h"
#include "tests/inspect/velocity_pairs.h"
#include "tests/synthetic_capture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace aftershade::test {
namespace {

struct Vector {
    float x = 0, y = 0;
};

/// The role's image, with the vector of the box replaced.
Image with_vector(const Capture& capture, Vector vector) {
    Image image = capture.images.at("velocity");
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            if (capture.images.at("object_id").uint_at(x, y, 0) != 2) continue;
            image.at(x, y, 0) = vector.x;
            image.at(x, y, 1) = vector.y;
        }
    return image;
}

/// A box that moves by `motion` from A to B, by `before` into A and by `after` out of B.
Pair make_pair(Vector motion, Vector before, Vector after) {
    test::SyntheticScene scene;
    scene.width = 128;
    scene.height = 96;
    scene.background = {0.05f, 0.1f, 0.2f};
    scene.box = {44, 36, 32, 24, int(motion.x), int(motion.y), 1, {0.9f, 0.2f, 0.1f}};
    const Capture a = test::make_capture(scene, 0), b = test::make_capture(scene, 1);
    return {a.images.at("color"),   b.images.at("color"),   with_vector(a, before),
            with_vector(b, motion), with_vector(a, motion), with_vector(b, after)};
}

const Vector kMotion{10, 4}, kOther{7, -7};

std::string name_of(const VelocityHypothesis& h) {
    return std::string(h.other_time ? "other time, " : "") + (h.swapped ? "swapped, " : "") +
           std::to_string(h.scale_x) + ", " + std::to_string(h.scale_y);
}

TEST(VelocityCheck, WeighsColoursByTheirPrimaries) {
    // Red of Rec. 709 in ACEScg: the first column of the ACES project's matrix from Rec. 709 to AP1.
    Image red(1, 1, 3), wide(1, 1, 3);
    red.at(0, 0, 0) = 1;
    wide.at(0, 0, 0) = 0.613097f, wide.at(0, 0, 1) = 0.070194f, wide.at(0, 0, 2) = 0.020616f;
    EXPECT_FLOAT_EQ(float(median_luminance(red, red, kRec709)), 0.2126f);
    EXPECT_NEAR(median_luminance(wide, wide, *color_space_primaries("acescg")), 0.2126, 1e-4);
}

TEST(VelocityCheck, EveryListedHypothesisIsFoundWhereItIsTrue) {
    const Pair pair = make_pair(kMotion, kOther, kOther);
    for (const bool next : {false, true})
        for (const VelocityScore& listed : check_velocity(claim_velocity(pair)).hypotheses) {
            const VelocityHypothesis& truth = listed.hypothesis;
            const bool in_a = next != truth.other_time;
            const Image a = undo(in_a ? pair.next_a : pair.velocity_a, truth);
            const Image b = undo(in_a ? pair.next_b : pair.velocity_b, truth);
            const VelocityCheck check = check_velocity(
                {&pair.color_a, &pair.color_b, &a, &b, {.delta = next ? "next-cur" : "cur-prev"}});
            EXPECT_EQ(check.best.hypothesis, truth)
                << name_of(check.best.hypothesis) << " for " << name_of(truth);
            EXPECT_EQ(check.verdict,
                      truth == VelocityHypothesis{} ? VelocityVerdict::confirmed : VelocityVerdict::wrong)
                << name_of(truth) << ": " << check.sentence;
            EXPECT_GT(check.best.score, 0.95) << name_of(truth);
            EXPECT_EQ(check.hypotheses.size(), 48u);
        }
}

TEST(VelocityCheck, CorrectedSettingsDecodeAsTheHypothesisSays) {
    // Stored values decoded by hand under both settings.
    const auto decode = [](const VelocitySettings& s, Vector stored) {
        if (s.exchange_channels) std::swap(stored.x, stored.y);
        const double sign = s.delta == "cur-prev" || s.delta == "next-cur" ? 1 : -1;
        const double unit = s.unit == "uv" ? 100 : s.unit == "ndc" ? 50 : 1;
        return Vector{float(sign * unit * s.scale[0] * stored.x),
                      float((s.y_axis == "up" ? -1 : 1) * sign * unit * s.scale[1] * stored.y)};
    };
    const Pair pair = make_pair(kMotion, kOther, kOther);
    for (const VelocityScore& listed : check_velocity(claim_velocity(pair)).hypotheses)
        for (const char* delta : {"cur-prev", "prev-cur", "next-cur", "cur-next"})
            for (const char* y_axis : {"up", "down"})
                for (const char* unit : {"px", "uv", "ndc"}) {
                    const VelocityHypothesis& h = listed.hypothesis;
                    const VelocitySettings before{
                        .delta = delta, .y_axis = y_axis, .unit = unit, .scale = {3, 5}};
                    const VelocitySettings after = correct_settings(before, h);
                    const Vector was = decode(before, {0.25f, 1.5f}), is = decode(after, {0.25f, 1.5f});
                    EXPECT_FLOAT_EQ(is.x, float(h.scale_x) * (h.swapped ? was.y : was.x)) << name_of(h);
                    EXPECT_FLOAT_EQ(is.y, float(h.scale_y) * (h.swapped ? was.x : was.y)) << name_of(h);
                    EXPECT_EQ(after.is_next(), before.is_next() != h.other_time);
                }
    EXPECT_EQ(correct_settings({.unit = "uv"}, {false, false, 0.5, 0.5}).unit, "ndc");
    EXPECT_EQ(correct_settings({.unit = "ndc"}, {false, false, 2, 2}).unit, "uv");
}

TEST(VelocityCheck, AStaticPairSaysThatNothingMoves) {
    const Pair pair = make_pair({0, 0}, {0, 0}, {0, 0});
    const VelocityCheck check = check_velocity(claim_velocity(pair));
    EXPECT_EQ(check.verdict, VelocityVerdict::untestable);
    EXPECT_FALSE(check.confirmed());
    EXPECT_NE(check.sentence.find("nothing moves"), std::string::npos) << check.sentence;
    EXPECT_FALSE(check.fit);
    EXPECT_EQ(check.suggested, check.settings);
}

TEST(VelocityCheck, VectorsOverTwoEqualPicturesTellNothing) {
    Pair pair = make_pair(kMotion, kMotion, kMotion);
    pair.color_b = pair.color_a;
    const VelocityCheck check = check_velocity(claim_next(pair));
    EXPECT_EQ(check.verdict, VelocityVerdict::untestable);
    EXPECT_NE(check.sentence.find("the same"), std::string::npos) << check.sentence;
}

/// What a file stores, read as px: `store` makes a stored value of one in px and the picture's side.
template <class Store>
Pair read_as_px(Pair pair, Store&& store) {
    for (Image* image : {&pair.velocity_a, &pair.velocity_b})
        for (int y = 0; y < image->height(); ++y)
            for (int x = 0; x < image->width(); ++x) {
                image->at(x, y, 0) = float(store(double(image->at(x, y, 0)), image->width()));
                image->at(x, y, 1) = float(store(double(image->at(x, y, 1)), image->height()));
            }
    return pair;
}

VelocitySettings suggested_for(const Pair& pair) {
    const VelocityCheck check = check_velocity(claim_velocity(pair));
    EXPECT_EQ(check.verdict, VelocityVerdict::wrong) << check.sentence;
    return check.suggested;
}

TEST(VelocityCheck, VectorsBelowAPixelNameTheUnit) {
    const Pair pair =
        read_as_px(make_pair(kMotion, kOther, kOther), [](double v, int side) { return v / side; });
    EXPECT_EQ(suggested_for(pair), (VelocitySettings{.unit = "uv"}));
}

TEST(VelocityCheck, VectorsAroundAHalfNameTheBias) {
    const Pair pair = make_pair(kMotion, kOther, kOther);
    EXPECT_EQ(suggested_for(read_as_px(pair, [](double v, int side) { return v / side + 0.5; })),
              (VelocitySettings{.unit = "uv", .bias = 0.5}));
    EXPECT_EQ(suggested_for(read_as_px(pair, [](double v, int side) { return 0.5 * v / side + 0.5; })),
              (VelocitySettings{.unit = "uv", .scale = {2, 2}, .bias = 0.5}));
    EXPECT_EQ(suggested_for(read_as_px(pair, [](double v, int side) { return 0.5 - v / side; })),
              (VelocitySettings{.delta = "prev-cur", .unit = "uv", .bias = 0.5}));
    // In bytes, no motion is 128 of 255.
    EXPECT_NEAR(
        suggested_for(
            read_as_px(pair, [](double v, int side) { return std::round(255 * (v / side + 0.5)) / 255; }))
            .bias,
        128.0 / 255, 1e-4);
    EXPECT_EQ(suggested_for(read_as_px(pair, [](double v, int) { return v + 128; })),
              (VelocitySettings{.bias = 128}));
}

TEST(VelocityCheck, VectorsThatWereCutOffAtTheEndOfTheRangeAreCounted) {
    Pair pair =
        read_as_px(make_pair(kMotion, kOther, kOther), [](double v, int side) { return v / side + 0.5; });
    EXPECT_EQ(check_velocity(claim_velocity(pair)).at_limit, "");
    for (int i = 0; i < 20; ++i) pair.velocity_b.at(i, 0, 0) = 1;
    const VelocityCheck check = check_velocity(claim_velocity(pair));
    EXPECT_EQ(check.at_limit, "20 pixels of the two frames are stored as 1, the end of the range 0 to 1");
    EXPECT_NE(check.sentence.find(check.at_limit), std::string::npos) << check.sentence;
    EXPECT_EQ(check.suggested, (VelocitySettings{.unit = "uv", .bias = 0.5}));
}

TEST(VelocityCheck, ABiasOfHalfAPixelIsNotConfirmed) {
    const Pair pair = read_as_px(make_pair(kMotion, kOther, kOther), [](double v, int) { return v + 0.5; });
    EXPECT_EQ(suggested_for(pair), (VelocitySettings{.bias = 0.5}));
}

TEST(VelocityCheck, AFewMovingPixelsAreNoEvidence) {
    Pair pair = make_pair(kMotion, kOther, kOther);
    for (Image* image : {&pair.velocity_a, &pair.velocity_b})
        for (int y = 0; y < image->height(); ++y)
            for (int x = 0; x < image->width(); ++x)
                if (x > 65 || y > 45 || (x < 58 || y < 40)) image->at(x, y, 0) = image->at(x, y, 1) = 0;
    const VelocityCheck check = check_velocity(claim_velocity(pair));
    EXPECT_EQ(check.verdict, VelocityVerdict::untestable) << check.sentence;
    EXPECT_NE(check.sentence.find("pixels with motion vectors"), std::string::npos) << check.sentence;
}

TEST(VelocityCheck, SteadyMotionDoesNotTellTheTime) {
    const VelocityCheck check = check_velocity(claim_velocity(make_pair(kMotion, kMotion, kMotion)));
    EXPECT_EQ(check.verdict, VelocityVerdict::undecided);
    EXPECT_EQ(check.untold, std::vector<std::string>{"delta (cur-prev or next-cur)"}) << check.sentence;
}

TEST(VelocityCheck, MotionAlongOneAxisDoesNotTellTheOther) {
    const VelocityCheck check = check_velocity(claim_velocity(make_pair({12, 0}, {3, 9}, {3, 9})));
    EXPECT_EQ(check.verdict, VelocityVerdict::undecided);
    EXPECT_EQ(check.untold, std::vector<std::string>{"y_axis"}) << check.sentence;
    ASSERT_TRUE(check.fit && check.fit->scale_x);
    EXPECT_NEAR(*check.fit->scale_x, 1, 0.03);
    EXPECT_FALSE(check.fit->scale_y);
}

TEST(VelocityCheck, WithoutTheOtherFramesVectorsTheTimeIsNotTold) {
    const Pair pair = make_pair(kMotion, kOther, kOther);
    VelocityCheckInput input = claim_velocity(pair);
    input.vectors_a = nullptr;
    const VelocityCheck check = check_velocity(input);
    EXPECT_EQ(check.verdict, VelocityVerdict::undecided);
    EXPECT_EQ(check.untold, std::vector<std::string>{"delta (cur-prev or next-cur)"}) << check.sentence;
    input.vectors_b = nullptr;
    EXPECT_EQ(check_velocity(input).verdict, VelocityVerdict::untestable);
    input.vectors_a = &pair.velocity_a;
    const VelocityCheck claim_untested = check_velocity(input);
    EXPECT_EQ(claim_untested.verdict, VelocityVerdict::untestable);
    EXPECT_NE(claim_untested.sentence.find("read in frame B"), std::string::npos) << claim_untested.sentence;
}

TEST(VelocityCheck, AScaleThatIsNotListedIsFitted) {
    Pair pair = make_pair({12, 10}, {-4, 9}, {-4, 9});
    pair.velocity_b = undo(pair.velocity_b, {false, false, 3, -0.7});
    const VelocityCheck check = check_velocity(claim_velocity(pair));
    EXPECT_EQ(check.verdict, VelocityVerdict::no_fit) << check.sentence;
    ASSERT_TRUE(check.fit && check.fit->scale_x && check.fit->scale_y);
    EXPECT_NEAR(*check.fit->scale_x, 3, 0.05);
    EXPECT_NEAR(*check.fit->scale_y, -0.7, 0.02);
    EXPECT_EQ(check.suggested.y_axis, "up");
}

TEST(VelocityCheck, VectorsOfAnotherShotFitNothing) {
    Pair pair = make_pair({0, 0}, {0, 0}, {0, 0});
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) {
            pair.color_a.at(x, y, 0) = float((x * 7919 + y * 104729) % 97) / 97;
            pair.color_b.at(x, y, 0) = float((x * 5171 + y * 31337) % 89) / 89;
            pair.velocity_a.at(x, y, 0) = pair.velocity_b.at(x, y, 0) = 8;
        }
    const VelocityCheck check = check_velocity(claim_velocity(pair));
    EXPECT_EQ(check.verdict, VelocityVerdict::no_fit);
    EXPECT_EQ(check.suggested, check.settings) << check.sentence;
}

TEST(VelocityCheck, WhereEveryReadingMakesItWorseTheFitSaysSo) {
    // The vectors move a bright line that in truth stays where it is: a warp can only add errors.
    Pair pair = make_pair({0, 0}, {0, 0}, {0, 0});
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) {
            const bool lit = x == 64;
            pair.color_a.at(x, y, 0) = pair.color_b.at(x, y, 0) = lit ? 0.6f : 0.0f;
            if (lit) pair.color_b.at(x, y, 0) = 0.7f;
            if (lit) pair.velocity_b.at(x, y, 0) = 30;
        }
    const VelocityCheck check = check_velocity(claim_velocity(pair));
    EXPECT_EQ(check.verdict, VelocityVerdict::no_fit) << check.sentence;
    EXPECT_LT(check.best.score, -0.3);
    EXPECT_EQ(check.suggested, check.settings);
}

TEST(VelocityCheck, NanPixelsAndWildVectorsDoNotMatter) {
    const Pair clean = make_pair(kMotion, kOther, kOther);
    Pair dirty = clean;
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 90; ++i) {
        dirty.color_a.at((i * 37) % 128, i, 0) = i % 2 ? nan : -infinity;
        dirty.color_b.at((i * 53) % 128, i, 1) = i % 2 ? nan : infinity;
        dirty.velocity_b.at((i * 41) % 128, i, i % 2) = i % 3 == 0 ? nan : i % 3 == 1 ? infinity : 1e10f;
    }
    const VelocityCheck check = check_velocity(claim_velocity(dirty));
    EXPECT_TRUE(check.confirmed()) << check.sentence;
    EXPECT_NEAR(check.identity.score, check_velocity(claim_velocity(clean)).identity.score, 0.05);
    EXPECT_LT(check.longest_px, 20);
}

TEST(VelocityCheck, AnObjectThatEntersThePictureDoesNotMislead) {
    // Half of the box comes from outside in B; the other direction in time, less right, has all of its pixels
    // inside.
    test::SyntheticScene scene;
    scene.width = 128;
    scene.height = 96;
    scene.background = {0.05f, 0.1f, 0.2f};
    scene.box = {-16, 36, 32, 24, 16, 5, 1, {0.9f, 0.2f, 0.1f}};
    const Capture a = test::make_capture(scene, 0), b = test::make_capture(scene, 1);
    const Image velocity_a = with_vector(a, {11, 9}), velocity_b = with_vector(b, {16, 5});
    const VelocityCheck check =
        check_velocity({&a.images.at("color"), &b.images.at("color"), &velocity_a, &velocity_b, {}});
    EXPECT_TRUE(check.confirmed()) << format_velocity_check(check);
}

TEST(VelocityCheck, TheReportShowsTheClaimItsRivalsAndTheFreeScale) {
    const std::string report =
        format_velocity_check(check_velocity(claim_velocity(make_pair(kMotion, kOther, kOther))));
    for (const char* part : {"velocity: The profile is right", "as claimed    100 %",
                             "delta cur-prev, y_axis down", "free scale", "times the decoded vectors"})
        EXPECT_NE(report.find(part), std::string::npos) << part << " in\n" << report;
}

TEST(VelocityCheck, ExposureDoesNotMatter) {
    const Pair pair = make_pair(kMotion, kOther, kOther);
    const double score = check_velocity(claim_velocity(pair)).rival.score;
    for (const float gain : {1e-4f, 1e4f}) {
        Pair other = pair;
        for (Image* image : {&other.color_a, &other.color_b})
            for (float& value : image->floats()) value *= gain;
        EXPECT_NEAR(check_velocity(claim_velocity(other)).rival.score, score, 1e-3);
    }
}

TEST(VelocityCheck, FramesOfTwoSizesAreAnError) {
    Pair pair = make_pair(kMotion, kOther, kOther);
    pair.color_b = Image(10, 10, 4);
    try {
        check_velocity(claim_velocity(pair));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        EXPECT_NE(std::string(error.what()).find("10x10"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace aftershade::test
