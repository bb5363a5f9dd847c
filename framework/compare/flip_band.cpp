#include "framework/compare/flip_band.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace aftershade {

namespace {

// Andersson et al. 2020, table 1 and section 4.
constexpr float kColorExponent = 0.7f;       // q_c
constexpr float kColorCut = 0.4f;            // p_c
constexpr float kColorCutError = 0.95f;      // p_t
constexpr float kFeatureWidth_deg = 0.082f;  // w
constexpr float kPi = std::numbers::pi_v<float>;

/// Amplitude and scale of a contrast sensitivity function in the spatial domain.
struct Gaussian {
    float a, b;
    float height() const { return a * std::sqrt(kPi / b); }
    float at(float x_deg) const { return std::exp(-(kPi * kPi) * x_deg * x_deg / b); }
};
constexpr Gaussian kCsfY = {1, 0.0047f}, kCsfCx = {1, 0.0053f}, kCsfCz1 = {34.1f, 0.04f},
                   kCsfCz2 = {13.5f, 0.025f};

void normalize(std::vector<float>& weights, float sum) {
    for (float& weight : weights) weight /= sum;
}

float sum_of(const std::vector<float>& weights) {
    float sum = 0;
    for (const float weight : weights) sum += weight;
    return sum;
}

/// Positive weights sum to 1 and negative ones to -1.
void balance(std::vector<float>& weights) {
    float positive = 0, negative = 0;
    for (const float weight : weights) (weight > 0 ? positive : negative) += std::abs(weight);
    for (float& weight : weights) weight /= weight > 0 ? positive : negative;
}

/// HyAB of green and blue after Hunt's adjustment, to the power q_c: the largest colour difference.
float largest_color_difference() {
    const std::array<float, 2> r = {0, 0}, g = {1, 0}, b = {0, 1};
    std::array<float, 2> y, cx, cz, l, a, bb;
    rows::to_ycxcz({r.data(), g.data(), b.data()}, {y.data(), cx.data(), cz.data()}, 2);
    rows::to_hunt_lab({y.data(), cx.data(), cz.data()}, {l.data(), a.data(), bb.data()}, 2);
    const float da = a[0] - a[1], db = bb[0] - bb[1];
    return std::pow(std::abs(l[0] - l[1]) + std::sqrt(da * da + db * db), kColorExponent);
}

/// Differences up to p_c of the largest take most of the range.
float color_error(float difference, float largest) {
    if (difference == 0) return 0;
    const float powered = std::pow(difference, kColorExponent);
    const float cut = kColorCut * largest;
    if (powered < cut) return powered * (kColorCutError / cut);
    return kColorCutError + (powered - cut) / (largest - cut) * (1 - kColorCutError);
}

bool is_finite(const float* pixel) {
    return std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2]);
}

/// Whether two values that are not both finite are the same NaN or infinity.
bool same_not_finite(float reference, float test) {
    return (std::isnan(reference) && std::isnan(test)) || reference == test;
}

}  // namespace

FlipFilters::FlipFilters(float pixels_per_degree) {
    const float widest = std::max(kCsfCz1.b, kCsfCz2.b);
    color_radius = int(std::ceil(3 * std::sqrt(widest / (2 * kPi * kPi)) * pixels_per_degree));
    for (int i = -color_radius; i <= color_radius; ++i) {
        const float x_deg = float(i) * (1 / pixels_per_degree);
        y.push_back(kCsfY.height() * kCsfY.at(x_deg));
        cx.push_back(kCsfCx.height() * kCsfCx.at(x_deg));
        cz1.push_back(std::sqrt(kCsfCz1.height()) * kCsfCz1.at(x_deg));
        cz2.push_back(std::sqrt(kCsfCz2.height()) * kCsfCz2.at(x_deg));
    }
    normalize(y, sum_of(y));
    normalize(cx, sum_of(cx));
    // Both are run across and down, and their sum is to have the weight 1.
    const float sum1 = sum_of(cz1), sum2 = sum_of(cz2);
    const float both = std::sqrt(sum1 * sum1 + sum2 * sum2);
    normalize(cz1, both);
    normalize(cz2, both);

    const float sigma = 0.5f * kFeatureWidth_deg * pixels_per_degree;
    feature_radius = int(std::ceil(3 * sigma));
    for (int i = -feature_radius; i <= feature_radius; ++i) {
        const float x = float(i), g = std::exp(-(x * x) / (2 * sigma * sigma));
        smooth.push_back(g);
        first.push_back(-x * g);
        second.push_back((x * x / (sigma * sigma) - 1) * g);
    }
    normalize(smooth, sum_of(smooth));
    balance(first);
    balance(second);
}

