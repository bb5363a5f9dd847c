#include "framework/image/false_color.h"
#include "framework/document/units.h"
#include "framework/image/luminance.h"
#include "framework/image/srgb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <span>

namespace aftershade {

namespace {

/// Every nth pixel, so that the percentiles of a large image stay cheap.
constexpr std::size_t kMostSamples = 1'000'000;

template <class Visit>
void for_some_pixels(const Image& image, Visit visit) {
    const std::size_t pixels = std::size_t(image.width()) * std::size_t(image.height());
    const std::size_t channels = std::size_t(image.channels());
    const std::size_t step = pixels / kMostSamples + 1;
    for (std::size_t i = 0; i < pixels; i += step) visit(&image.floats()[i * channels]);
}

/// The value of the nearest rank; reorders the values.
std::optional<float> percentile(std::vector<float>& values, double fraction) {
    if (values.empty()) return std::nullopt;
    const auto at = values.begin() + std::lround(fraction * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// Three values that producers write where nothing was hit; no normal, and hardly ever a position.
bool is_zero(const float* pixel) {
    return pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0;
}

struct Range {
    float min = 0, max = 0;
};

/// Of the finite values of one channel; nullopt where there is none.
std::optional<Range> finite_range(const Image& image, int channel) {
    std::optional<Range> range;
    const std::size_t channels = std::size_t(image.channels());
    for (std::size_t i = std::size_t(channel); i < image.floats().size(); i += channels) {
        const float value = image.floats()[i];
        if (!std::isfinite(value)) continue;
        if (!range) range = Range{value, value};
        range->min = std::min(range->min, value);
        range->max = std::max(range->max, value);
    }
    return range;
}

float srgb_encoded(float linear) {
    const float clamped = std::clamp(linear, 0.0f, 1.0f);
    return float(encode_srgb(clamped));
}

DisplayColor hue_color(float turns, float saturation, float value) {
    DisplayColor color{};
    for (int c = 0; c < 3; ++c) {
        const float phase = turns + float(c == 0 ? 3 : c == 1 ? 1 : 2) / 3;  // red at 0 turns
        const float k = std::abs((phase - std::floor(phase)) * 6 - 3) - 1;
        color[std::size_t(c)] = value * (1 + saturation * (std::clamp(k, 0.0f, 1.0f) - 1));
    }
    return color;
}

/// Stops as 0xrrggbb at even distances, t in 0..1.
DisplayColor between(std::span<const std::uint32_t> stops, float t) {
    const float at = std::clamp(t, 0.0f, 1.0f) * float(stops.size() - 1);
    const std::size_t stop = std::min(std::size_t(at), stops.size() - 2);
    DisplayColor color{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto component = [&](std::uint32_t rgb) { return float((rgb >> (16 - 8 * c)) & 255) / 255; };
        color[c] = std::lerp(component(stops[stop]), component(stops[stop + 1]), at - float(stop));
    }
    return color;
}

}  // namespace

std::string_view pixel_fault_name(PixelFault fault) {
    constexpr std::array names = {"sound", "negative", "Inf", "NaN"};
    return names[std::size_t(fault)];
}

DisplayColor pixel_fault_color(PixelFault fault) {
    constexpr std::array<DisplayColor, 4> colors = {
        {{0, 0, 0}, {FALSE_COLOR_NEGATIVE}, {FALSE_COLOR_INFINITE}, {FALSE_COLOR_NAN}}};
    return colors[std::size_t(fault)];
}

DisplayColor ramp_color(float t) {
    constexpr std::uint32_t stops[] = {FALSE_COLOR_RAMP};
    return between(stops, t);
}

DisplayColor wheel_color(float x, float y) {
    const float length = std::hypot(x, y);
    if (!(length > 0)) return {0, 0, 0};
    const float turns = std::atan2(y, x) / (2 * std::numbers::pi_v<float>);
    // The square root keeps slow motion beside fast motion in sight.
    return hue_color(turns, length > 1 ? 1 / length : 1, std::sqrt(std::min(length, 1.0f)));
}

DisplayColor diverging_color(float t) {
    constexpr std::uint32_t stops[] = {FALSE_COLOR_DIVERGING};
    return between(stops, std::clamp(t, -1.0f, 1.0f) * 0.5f + 0.5f);
}

DisplayColor id_color(std::uint32_t id) {
    if (id == 0) return {0, 0, 0};
    const std::uint32_t hash = id * 2654435769u;
    const float turns = float(hash) / 4294967296.0f;
    return hue_color(turns, hash & 64 ? 0.55f : 0.85f, hash & 128 ? 0.95f : 0.7f);
}

FalseColor::Kind FalseColor::kind_of(const std::string& role, RoleKind role_kind, const Image& image) {
    if (image.type() == ComponentType::uint32) return Kind::ids;
    switch (role_kind) {
        case RoleKind::distance: return Kind::depth;
        case RoleKind::motion: return Kind::velocity;
        case RoleKind::direction: return Kind::normal;
        case RoleKind::place: return Kind::position;
        case RoleKind::light:
        case RoleKind::id:
        case RoleKind::coverage:
        case RoleKind::display:
        case RoleKind::other: break;
    }
    if (role == kDataRole && image.channels() == 2) return Kind::velocity;
    if (role == kDataRole && image.channels() == 1) {
        const auto values = image.floats();
        const bool any_below = std::any_of(values.begin(), values.end(), [](float v) { return v < 0; });
        return any_below ? Kind::signed_data : Kind::data;
    }
    return image.channels() >= 3 ? Kind::color : Kind::grey;
}

FalseColor::FalseColor(const std::string& role, const Image& image, const Chromaticities& primaries)
    : FalseColor(role, find_role(role), image, primaries) {}

FalseColor::FalseColor(const std::string& role, const std::optional<ChannelRole>& contract,
                       const Image& image, const Chromaticities& primaries)
    : image_(image),
      kind_(kind_of(role, contract ? contract->kind : RoleKind::other, image)),
      may_be_negative_(kind_ == Kind::velocity || kind_ == Kind::normal || kind_ == Kind::position ||
                       !contract || contract->kind == RoleKind::other),
      may_be_infinite_(kind_ == Kind::depth) {
    count_faults();
    switch (kind_) {
        case Kind::color: fit_color(contract && contract->is_share, primaries); break;
        case Kind::depth: fit_depth(); break;
        case Kind::velocity: fit_velocity(); break;
        case Kind::normal: label_ = {"world space, -1 to 1", "x red, y green, z blue"}; break;
        case Kind::position: fit_position(); break;
        case Kind::ids: fit_ids(); break;
        case Kind::grey: fit_grey(); break;
        case Kind::signed_data:
        case Kind::data: fit_data(); break;
    }
}

void FalseColor::count_faults() {
    for (int y = 0; y < image_.height(); ++y)
        for (int x = 0; x < image_.width(); ++x) ++fault_counts_[std::size_t(fault(x, y))];
}

void FalseColor::fit_color(bool is_share, const Chromaticities& primaries) {
    const Chromaticities rec709 = *color_space_primaries("rec709");
    if (primaries != Chromaticities{} && primaries != rec709)
        to_rec709_ = conversion_matrix(primaries, rec709);
    // Reinhard et al. 2002: the geometric mean of what is lit becomes middle grey ...
    std::vector<float> lit;
    double sum_of_logs = 0;
    for_some_pixels(image_, [&](const float* pixel) {
        const float y = luminance(pixel);
        if (!std::isfinite(y) || y < 1e-6f) return;
        lit.push_back(y);
        sum_of_logs += std::log(y);
    });
    float brightest = 0;
    for (int c = 0; c < 3; ++c)
        if (const auto range = finite_range(image_, c)) brightest = std::max(brightest, range->max);
    label_[0] = fmt::format("up to {:.4g}", brightest);
    if (is_share) {
        label_[1] = "linear, 0 to 1 as it is";
        return;
    }
    double stops = 0;
    if (!lit.empty()) {
        stops = std::log2(0.18 / std::exp(sum_of_logs / double(lit.size())));
        // ... but no more than a twentieth of it may burn out.
        const double bright = double(*percentile(lit, 0.95));
        stops = std::min(stops, -std::log2(bright));
    }
    // What is written down is what was done: tenths of a stop.
    stops = std::round(stops * 10) / 10;
    exposure_ = float(std::exp2(stops));
    label_[1] = fmt::format("linear, shown at {:+.1f} EV (auto)", stops);
}

void FalseColor::fit_depth() {
    std::vector<float> depths;
    std::uint64_t nothing_hit = 0, zero = 0;
    std::optional<Range> range;
    for (const float depth : image_.floats()) {
        zero += depth == 0;
        nothing_hit += depth == std::numeric_limits<float>::infinity();
        if (!std::isfinite(depth) || depth <= 0) continue;
        if (!range) range = Range{depth, depth};
        range->min = std::min(range->min, depth);
        range->max = std::max(range->max, depth);
    }
    for_some_pixels(image_, [&](const float* pixel) {
        if (std::isfinite(*pixel) && *pixel > 0) depths.push_back(*pixel);
    });
    const auto percent = [&](std::uint64_t count) {
        return 100 * double(count) / double(image_.floats().size());
    };
    label_[1] = fmt::format("nothing hit: {:.3g} %", percent(nothing_hit));
    if (zero > 0) label_[1] += fmt::format(", 0 m: {:.3g} %", percent(zero));
    if (!range) {
        label_[0] = "no surface";
        return;
    }
    // A few far pixels must not take the ramp from all others.
    low_[0] = std::log(percentile(depths, 0.005).value_or(range->min));
    high_[0] = std::log(percentile(depths, 0.98).value_or(range->max));
    label_[0] = fmt::format("{:.4g} to {:.4g} m", range->min, range->max);
}

void FalseColor::fit_velocity() {
    std::vector<float> lengths;
    for_some_pixels(image_, [&](const float* pixel) {
        const float length = std::hypot(pixel[0], pixel[1]);
        if (std::isfinite(length)) lengths.push_back(length);
    });
    const float longest = percentile(lengths, 1).value_or(0), most = percentile(lengths, 0.995).value_or(0);
    constexpr float kLeastRim_px = 0.1f;  // less is rounding
    const float rim = std::max(most > 0 ? most : longest, kLeastRim_px);
    longest_px_ = float(parse_number(fmt::format("{:.2g}", rim)).value_or(rim));
    label_ = {fmt::format("up to {:.4g} px a frame", longest),
              fmt::format("rim of the wheel: {:g} px", longest_px_)};
}

void FalseColor::fit_position() {
    constexpr const char* axes[] = {"x", "y", "z"};
    std::array<std::string, 3> ranges;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<float> values;
        for_some_pixels(image_, [&](const float* pixel) {
            if (std::isfinite(pixel[axis]) && !is_zero(pixel)) values.push_back(pixel[axis]);
        });
        low_[axis] = percentile(values, 0.01).value_or(0);
        high_[axis] = percentile(values, 0.99).value_or(1);
        const Range range = finite_range(image_, int(axis)).value_or(Range{});
        ranges[axis] = fmt::format("{} {:.3g} to {:.3g}", axes[axis], range.min, range.max);
    }
    label_ = {ranges[0] + ", " + ranges[1] + ",", ranges[2] + " m (red, green, blue)"};
}

void FalseColor::fit_ids() {
    const std::set<std::uint32_t> ids(image_.uints().begin(), image_.uints().end());
    constexpr std::size_t kNamed = 8;
    std::string text;
    for (const std::uint32_t id : ids) {
        if (id == 0) continue;
        text += (text.empty() ? "" : " ") + std::to_string(id);
        if (text.size() > kNamed * 4) break;
    }
    const std::size_t count = ids.size() - ids.count(0);
    label_ = {fmt::format("{} {}{}{}", count, count == 1 ? "id" : "ids", count > 0 ? ": " : "", text),
              "a colour each, 0 is black"};
}

void FalseColor::fit_grey() {
    const Range range = finite_range(image_, 0).value_or(Range{});
    // A mask has a scale of its own; what passes through does not.
    if (may_be_negative_ || range.max > 1) low_[0] = range.min, high_[0] = range.max;
    label_ = {fmt::format("{:.4g} to {:.4g}", range.min, range.max),
              fmt::format("black is {:.4g}, white {:.4g}", low_[0], high_[0])};
}

void FalseColor::fit_data() {
    const Range range = finite_range(image_, 0).value_or(Range{});
    high_[0] = std::max(std::abs(range.min), std::abs(range.max));
    low_[0] = kind_ == Kind::signed_data ? -high_[0] : 0;
    label_ = {fmt::format("{:.4g} to {:.4g}", range.min, range.max),
              kind_ == Kind::signed_data ? fmt::format("blue {:.4g}, white 0, red {:.4g}", low_[0], high_[0])
                                         : fmt::format("dark 0, bright {:.4g}", high_[0])};
}

const float* FalseColor::pixel(int x, int y) const {
    const std::size_t index = std::size_t(y) * std::size_t(image_.width()) + std::size_t(x);
    return &image_.floats()[index * std::size_t(image_.channels())];
}

float FalseColor::luminance(const float* pixel) const {
    double y = 0;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            y += kRec709Luminance[row] * to_rec709_[row * 3 + column] * double(pixel[column]);
    return float(y);
}

PixelFault FalseColor::fault(int x, int y) const {
    if (kind_ == Kind::ids) return PixelFault::none;
    PixelFault worst = PixelFault::none;
    const float* values = pixel(x, y);
    for (int c = 0; c < image_.channels(); ++c) {
        const float value = values[c];
        PixelFault fault = PixelFault::none;
        if (std::isnan(value)) fault = PixelFault::nan;
        else if (std::isinf(value) && !(may_be_infinite_ && value > 0)) fault = PixelFault::infinite;
        else if (value < 0 && !may_be_negative_) fault = PixelFault::negative;
        worst = std::max(worst, fault);
    }
    return worst;
}

DisplayColor FalseColor::exposed(const float* pixel) const {
    DisplayColor color{};
    for (std::size_t row = 0; row < 3; ++row) {
        double linear = 0;
        for (std::size_t column = 0; column < 3; ++column)
            linear += to_rec709_[row * 3 + column] * double(pixel[column]);
        color[row] = srgb_encoded(float(linear) * exposure_);
    }
    return color;
}

DisplayColor FalseColor::scaled(const float* pixel) const {
    DisplayColor color{};
    for (std::size_t c = 0; c < 3; ++c) {
        const float span = high_[c] - low_[c];
        color[c] = span > 0 ? std::clamp((pixel[c] - low_[c]) / span, 0.0f, 1.0f) : 0.5f;
    }
    return color;
}

DisplayColor FalseColor::color(int x, int y) const {
    if (const PixelFault found = fault(x, y); found != PixelFault::none) return pixel_fault_color(found);
    if (kind_ == Kind::ids) return id_color(image_.uint_at(x, y, 0));
    const float* values = pixel(x, y);
    switch (kind_) {
        case Kind::depth: {
            if (std::isinf(values[0])) return kNothingHitColor;
            if (values[0] == 0) return {0, 0, 0};  // against the contract, so it must not pass for near
            const float span = high_[0] - low_[0];
            return ramp_color(span > 0 ? 1 - (std::log(std::max(values[0], 1e-30f)) - low_[0]) / span : 1);
        }
        case Kind::velocity: return wheel_color(values[0] / longest_px_, values[1] / longest_px_);
        case Kind::normal:
            if (is_zero(values)) return {0, 0, 0};
            return {values[0] / 2 + 0.5f, values[1] / 2 + 0.5f, values[2] / 2 + 0.5f};
        case Kind::position: return is_zero(values) ? DisplayColor{} : scaled(values);
        case Kind::grey: {
            const float span = high_[0] - low_[0];
            const float grey = span > 0 ? (values[0] - low_[0]) / span : 0.5f;
            return {grey, grey, grey};
        }
        case Kind::signed_data: return diverging_color(high_[0] > 0 ? values[0] / high_[0] : 0);
        case Kind::data: return ramp_color(high_[0] > 0 ? values[0] / high_[0] : 0);
        default: return exposed(values);
    }
}

Legend FalseColor::legend() const {
    if (kind_ == Kind::depth) return Legend::ramp;
    return kind_ == Kind::velocity ? Legend::wheel : Legend::none;
}

}  // namespace aftershade
