#include "framework/inspect/velocity_warp.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace aftershade {

namespace {

constexpr int kMaxSamples = 20000;
constexpr std::size_t kRoughStride = 10;
constexpr std::size_t kRoughSamples = 1000;  // at least, where there are as many
constexpr int kMinMovingPx = 64;             // fewer moving pixels tell nothing: an edge of noise has as many
constexpr std::size_t kMinCompared = 16;     // samples of a dispute in time
constexpr double kMinDisputed = 0.01;        // share of the samples
constexpr double kSameSurface_px = 0.5;      // vectors of one surface differ by less, ...
constexpr double kSameSurface = 0.1;         // ... or by this share of their length
constexpr double kMinInside = 0.3;           // share of the samples; a score from fewer is worth less
constexpr double kWeightLimit =
    0.1;  // of the diagonal: longer vectors weigh no more, so that a few wild ones do not rule

using Texel = std::array<float, 4>;

float tone(float value, double pivot) {
    if (std::isinf(value) && value > 0) return 1;
    const double positive = std::max(double(value), 0.0);
    return float(positive / (positive + pivot));
}

Texel blend(const Texel& before, const Texel& here, const Texel& after) {
    Texel sum;
    for (std::size_t c = 0; c < 4; ++c) sum[c] = 0.25f * (before[c] + 2 * here[c] + after[c]);
    return sum;
}

/// 1 2 1 along both axes, the edges repeated; whole rows at a time, as memory lies.
void blur(ComparedFrame& frame) {
    const std::size_t width = std::size_t(frame.width), height = std::size_t(frame.height);
    std::vector<Texel> above, copy(width);
    for (std::size_t y = 0; y < height; ++y) {
        Texel* row = &frame.texels[y * width];
        std::copy(row, row + width, copy.begin());
        for (std::size_t x = 0; x < width; ++x)
            row[x] = blend(copy[x > 0 ? x - 1 : 0], copy[x], copy[std::min(x + 1, width - 1)]);
    }
    above.assign(frame.texels.begin(), frame.texels.begin() + std::ptrdiff_t(width));
    for (std::size_t y = 0; y < height; ++y) {
        Texel* row = &frame.texels[y * width];
        const Texel* below = y + 1 < height ? row + width : row;
        for (std::size_t x = 0; x < width; ++x) {
            const Texel here = row[x];
            row[x] = blend(above[x], here, below[x]);
            above[x] = here;
        }
    }
}

bool is_usable(const Image& color, int x, int y) {
    for (int c = 0; c < 3; ++c) {
        const float value = color.at(x, y, c);
        if (std::isnan(value) || (std::isinf(value) && value < 0)) return false;
    }
    return true;
}

}  // namespace

double median_luminance(const Image& color_a, const Image& color_b, const Chromaticities& primaries) {
    const auto [red, green, blue] = luminance_weights(primaries);
    std::vector<float> values;
    for (const Image* color : {&color_a, &color_b})
        for (int y = 0; y < color->height(); ++y)
            for (int x = 0; x < color->width(); ++x) {
                const float luminance = float(red) * color->at(x, y, 0) + float(green) * color->at(x, y, 1) +
                                        float(blue) * color->at(x, y, 2);
                if (luminance > 0 && std::isfinite(luminance)) values.push_back(luminance);
            }
    if (values.empty()) return 1;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

ComparedFrame make_compared(const Image& color, double pivot) {
    ComparedFrame frame{color.width(), color.height(), {}};
    frame.texels.resize(std::size_t(frame.width) * std::size_t(frame.height));
    std::vector<bool> usable(frame.texels.size());
    for (int y = 0; y < frame.height; ++y)
        for (int x = 0; x < frame.width; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(frame.width) + std::size_t(x);
            usable[i] = is_usable(color, x, y);
            if (!usable[i]) continue;
            for (int c = 0; c < 3; ++c) frame.texels[i][std::size_t(c)] = tone(color.at(x, y, c), pivot);
            frame.texels[i][3] = 1;
        }
    for (int pass = 0; pass < 2; ++pass) blur(frame);
    for (std::size_t i = 0; i < frame.texels.size(); ++i) {
        Texel& texel = frame.texels[i];
        const float weight = texel[3];
        for (std::size_t c = 0; c < 3 && weight > 0; ++c) texel[c] /= weight;
        texel[3] = usable[i] ? 1.0f : weight > 0 ? 0.0f : -1.0f;
    }
    return frame;
}

WarpTest::WarpTest(const ComparedFrame& source, const ComparedFrame& target, const Image& vectors,
                   double direction)
    : target_(target), vectors_(vectors), direction_(direction) {
    const std::vector<float> weights = weigh(source, vectors);
    if (moving_px_ >= kMinMovingPx) draw_samples(source, vectors, weights);
}

/// The length of each vector, limited; 0 where there is nothing to follow.
std::vector<float> WarpTest::weigh(const ComparedFrame& source, const Image& vectors) {
    std::vector<float> weights(source.texels.size());
    const double diagonal_px = std::hypot(source.width, source.height);
    for (int y = 0; y < source.height; ++y)
        for (int x = 0; x < source.width; ++x) {
            const double length_px = std::hypot(double(vectors.at(x, y, 0)), double(vectors.at(x, y, 1)));
            if (!(length_px <= diagonal_px)) continue;
            longest_px_ = std::max(longest_px_, length_px);
            if (length_px < 1 || source.at(x, y)[3] != 1) continue;
            ++moving_px_;
            weights[std::size_t(y) * std::size_t(source.width) + std::size_t(x)] =
                float(std::min(length_px, kWeightLimit * diagonal_px));
        }
    return weights;
}

/// Systematic sampling: one sample each time the running sum of the weights passes another step.
void WarpTest::draw_samples(const ComparedFrame& source, const Image& vectors,
                            const std::vector<float>& weights) {
    double total = 0;
    for (const float weight : weights) total += weight;
    const double step = total / std::min(2 * moving_px_, kMaxSamples);
    double sum = 0, next = 0.5 * step;
    for (int y = 0; y < source.height; ++y)
        for (int x = 0; x < source.width; ++x) {
            sum += weights[std::size_t(y) * std::size_t(source.width) + std::size_t(x)];
            for (; next < sum; next += step) {
                const Texel& texel = source.at(x, y);
                const Texel& still = target_.at(x, y);
                if (still[3] < 0) continue;
                Sample sample{float(x),
                              float(y),
                              vectors.at(x, y, 0),
                              vectors.at(x, y, 1),
                              {texel[0], texel[1], texel[2]},
                              0};
                for (std::size_t c = 0; c < 3; ++c) sample.still_error += std::abs(texel[c] - still[c]) / 3;
                samples_.push_back(sample);
            }
        }
}

/// Negative where the other frame has no colour there: outside the picture, or NaN.
float WarpTest::error(const Sample& sample, Move move) const {
    const double x = sample.x + direction_ * move.x;
    const double y = sample.y + direction_ * move.y;
    if (!(x >= 0 && y >= 0 && x <= target_.width - 1 && y <= target_.height - 1)) return -1;
    const int left = std::min(int(x), std::max(target_.width - 2, 0));
    const int top = std::min(int(y), std::max(target_.height - 2, 0));
    const int right = std::min(left + 1, target_.width - 1), bottom = std::min(top + 1, target_.height - 1);
    const Texel& a = target_.at(left, top);
    const Texel& b = target_.at(right, top);
    const Texel& c = target_.at(left, bottom);
    const Texel& d = target_.at(right, bottom);
    if (a[3] < 0 || b[3] < 0 || c[3] < 0 || d[3] < 0) return -1;
    const float u = float(x - left), v = float(y - top);
    float sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const float upper = a[i] + u * (b[i] - a[i]), lower = c[i] + u * (d[i] - c[i]);
        sum += std::abs(upper + v * (lower - upper) - sample.color[i]);
    }
    return sum / 3;
}