FlipBand::FlipBand(const Image& reference, const Image& test, const FlipFilters& filters)
    : reference_(reference),
      test_(test),
      filters_(filters),
      width_(reference.width()),
      height_(reference.height()),
      radius_(std::max(filters.color_radius, filters.feature_radius)) {
    const auto rows_kept = std::size_t(2 * radius_ + 1);
    ring_.resize(rows_kept * 2 * kPlanes * std::size_t(rows::padded(width_)));
    taps_.resize(rows_kept);
    stored_.fill(row());
    linear_.fill(row());
    filtered_.fill(row());
    opponent_.fill(Row(std::size_t(rows::padded(width_) + 2 * radius_ + rows::kLanes)));
    for (auto& planes : lab_) planes.fill(row());
    for (auto& planes : gradients_) planes.fill(row());
    color_ = feature_ = row();
}

float* FlipBand::ring_row(std::size_t which, Plane plane, int y) {
    const auto slot = std::size_t(y % (2 * radius_ + 1));
    return ring_.data() +
           ((slot * 2 + which) * kPlanes + std::size_t(plane)) * std::size_t(rows::padded(width_));
}

/// linear_ of a row: black where either image is not finite, exposed, within [0, 1].
void FlipBand::load(const Image& image, int y, const FlipExposure& exposure) {
    const std::size_t begin = std::size_t(y) * std::size_t(width_) * 3;
    const float* pixel = image.floats().data() + begin;
    const float* of_reference = reference_.floats().data() + begin;
    const float* of_test = test_.floats().data() + begin;
    for (std::size_t x = 0; x < std::size_t(width_); ++x) {
        const bool usable = is_finite(of_reference + 3 * x) && is_finite(of_test + 3 * x);
        for (std::size_t c = 0; c < 3; ++c) stored_[c][x] = usable ? pixel[3 * x + c] : 0;
    }
    const rows::ConstPlanes in = {stored_[0].data(), stored_[1].data(), stored_[2].data()};
    const rows::Planes out = {linear_[0].data(), linear_[1].data(), linear_[2].data()};
    if (!exposure.map) {
        for (std::size_t c = 0; c < 3; ++c)
            std::ranges::transform(stored_[c], linear_[c].begin(),
                                   [](float value) { return std::clamp(value, 0.0f, 1.0f); });
    } else if (exposure.mapper == ToneMapper::reinhard) {
        rows::expose_and_divide(in, exposure.scale, out, width_);
    } else {
        rows::expose_and_map(in, exposure.scale, tone_mapper_coefficients(exposure.mapper).data(), out,
                             width_);
    }
}

void FlipBand::filter_across(const Image& image, int y, const FlipExposure& exposure, std::size_t which) {
    load(image, y, exposure);
    std::array<float*, 3> middle;
    for (std::size_t c = 0; c < 3; ++c) middle[c] = opponent_[c].data() + radius_;
    rows::to_ycxcz({linear_[0].data(), linear_[1].data(), linear_[2].data()},
                   {middle[0], middle[1], middle[2]}, width_);
    for (std::size_t c = 0; c < 3; ++c) {
        std::fill(opponent_[c].data(), middle[c], middle[c][0]);
        std::fill(middle[c] + width_, opponent_[c].data() + opponent_[c].size(), middle[c][width_ - 1]);
    }
    const auto across = [&](std::size_t c, const std::vector<float>& weights, int radius, Plane plane) {
        rows::convolve(middle[c] - radius, weights, ring_row(which, plane, y), width_);
    };
    const int color = filters_.color_radius, feature = filters_.feature_radius;
    across(0, filters_.y, color, kY);
    across(1, filters_.cx, color, kCx);
    across(2, filters_.cz1, color, kCz1);
    across(2, filters_.cz2, color, kCz2);
    // Features are those of the achromatic channel in 0..1.
    for (float& value : opponent_[0]) value = value * (1.0f / 116.0f) + 16.0f / 116.0f;
    across(0, filters_.smooth, feature, kSmooth);
    across(0, filters_.first, feature, kFirst);
    across(0, filters_.second, feature, kSecond);
}

