// Each part of the antialiasing against its equation in double precision, on noise.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "effects/taa/taa_test.h"

namespace aftershade::test::taa_equations {
namespace {

using Light = std::array<double, 4>;
constexpr std::size_t kChannels = 4;

Light texel(const Image& image, int x, int y) {
    x = std::clamp(x, 0, image.width() - 1);
    y = std::clamp(y, 0, image.height() - 1);
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2), image.at(x, y, 3)};
}

template <typename Each>
Light per_channel(Each each) {
    Light result{};
    for (std::size_t c = 0; c < kChannels; ++c) result[c] = each(c);
    return result;
}

/// The largest difference of any pixel from `expected`(x, y).
template <typename Expected>
double farthest(const Image& image, Expected expected) {
    double most = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Light right = expected(x, y), got = texel(image, x, y);
            for (std::size_t c = 0; c < kChannels; ++c) most = std::max(most, std::abs(right[c] - got[c]));
        }
    return most;
}

double luma(const Light& light) {
    return 0.25 * light[0] + 0.5 * light[1] + 0.25 * light[2];
}
double karis_weight(const Light& light) {
    return 1 / (1 + std::max(luma(light), 0.0));
}

const std::string kPlain = R"("reconstruction": "none", "disocclusion": "none")";

// ---- averages ----

TEST(TaaAverage, OfFramesAtRestIsTheirMean) {
    TaaRun run(R"("rejection": "none", "reconstruction": "none", "static_frames": 4096)");
    std::vector<Capture> frames;
    for (int i = 1; i <= 24; ++i) frames.push_back(noise(40, 24, std::uint32_t(i), 3, i));
    Image out;
    for (const Capture& frame : frames) out = run.color(frame);
    EXPECT_LT(farthest(out,
                       [&](int x, int y) {
                           Light sum{};
                           for (const Capture& frame : frames) {
                               const Light now = texel(frame.images.at("color"), x, y);
                               for (std::size_t c = 0; c < kChannels; ++c) sum[c] += now[c] / 24;
                           }
                           return sum;
                       }),
              5e-6);
    for (const float age : run.tap("age").floats()) ASSERT_EQ(age, 24);
}

TEST(TaaAverage, FadesByHistoryWeightWhereThePictureMoves) {
    TaaRun run(kPlain + R"(, "rejection": "none", "history_weight": 0.75)");
    // Every column has one colour, so that moving down changes nothing.
    std::vector<float> values;
    Image out;
    for (int i = 1; i <= 12; ++i) {
        Capture frame = noise(16, 32, 1, 1, i);
        const float value = float(i * i % 7);
        for (float& v : frame.images["color"].floats()) v = value;
        set_velocity(frame, 0, 1);
        values.push_back(value);
        out = run.color(frame);
    }
    // Row r comes into the picture at frame 12 - r; there its history begins.
    for (int row = 0; row < 12; ++row) {
        double expected = 0;
        int frames = 0;
        for (int i = 12 - row; i <= 12; ++i, ++frames)
            expected += (values[std::size_t(i - 1)] - expected) * std::max(1.0 / (frames + 1), 0.25);
        EXPECT_NEAR(out.at(5, row, 0), expected, 1e-5) << row;
    }
}

TEST(TaaAverage, WeighsLightByItsLumaWhereAskedTo) {
    TaaRun run(R"("rejection": "none", "reconstruction": "none", "hdr_weighting": true)");
    const Capture a = noise(40, 24, 1, 50, 1), b = noise(40, 24, 2, 0.5f, 2);
    run.next(a);
    const Image out = run.color(b);
    EXPECT_LT(farthest(out,
                       [&](int x, int y) {
                           const Light first = texel(a.images.at("color"), x, y),
                                       second = texel(b.images.at("color"), x, y);
                           const double wa = karis_weight(first), wb = karis_weight(second);
                           return per_channel(
                               [&](std::size_t c) { return (wa * first[c] + wb * second[c]) / (wa + wb); });
                       }),
              2e-5);
}

// ---- the frame's own filter ----

double gaussian(double distance_px, double width_px) {
    const double sigma = width_px / (3.3 * std::sqrt(2 * 2.29));
    return std::exp(-distance_px * distance_px / (2 * sigma * sigma));
}

double blackman_harris(double distance_px, double width_px) {
    const double x = distance_px / width_px, turn = 2 * std::numbers::pi * x;
    if (std::abs(x) >= 0.5) return 0;
    return 0.35875 + 0.48829 * std::cos(turn) + 0.14128 * std::cos(2 * turn) + 0.01168 * std::cos(3 * turn);
}

struct Bell {
    const char* name;
    double (*weight)(double, double);
    double width_px;
};

