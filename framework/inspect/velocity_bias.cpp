#include "framework/inspect/velocity_bias.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>

namespace aftershade {

namespace {

constexpr double kHalfway = 0.5;         // the bias of vectors that are stored in 0 to 1
constexpr double kByteStep = 1.0 / 255;  // so far from it may the bias of bytes lie: 127 and 128 of 255
constexpr double kCommonShare = 0.1;     // of the pixels
constexpr double kPileShare = 0.0005;    // of the pixels; motion that is not clamped rarely ends in one value
constexpr std::size_t kLeastPile_px = 16;
constexpr double kKeySteps = 65536;  // a decoded value differs from the stored one by rounding
constexpr double kLargestHalf = 65504;

std::array<double, 2> gain_of(const Image& image, const VelocitySettings& settings) {
    const double part = settings.unit == "ndc" ? 0.5 : 1;
    const bool px = settings.unit == "px";
    const bool reversed = settings.delta == "prev-cur" || settings.delta == "cur-next";
    const double per_frame = (reversed ? -1 : 1) / settings.shutter_frames;
    return {(px ? 1 : part * image.width()) * settings.scale[0] * per_frame,
            (px ? 1 : part * image.height()) * settings.scale[1] * per_frame *
                (settings.y_axis == "up" ? -1 : 1)};
}

struct Limits {
    double low = 0, high = 0;
};

/// Of the range that a producer can have clamped to.
Limits limits_of(const VelocitySettings& settings) {
    if (settings.unit == "px" && settings.bias == 0) return {-kLargestHalf, kLargestHalf};
    return settings.bias > 0 ? Limits{0, std::max(1.0, std::round(2 * settings.bias))} : Limits{-1, 1};
}

bool is_at(double value, double limit) {
    return std::abs(value - limit) <= 1e-6 * std::max(1.0, std::abs(limit));
}

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    double largest() const { return std::max(std::abs(low), std::abs(high)); }
};

Range range_of(const std::vector<Image>& images) {
    Range range;
    for (const Image& image : images)
        for (const float value : image.floats())
            if (std::isfinite(value)) {
                range.low = std::min(range.low, double(value));
                range.high = std::max(range.high, double(value));
            }
    return range;
}

/// The vector of most pixels, where both its components are one value.
std::optional<double> common_value(const std::vector<Image>& images) {
    std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> counts;
    std::size_t pixels = 0;
    for (const Image& image : images) {
        const std::span<const float> values = image.floats();
        const std::size_t channels = std::size_t(image.channels());
        for (std::size_t i = 0; i + 1 < values.size(); i += channels, ++pixels) {
            const double x = double(values[i]), y = double(values[i + 1]);
            // Larger values cannot be keys, and none of them is a bias.
            if (!(std::abs(x) <= kLargestHalf && std::abs(y) <= kLargestHalf)) continue;
            ++counts[{std::llround(x * kKeySteps), std::llround(y * kKeySteps)}];
        }
    }
    const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
    if (most == counts.end() || double(most->second) < kCommonShare * double(pixels)) return std::nullopt;
    const auto [x, y] = most->first;
    return std::abs(x - y) <= 1 ? std::optional(double(x) / kKeySteps) : std::nullopt;
}

/// Digits of a bias as a person would write them.
double rounded(double bias) {
    return std::abs(bias - kHalfway) < 1e-4 ? kHalfway : std::round(bias * 1e4) / 1e4;
}

}  // namespace

Image stored_vectors(const Image& decoded, const VelocitySettings& settings) {
    Image stored(decoded.width(), decoded.height(), 2);
    const auto gain = gain_of(decoded, settings);
    for (int y = 0; y < decoded.height(); ++y)
        for (int x = 0; x < decoded.width(); ++x)
            for (int c = 0; c < 2; ++c)
                stored.at(x, y, c) =
                    float(double(decoded.at(x, y, c)) / gain[std::size_t(c)] + settings.bias);
    return stored;
}

Image read_vectors(const Image& stored, const VelocitySettings& settings) {
    Image vectors(stored.width(), stored.height(), 2);
    const auto gain = gain_of(stored, settings);
    const Limits limits = limits_of(settings);
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (int y = 0; y < stored.height(); ++y)
        for (int x = 0; x < stored.width(); ++x)
            for (int c = 0; c < 2; ++c) {
                const double value = double(stored.at(x, y, c));
                const bool is_clamped = is_at(value, limits.low) || is_at(value, limits.high);
                vectors.at(x, y, c) =
                    is_clamped ? kNone : float((value - settings.bias) * gain[std::size_t(c)]);
            }
    return vectors;
}

std::vector<OtherReading> other_readings(const std::vector<Image>& stored, const VelocitySettings& claim) {
    std::vector<OtherReading> readings;
    const Range range = range_of(stored);
    if (!(range.low < range.high)) return readings;
    const std::optional<double> common = common_value(stored);
    const auto add = [&](const char* unit, double bias, bool is_common) {
        VelocitySettings settings = claim;
        // A scale belongs to its unit.
        if (settings.unit != unit) settings.scale = {1, 1};
        settings.unit = unit;
        settings.bias = rounded(bias);
        if (settings != claim) readings.push_back({settings, is_common});
    };
    const bool px = claim.unit == "px";
    const char* const part = px ? "uv" : claim.unit.c_str();
    const bool common_is_halfway = common && std::abs(*common - kHalfway) <= kByteStep;
    // v / W + 0.5 passes 0 and 1 where it is not clamped, as pixels leave the picture.
    const bool may_be_halfway = range.low > -1.5 && range.high < 2.5 && range.high > 0.5;
    if (claim.bias == 0 && may_be_halfway && range.largest() <= 2.5)
        add(part, common_is_halfway ? *common : kHalfway, false);
    if (common && *common > 0.25 && std::abs(*common - claim.bias) > 2 * kByteStep)
        add(claim.unit.c_str(), *common, true);
    if (claim.bias != 0) add(claim.unit.c_str(), 0, common && std::abs(*common) < 1 / kKeySteps);
    if (px && range.largest() <= 1) add("uv", 0, false);
    if (!px && range.largest() > 2.5) add("px", 0, false);
    return readings;
}

std::string describe_limit(const std::vector<Image>& stored, const VelocitySettings& settings) {
    const Limits limits = limits_of(settings);
    const Range range = range_of(stored);
    std::size_t pixels = 0, at_low = 0, at_high = 0;
    for (const Image& image : stored) {
        const std::span<const float> values = image.floats();
        pixels += values.size() / 2;
        for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
            at_low += is_at(double(values[i]), limits.low) || is_at(double(values[i + 1]), limits.low);
            at_high += is_at(double(values[i]), limits.high) || is_at(double(values[i + 1]), limits.high);
        }
    }
    const double least = std::max(double(kLeastPile_px), kPileShare * double(pixels));
    // Values beyond a limit show that nothing was clamped to it.
    const bool low = double(at_low) >= least && is_at(range.low, limits.low);
    const bool high = double(at_high) >= least && is_at(range.high, limits.high);
    if (!low && !high) return "";
    return fmt::format("{} pixels of the two frames are stored as {}, the end of the range {:g} to {:g}",
                       (low ? at_low : 0) + (high ? at_high : 0),
                       low && high ? fmt::format("{:g} or {:g}", limits.low, limits.high)
                                   : fmt::format("{:g}", low ? limits.low : limits.high),
                       limits.low, limits.high);
}

}  // namespace aftershade