void FlipBand::filter_down(std::size_t which, Plane plane, const std::vector<float>& weights, int radius,
                           int y, float* out) {
    for (int i = -radius; i <= radius; ++i)
        taps_[std::size_t(i + radius)] = ring_row(which, plane, std::clamp(y + i, 0, height_ - 1));
    rows::convolve_down(taps_.data(), weights, out, width_);
}

void FlipBand::filter_colors(std::size_t which, int y) {
    auto& [luma, cx, cz, more] = filtered_;
    const int radius = filters_.color_radius;
    filter_down(which, kY, filters_.y, radius, y, luma.data());
    filter_down(which, kCx, filters_.cx, radius, y, cx.data());
    filter_down(which, kCz1, filters_.cz1, radius, y, cz.data());
    filter_down(which, kCz2, filters_.cz2, radius, y, more.data());
    for (std::size_t x = 0; x < std::size_t(width_); ++x) cz[x] += more[x];
    auto& [l, a, b] = lab_[which];
    rows::to_hunt_lab({luma.data(), cx.data(), cz.data()}, {l.data(), a.data(), b.data()}, width_);
}

rows::Gradients FlipBand::filter_features(std::size_t which, int y) {
    auto& [dx, dy, ddx, ddy] = gradients_[which];
    const int radius = filters_.feature_radius;
    filter_down(which, kFirst, filters_.smooth, radius, y, dx.data());
    filter_down(which, kSmooth, filters_.first, radius, y, dy.data());
    filter_down(which, kSecond, filters_.smooth, radius, y, ddx.data());
    filter_down(which, kSmooth, filters_.second, radius, y, ddy.data());
    return {dx.data(), dy.data(), ddx.data(), ddy.data()};
}

void FlipBand::combine(int y, Image& error) {
    static const float largest = largest_color_difference();
    for (std::size_t which = 0; which < 2; ++which) filter_colors(which, y);
    rows::distance({lab_[0][0].data(), lab_[0][1].data(), lab_[0][2].data()},
                   {lab_[1][0].data(), lab_[1][1].data(), lab_[1][2].data()}, color_.data(), width_);
    const rows::Gradients of_reference = filter_features(0, y), of_test = filter_features(1, y);
    rows::feature_difference(of_reference, of_test, feature_.data(), width_);
    for (int x = 0; x < width_; ++x) {
        const auto i = std::size_t(x);
        const float color = color_error(color_[i], largest);
        float flip = color == 0 && feature_[i] < 1 ? 0 : std::pow(color, 1 - feature_[i]);
        const float* r = &reference_.floats()[(std::size_t(y) * std::size_t(width_) + i) * 3];
        const float* t = &test_.floats()[(std::size_t(y) * std::size_t(width_) + i) * 3];
        if (!is_finite(r) || !is_finite(t)) {
            const auto same = [&](int c) { return same_not_finite(r[c], t[c]); };
            flip = same(0) && same(1) && same(2) ? 0.0f : 1.0f;
        }
        error.at(x, y, 0) = std::max(error.at(x, y, 0), flip);
    }
}

void FlipBand::add(int first, int last, const FlipExposure& exposure, Image& error) {
    int filtered = std::max(first - radius_, 0);
    for (int y = first; y < last; ++y) {
        for (; filtered <= std::min(y + radius_, height_ - 1); ++filtered) {
            filter_across(reference_, filtered, exposure, 0);
            filter_across(test_, filtered, exposure, 1);
        }
        combine(y, error);
    }
}

namespace {

constexpr std::array<std::string_view, 3> kToneMapperNames = {"aces", "reinhard", "hable"};

}  // namespace

std::string_view tone_mapper_name(ToneMapper mapper) {
    return kToneMapperNames[std::size_t(mapper)];
}

std::optional<ToneMapper> find_tone_mapper(std::string_view name) {
    const auto found = std::ranges::find(kToneMapperNames, name);
    if (found == kToneMapperNames.end()) return std::nullopt;
    return ToneMapper(found - kToneMapperNames.begin());
}

std::vector<std::string> tone_mapper_names() {
    return {kToneMapperNames.begin(), kToneMapperNames.end()};
}

const std::array<float, 6>& tone_mapper_coefficients(ToneMapper mapper) {
    static constexpr std::array<float, 6> aces = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0,
                                                  0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};
    static constexpr std::array<float, 6> hable = {0.231683f, 0.013791f, 0, 0.18f, 0.3f, 0.018f};
    return mapper == ToneMapper::hable ? hable : aces;
}

}  // namespace aftershade