class TaaFilter : public testing::TestWithParam<Bell> {};
INSTANTIATE_TEST_SUITE_P(Both, TaaFilter,
                         testing::Values(Bell{"gaussian", gaussian, 2}, Bell{"gaussian", gaussian, 3.3},
                                         Bell{"blackman_harris", blackman_harris, 2.5},
                                         Bell{"blackman_harris", blackman_harris, 4}),
                         [](const auto& bell) { return fmt::format("{}_{}", bell.param.name, bell.index); });

TEST_P(TaaFilter, WeighsSamplesByTheirDistanceFromThePixelsCentre) {
    const std::array<double, 2> jitter_px{0.375, -0.25};
    const Bell bell = GetParam();
    Capture capture = noise(40, 24, 3);
    set_jitter(capture, jitter_px);
    TaaRun run(fmt::format(R"("reconstruction": "{}", "filter_width": {})", bell.name, bell.width_px));
    const Image out = run.color(capture);
    const auto expected = [&](int x, int y) {
        Light sum{};
        double weights = 0;
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
                const double weight = bell.weight(i + jitter_px[0], bell.width_px) *
                                      bell.weight(j + jitter_px[1], bell.width_px);
                const Light sample = texel(capture.images.at("color"), x + i, y + j);
                for (std::size_t c = 0; c < kChannels; ++c) sum[c] += weight * sample[c];
                weights += weight;
            }
        return per_channel([&](std::size_t c) { return sum[c] / weights; });
    };
    EXPECT_LT(farthest(out, expected), 2e-6);
}

// ---- history between pixels ----

/// Catmull and Rom 1974 over 4 x 4 texels without the corners, held to their range.
Light catmull_rom(const Image& image, double x, double y) {
    const auto cubic = [](double d) {
        d = std::abs(d);
        return d < 1   ? 1 - 2.5 * d * d + 1.5 * d * d * d
               : d < 2 ? 2 - 4 * d + 2.5 * d * d - 0.5 * d * d * d
                       : 0.0;
    };
    const int left = int(std::floor(x)), top = int(std::floor(y));
    Light sum{}, least = texel(image, left, top), greatest = least;
    double weights = 0;
    for (int j = -1; j <= 2; ++j)
        for (int i = -1; i <= 2; ++i) {
            if ((i == -1 || i == 2) && (j == -1 || j == 2)) continue;
            const double weight = cubic(x - left - i) * cubic(y - top - j);
            const Light at = texel(image, left + i, top + j);
            weights += weight;
            for (std::size_t c = 0; c < kChannels; ++c) {
                sum[c] += weight * at[c];
                least[c] = std::min(least[c], at[c]);
                greatest[c] = std::max(greatest[c], at[c]);
            }
        }
    return per_channel([&](std::size_t c) { return std::clamp(sum[c] / weights, least[c], greatest[c]); });
}

Light bilinear(const Image& image, double x, double y) {
    const int left = int(std::floor(x)), top = int(std::floor(y));
    return per_channel([&](std::size_t c) {
        const auto row = [&](int j) {
            return std::lerp(texel(image, left, top + j)[c], texel(image, left + 1, top + j)[c], x - left);
        };
        return std::lerp(row(0), row(1), y - top);
    });
}

struct HistoryCase {
    const char* filter;
    Light (*sample)(const Image&, double, double);
    float x_px, y_px;
};

class TaaHistory : public testing::TestWithParam<HistoryCase> {};
INSTANTIATE_TEST_SUITE_P(Motions, TaaHistory,
                         testing::Values(HistoryCase{"catmull_rom", catmull_rom, 0.25f, -1.75f},
                                         HistoryCase{"catmull_rom", catmull_rom, -3.5f, 0.125f},
                                         HistoryCase{"catmull_rom", catmull_rom, 300, 0.5f},
                                         HistoryCase{"bilinear", bilinear, 2.75f, -0.5f}),
                         [](const auto& motion) { return fmt::format("motion_{}", motion.index); });

TEST_P(TaaHistory, IsFoundWhereMotionSaysAndNotTakenFromOutsideThePicture) {
    const HistoryCase test = GetParam();
    const int width = test.x_px > 100 ? 400 : 48, height = 24;
    const Capture a = noise(width, height, 5, 1, 1);
    Capture b = noise(width, height, 6, 1, 2);
    set_velocity(b, test.x_px, test.y_px);
    TaaRun run(kPlain + fmt::format(R"(, "rejection": "none", "history_weight": 0.5, "history_filter": "{}")",
                                    test.filter));
    run.next(a);
    const Image out = run.color(b);
    int outside = 0;
    const auto expected = [&](int x, int y) {
        const double from_x = x - double(test.x_px), from_y = y - double(test.y_px);
        const Light now = texel(b.images.at("color"), x, y);
        if (from_x < -0.5 || from_y < -0.5 || from_x >= width - 0.5 || from_y >= height - 0.5) {
            ++outside;
            return now;
        }
        const Light before = test.sample(a.images.at("color"), from_x, from_y);
        return per_channel([&](std::size_t c) { return 0.5 * (now[c] + before[c]); });
    };
    EXPECT_LT(farthest(out, expected), 2e-5);
    EXPECT_GT(outside, 0);
}

