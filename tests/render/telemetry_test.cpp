// Statistics of textures against sums made here, and their JSON.
#include "framework/render/telemetry.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aftershade {
namespace {

Image ramp() {
    Image image(4, 2, 2);
    for (int i = 0; i < 8; ++i) {
        image.at(i % 4, i / 4, 0) = float(i);
        image.at(i % 4, i / 4, 1) = i < 5 ? 1.0f : 0.0f;
    }
    return image;
}

TelemetrySpec spec_of(int channel, double from = 0, double to = 0, int bins = 0) {
    TelemetrySpec spec;
    spec.of = {"texture", channel};
    spec.from = from;
    spec.to = to;
    spec.bins = bins;
    return spec;
}

TEST(Telemetry, CountsAllTexelsUnlessItIsToldWhere) {
    const Image image = ramp();
    TelemetrySpec spec = spec_of(0);
    const Statistic all = statistic_of(spec, image, nullptr);
    EXPECT_EQ(all.count, 8);
    EXPECT_EQ(all.sum, 28);
    EXPECT_EQ(all.mean, 3.5);
    EXPECT_NEAR(all.deviation, std::sqrt(5.25), 1e-12);
    EXPECT_EQ(all.min, 0);
    EXPECT_EQ(all.max, 7);
    spec.where = TelemetrySpec::Channel{"texture", 1};
    const Statistic some = statistic_of(spec, image, &image);
    EXPECT_EQ(some.count, 5);
    EXPECT_EQ(some.mean, 2);
    EXPECT_NEAR(some.deviation, std::sqrt(2.0), 1e-12);
    EXPECT_EQ(some.max, 4);
}

TEST(Telemetry, PutsWhatLiesOutsideIntoTheOutermostBins) {
    const Statistic statistic = statistic_of(spec_of(0, 1, 5, 2), ramp(), nullptr);
    EXPECT_EQ(statistic.histogram, (std::vector<std::int64_t>{3, 5})) << "0 1 2 and 3 4 5 6 7";
}

TEST(Telemetry, SquaresADeviation) {
    TelemetrySpec spec = spec_of(0);
    spec.squared = true;
    EXPECT_EQ(statistic_of(spec, ramp(), nullptr).sum, 140);
}

TEST(Telemetry, CountsWhatIsNoNumberApart) {
    Image image = ramp();
    image.at(0, 0, 0) = std::numeric_limits<float>::quiet_NaN();
    image.at(1, 0, 0) = std::numeric_limits<float>::infinity();
    const Statistic statistic = statistic_of(spec_of(0), image, nullptr);
    EXPECT_EQ(statistic.non_finite, 2);
    EXPECT_EQ(statistic.count, 6);
    EXPECT_EQ(statistic.sum, 27);
    EXPECT_EQ(statistic.min, 2);
    Image none(2, 2, 2);
    TelemetrySpec spec = spec_of(0);
    spec.where = TelemetrySpec::Channel{"texture", 1};
    EXPECT_EQ(statistic_of(spec, none, &none).count, 0);
    EXPECT_EQ(statistic_of(spec, none, &none).mean, 0);
}

TEST(Telemetry, IsOneJsonObjectAFrame) {
    FrameTelemetry telemetry;
    telemetry.frame = 12;
    telemetry.steps["glow"]["reach"] = statistic_of(spec_of(0, 0, 8, 4), ramp(), nullptr);
    telemetry.textures["rgba32f"] = {3, 4096};
    telemetry.buffer_bytes = 16;
    telemetry.bytes = 4112;
    telemetry.bytes_unaliased = 5000;
    telemetry.passes = {{"upload", 1.5}, {"glow.blur", 2}, {"glow.blur", 3}};
    const auto json = nlohmann::json::parse(telemetry_json(telemetry));
    EXPECT_EQ(json["aftershade"], 1);
    EXPECT_EQ(json["frame"], 12);
    EXPECT_EQ(json["steps"]["glow"]["reach"]["mean"], 3.5);
    EXPECT_EQ(json["steps"]["glow"]["reach"]["histogram"]["counts"], (std::vector<int>{2, 2, 2, 2}));
    EXPECT_EQ(json["memory"]["textures"]["rgba32f"]["bytes"], 4096);
    EXPECT_EQ(json["memory"]["textures"]["rgba32f"]["count"], 3);
    EXPECT_EQ(json["memory"]["bytes"], 4112);
    EXPECT_EQ(json["passes_ms"]["glow.blur"], 5) << "turns of one pass are one";
}

}  // namespace
}  // namespace aftershade