double WarpTest::still_error() const {
    double sum = 0;
    for (const Sample& sample : samples_) sum += sample.still_error;
    return samples_.empty() ? 0 : sum / double(samples_.size());
}

double WarpTest::score(const VectorMap& map, bool rough) const {
    const std::size_t stride =
        rough ? std::clamp<std::size_t>(samples_.size() / kRoughSamples, 1, kRoughStride) : 1;
    double warped = 0, still = 0;
    std::size_t inside = 0, count = 0;
    for (std::size_t i = 0; i < samples_.size(); i += stride, ++count) {
        const Sample& sample = samples_[i];
        const float warped_error = error(sample, map.apply(sample.vector_x, sample.vector_y));
        if (warped_error < 0) continue;
        ++inside;
        warped += warped_error;
        still += sample.still_error;
    }
    const double trust = std::min(1.0, double(inside) / (kMinInside * double(count)));
    return still > 0 ? trust * (1 - warped / still) : 0;
}

double WarpTest::dispute(const VectorMap& better, const VectorMap& worse) const {
    double sum_better = 0, sum_worse = 0;
    std::size_t count = 0;
    for (const Sample& sample : samples_) {
        const Move one = better.apply(sample.vector_x, sample.vector_y);
        const Move other = worse.apply(sample.vector_x, sample.vector_y);
        if (std::hypot(one.x - other.x, one.y - other.y) < 1) continue;
        const float error_one = error(sample, one), error_other = error(sample, other);
        if (error_one < 0 || error_other < 0) continue;
        sum_better += error_one;
        sum_worse += error_other;
        ++count;
    }
    if (double(count) < kMinDisputed * double(samples_.size()) || sum_worse <= 0) return 0;
    return 1 - sum_better / sum_worse;
}

std::optional<Move> WarpTest::move_at(double x, double y, const VectorMap& map) const {
    const int column = int(std::lround(x)), row = int(std::lround(y));
    if (column < 0 || row < 0 || column >= vectors_.width() || row >= vectors_.height()) return std::nullopt;
    const Move move = map.apply(double(vectors_.at(column, row, 0)), double(vectors_.at(column, row, 1)));
    if (!std::isfinite(move.x) || !std::isfinite(move.y)) return std::nullopt;
    return move;
}

TimeDispute WarpTest::dispute_in_time(const VectorMap& map, const WarpTest& other,
                                      const VectorMap& other_map) const {
    TimeDispute dispute;
    for (const Sample& sample : samples_) {
        const Move own = map.apply(sample.vector_x, sample.vector_y);
        const auto there =
            other.move_at(sample.x + direction_ * own.x, sample.y + direction_ * own.y, other_map);
        if (!there || std::hypot(there->x - own.x, there->y - own.y) < 1) continue;
        // Where the other reading says that the sample is: its vectors must agree that it is this surface.
        const auto again =
            other.move_at(sample.x + direction_ * there->x, sample.y + direction_ * there->y, other_map);
        const double slack_px = kSameSurface_px + kSameSurface * std::hypot(there->x, there->y);
        if (!again || std::hypot(again->x - there->x, again->y - there->y) > slack_px) continue;
        const float error_own = error(sample, own), error_other = error(sample, *there);
        if (error_own < 0 || error_other < 0) continue;
        dispute.own += error_own;
        dispute.other += error_other;
        ++dispute.count;
    }
    dispute.told =
        dispute.count >= kMinCompared && double(dispute.count) >= kMinDisputed * double(samples_.size());
    return dispute;
}

}  // namespace aftershade