// ---- rejection ----

Light ycocg(const Light& light, bool hdr) {
    const double w = hdr ? karis_weight(light) : 1;
    return {w * luma(light), w * 0.5 * (light[0] - light[2]),
            w * (0.5 * light[1] - 0.25 * (light[0] + light[2])), w * light[3]};
}

Light from_ycocg(const Light& c, bool hdr) {
    const double w = hdr ? 1 - std::max(c[0], 0.0) : 1;
    return {(c[0] + c[1] - c[2]) / w, (c[0] + c[2]) / w, (c[0] - c[1] - c[2]) / w, c[3] / w};
}

struct Range {
    Light low, high;
};

Range range_of(const Image& image, int x, int y, const std::string& mode, double gamma, bool hdr) {
    const Light centre = ycocg(texel(image, x, y), hdr);
    Range range{centre, centre};
    Light mean{}, squares{};
    std::vector<Light> values;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) values.push_back(ycocg(texel(image, x + i, y + j), hdr));
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (const Light& value : values) mean[c] += value[c] / 9;
        for (const Light& value : values) squares[c] += (value[c] - mean[c]) * (value[c] - mean[c]) / 9;
        const double reach = gamma * std::sqrt(squares[c]);
        for (const Light& value : values) {
            const bool variance = mode == "variance_clip";
            range.low[c] = std::min(range.low[c], variance ? mean[c] - reach : value[c]);
            range.high[c] = std::max(range.high[c], variance ? mean[c] + reach : value[c]);
        }
    }
    const double slack = std::max(std::abs(range.low[0]), std::abs(range.high[0])) / 1024;
    for (std::size_t c = 0; c < kChannels; ++c) {
        range.low[c] -= slack;
        range.high[c] += slack;
    }
    return range;
}

Light held(const Light& history, const Range& range, bool clamped, bool hdr) {
    Light value = ycocg(history, hdr);
    double part = 1;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const double middle = 0.5 * (range.low[c] + range.high[c]);
        part = std::min(part, 0.5 * (range.high[c] - range.low[c]) / std::abs(value[c] - middle));
    }
    if (part >= 1) return history;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const double middle = 0.5 * (range.low[c] + range.high[c]);
        value[c] =
            clamped ? std::clamp(value[c], range.low[c], range.high[c]) : middle + part * (value[c] - middle);
    }
    return from_ycocg(value, hdr);
}

class TaaRejection : public testing::TestWithParam<std::tuple<std::string, bool>> {};
INSTANTIATE_TEST_SUITE_P(Modes, TaaRejection,
                         testing::Combine(testing::Values("clamp", "clip", "variance_clip"), testing::Bool()),
                         [](const auto& mode) {
                             return std::get<0>(mode.param) + (std::get<1>(mode.param) ? "_hdr" : "");
                         });

TEST_P(TaaRejection, HoldsHistoryToTheNeighboursNow) {
    const auto [mode, hdr] = GetParam();
    const double gamma = 0.75;
    const Capture a = noise(40, 24, 8, 1.5f, 1), b = noise(40, 24, 9, 1, 2);
    TaaRun run(rejection(mode) +
               fmt::format(R"(, "reconstruction": "none", "gamma": {}, "hdr_weighting": {})", gamma, hdr));
    run.next(a);
    const Image out = run.color(b);
    int changed = 0;
    const auto expected = [&, mode = mode, hdr = hdr](int x, int y) {
        const Light now = texel(b.images.at("color"), x, y), history = texel(a.images.at("color"), x, y);
        const Range range = range_of(b.images.at("color"), x, y, mode, gamma, hdr);
        const Light kept = held(history, range, mode == "clamp", hdr);
        changed += kept != history;
        const double wn = hdr ? karis_weight(now) : 1, wk = hdr ? karis_weight(kept) : 1;
        return per_channel([&](std::size_t c) { return (wn * now[c] + wk * kept[c]) / (wn + wk); });
    };
    EXPECT_LT(farthest(out, expected), 1e-5);
    EXPECT_GT(changed, 40 * 24 / 3);
}

}  // namespace
}  // namespace aftershade::test::taa_equations
