#include "framework/compare/forgiveness.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "framework/base/parallel.h"

namespace aftershade {

namespace {

std::vector<double> gaussian(double sigma_px) {
    const int radius_px = int(std::ceil(3 * sigma_px));
    std::vector<double> weights;
    for (int i = -radius_px; i <= radius_px; ++i)
        weights.push_back(std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
    return weights;
}

/// Values of both images, and of the weight that each has in the filter, interleaved: reference, test, 1;
/// zero where a value takes no part.
struct Filtered {
    int width = 0, height = 0;
    std::vector<double> values;
    std::size_t at(int x, int y) const { return 3 * (std::size_t(y) * std::size_t(width) + std::size_t(x)); }
};

Filtered channel_of(const Image& reference, const Image& test, int channel, const PixelAreas& areas) {
    Filtered plane{reference.width(), reference.height(), {}};
    plane.values.resize(plane.at(0, plane.height));
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x) {
            const float r = reference.at(x, y, channel), t = test.at(x, y, channel);
            if (areas.is_left_out(x, y, plane.width) || !std::isfinite(r) || !std::isfinite(t)) continue;
            double* out = &plane.values[plane.at(x, y)];
            out[0] = r, out[1] = t, out[2] = 1;
        }
    return plane;
}

/// Along x, or along y.
Filtered filtered(const Filtered& plane, const std::vector<double>& weights, bool across, int threads) {
    Filtered result{plane.width, plane.height, std::vector<double>(plane.values.size())};
    const int radius_px = int(weights.size() / 2), size = across ? plane.width : plane.height;
    for_each_row(plane.height, threads, [&](int y) {
        for (int x = 0; x < plane.width; ++x) {
            const int here = across ? x : y;
            double* out = &result.values[result.at(x, y)];
            for (int i = std::max(0, here - radius_px); i <= std::min(size - 1, here + radius_px); ++i) {
                const double weight = weights[std::size_t(i - here + radius_px)];
                const double* in = &plane.values[across ? plane.at(i, y) : plane.at(x, i)];
                for (int k = 0; k < 3; ++k) out[k] += weight * in[k];
            }
        }
    });
    return result;
}

}  // namespace

Forgiveness::Forgiveness(const Image& reference, const Image& test, LayerRole role,
                         const DifferenceRules& rules, const PixelAreas& areas, int threads)
    : reference_(reference),
      test_(test),
      role_(role),
      nan_equal_(rules.nan_equal),
      areas_(areas),
      shift_px_(rules.forgive.shift_px) {
    if (rules.forgive.blur_px <= 0 || role == LayerRole::id || reference.type() == ComponentType::uint32)
        return;
    const std::vector<double> weights = gaussian(rules.forgive.blur_px);
    for (Image& image : blurred_) image = Image(reference.width(), reference.height(), reference.channels());
    for (int c = 0; c < reference.channels(); ++c) {
        Filtered plane = channel_of(reference, test, c, areas);
        for (const bool across : {true, false}) plane = filtered(plane, weights, across, threads);
        for (int y = 0; y < plane.height; ++y)
            for (int x = 0; x < plane.width; ++x) {
                const double* sums = &plane.values[plane.at(x, y)];
                for (std::size_t i = 0; i < 2; ++i)
                    blurred_[i].at(x, y, c) = sums[2] > 0 ? float(sums[i] / sums[2]) : 0;
            }
    }
}

PixelDifference Forgiveness::least(PixelPlace p, PixelDifference plain, double enough,
                                   std::vector<ValuePair>& pairs) const {
    PixelDifference result = plain;
    if (shift_px_ > 0) {
        result = nearest(p, true, plain, enough, pairs);
        // Where nothing in the test image is nearer than p itself, the other direction changes nothing.
        if (result < plain) result = std::max(result, nearest(p, false, plain, enough, pairs));
    }
    return blurred_[0].empty() ? result : std::min(result, after_blur(p, plain, pairs));
}

PixelDifference Forgiveness::nearest(PixelPlace p, bool in_test, PixelDifference plain, double enough,
                                     std::vector<ValuePair>& pairs) const {
    PixelDifference best = plain;
    const int width = reference_.width(), height = reference_.height();
    for (int y = std::max(0, p.y - shift_px_); y <= std::min(height - 1, p.y + shift_px_); ++y)
        for (int x = std::max(0, p.x - shift_px_); x <= std::min(width - 1, p.x + shift_px_); ++x) {
            if (areas_.is_left_out(x, y, width)) continue;
            if (in_test) take_pair(reference_, p, test_, {x, y}, nan_equal_, pairs);
            else take_pair(reference_, {x, y}, test_, p, nan_equal_, pairs);
            best = std::min(best, difference_of(pairs, role_));
            if (best.comparable && best.value <= enough) return best;
        }
    return best;
}

PixelDifference Forgiveness::after_blur(PixelPlace p, PixelDifference plain,
                                        std::vector<ValuePair>& pairs) const {
    take_pair(reference_, p, test_, p, nan_equal_, pairs);
    if (!std::ranges::all_of(pairs, &ValuePair::finite)) return plain;
    take_pair(blurred_[0], p, blurred_[1], p, nan_equal_, pairs);
    return difference_of(pairs, role_);
}

}  // namespace aftershade
