// Scattering by lookup: what must not change.
#include <cstring>

#include <gtest/gtest.h>

#include "effects/sss_preintegrated/sss_preintegrated_test.h"

namespace aftershade::test::preintegrated {
namespace {

TEST(SssPreintegrated, LeavesAPlaneInEvenLightAsItIs) {
    Capture capture = plane(64, 36);
    CaptureLight lamp;
    lamp.position_m = {0.3, -0.2, 0.8};
    lamp.intensity = {2, 1, 0.5};
    for (const bool is_near : {false, true}) {
        if (is_near) {
            capture.header.lights = {lamp};
            for (int y = 0; y < 36; ++y)
                for (int x = 0; x < 64; ++x) {
                    const Image& at = capture.images.at("position");
                    const double dx = 0.3 - at.at(x, y, 0), dy = -0.2 - at.at(x, y, 1);
                    const double square = dx * dx + dy * dy + 0.64;
                    for (int c = 0; c < 3; ++c)
                        capture.images.at("irradiance").at(x, y, c) =
                            float(lamp.intensity[std::size_t(c)] * 0.8 / (kPi * square * std::sqrt(square)));
                }
        }
        for (const char* profile : {R"("scattering_profile": "skin", "world_unit": 10)",
                                    R"("scattering_profile": {"type": "burley", "d_mm": [90, 30, 3]})"}) {
            const Image light = scattered(capture, profile);
            for (int y = 0; y < 36; ++y)
                for (int x = 0; x < 64; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const double before = capture.images.at("irradiance").at(x, y, c);
                        ASSERT_NEAR(light.at(x, y, c), before, 5e-4 * before) << is_near << profile;
                    }
        }
    }
}

TEST(SssPreintegrated, ApproachesTheLightThatCameInAsTheProfileNarrows) {
    const Capture capture = ball();
    double last = 1;
    for (const double d_mm : {100.0, 30.0, 10.0, 3.0, 0.1}) {
        const double change = worst(capture, scattered(capture, burley({d_mm, d_mm, d_mm})),
                                    capture.images.at("irradiance"), 0);
        EXPECT_LT(change, last) << d_mm;
        EXPECT_LT(change, 1.2 * d_mm / 1000) << d_mm;
        last = change;
    }
    EXPECT_LT(last, 1e-3);
}

TEST(SssPreintegrated, DoesNotTouchABitOfWhatDoesNotScatter) {
    Capture capture = ball();
    capture.images["mask"] = Image(64, 64, 1);
    capture.header.roles.push_back("mask");
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (y < 32) capture.images.at("object_id").uint_at(x, y, 0) *= 2;
            capture.images.at("mask").at(x, y, 0) = x % 2 ? 1.0f : 0.0f;
        }
    const Image& before = capture.images.at("irradiance");
    const Image light = scattered(capture, burley({200, 100, 50}) + R"(, "object_ids": [1])");
    int changed = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) {
                const float a = light.at(x, y, c), b = before.at(x, y, c);
                const bool same = std::memcmp(&a, &b, sizeof a) == 0;
                if (y < 32 || x % 2 == 0) ASSERT_TRUE(same) << x << " " << y;
                else changed += !same;
            }
    EXPECT_GT(changed, 500);
}

TEST(SssPreintegrated, KeepsLightWithinItsObject) {
    Capture capture = plane();
    shade(capture, [](double x, double) { return x > 0 ? 1.0 : 0.0; });
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 240; ++x) capture.images.at("object_id").uint_at(x, y, 0) = 2;
    const Image light = scattered(capture, burley(kEdgeD) + R"(, "max_shadow_radius": 160)");
    for (int x = 0; x < 480; ++x)
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(light.at(x, 4, c), x < 240 ? 0 : 1, 1e-3) << x;
}

TEST(SssPreintegrated, PassesLightThatTheLightsDoNotExplain) {
    Capture capture = plane(64, 8);
    for (float& value : capture.images.at("irradiance").floats()) value += 0.25f;
    const Image all = scattered(capture, burley(kEdgeD) + R"(, "ambient": [0.25, 0.25, 0.25])");
    capture.header.lights.clear();
    const Image dark = scattered(capture, burley(kEdgeD));
    for (int x = 0; x < 64; ++x) {
        EXPECT_NEAR(all.at(x, 4, 0), 1.25, 1e-3);
        EXPECT_EQ(dark.at(x, 4, 0), 1.25f) << "there is no light";
    }
}

}  // namespace
}  // namespace aftershade::test::preintegrated
