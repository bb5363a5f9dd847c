#include "framework/compare/ssim.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "framework/base/parallel.h"
#include "framework/compare/row_filter.h"

namespace aftershade {

namespace {

constexpr int kRadius_px = kSsimWindow_px / 2;
using rows::kBandHeight_px;
constexpr std::array<double, kMsSsimScales> kScaleWeights = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

using Window11 = std::array<double, kSsimWindow_px>;

Window11 gaussian_window() {
    Window11 weights;
    double sum = 0;
    for (int i = -kRadius_px; i <= kRadius_px; ++i) {
        const double weight = std::exp(-0.5 * i * i / (kSsimSigma_px * kSsimSigma_px));
        weights[std::size_t(i + kRadius_px)] = weight;
        sum += weight;
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Mirrored at the border, whose pixel comes twice: d c b a | a b c d | d c b a.
int reflected(int i, int size) {
    const int period = 2 * size;
    const int wrapped = (i % period + period) % period;
    return wrapped < size ? wrapped : period - 1 - wrapped;
}

/// One channel, as doubles.
struct Plane {
    int width = 0, height = 0;
    std::vector<double> values;
    double at(int x, int y) const { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
};

Plane plane_of(const Image& image, int channel) {
    Plane plane{image.width(), image.height(), {}};
    plane.values.reserve(std::size_t(image.width()) * std::size_t(image.height()));
    const auto step = std::size_t(image.channels());
    for (std::size_t i = std::size_t(channel); i < image.floats().size(); i += step)
        plane.values.push_back(image.floats()[i]);
    return plane;
}

Plane halved(const Plane& plane) {
    Plane half{plane.width / 2, plane.height / 2, {}};
    half.values.reserve(std::size_t(half.width) * std::size_t(half.height));
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x)
            half.values.push_back(0.25 * (plane.at(2 * x, 2 * y) + plane.at(2 * x + 1, 2 * y) +
                                          plane.at(2 * x, 2 * y + 1) + plane.at(2 * x + 1, 2 * y + 1)));
    return half;
}

/// The pixels that count along one side: those whose window lies inside, or all of a short side.
struct Extent {
    int first = 0, last = 0;
    explicit Extent(int size)
        : first(size < kSsimWindow_px ? 0 : kRadius_px),
          last(size < kSsimWindow_px ? size : size - kRadius_px) {}
    int count() const { return last - first; }
};

struct Means {
    double ssim = 0, contrast = 0;
    std::uint64_t pixels = 0;
};

/// Where the SSIM of pixels is added up over the channels; none where `image` is null.
struct Map {
    Image* image = nullptr;
    double share = 1;  ///< of a channel
};

/// Local means, variances and covariance of a band of rows: first each row across, then down.
class Band {
public:
    Band(const Plane& reference, const Plane& test, const Window11& weights, const PixelAreas& areas,
         const Map& map)
        : reference_(reference),
          test_(test),
          weights_(weights),
          areas_(areas),
          map_(map),
          columns_(reference.width) {
        const auto row = std::size_t(rows::padded(columns_.count()));
        for (std::size_t m = 0; m < kMoments; ++m) {
            ring_[m].resize(kSsimWindow_px * row);
            padded_[m].resize(row + 2 * kRadius_px);
            means_[m].resize(row);
        }
    }

    /// Sums over the rows of the band.
    Means sum(int first, int last) {
        Means total;
        int next = first - kRadius_px;
        for (int y = first; y < last; ++y) {
            for (; next <= y + kRadius_px; ++next) filter_across(next);
            add_row(y, total);
        }
        return total;
    }

private:
    enum Moment { kR, kT, kRR, kTT, kRT, kMoments };

    double* ring_row(std::size_t moment, int y) {
        const auto slot = std::size_t((y + kSsimWindow_px) % kSsimWindow_px);
        return ring_[moment].data() + slot * std::size_t(rows::padded(columns_.count()));
    }

    void filter_across(int y) {
        const int row = reflected(y, reference_.height), left = columns_.first - kRadius_px;
        for (int i = 0; i < columns_.count() + 2 * kRadius_px; ++i) {
            const int x = left + i;
            const bool inside = x >= 0 && x < reference_.width;
            const int column = inside ? x : reflected(x, reference_.width);
            const double r = reference_.at(column, row), t = test_.at(column, row);
            const std::array<double, kMoments> moments = {r, t, r * r, t * t, r * t};
            for (std::size_t m = 0; m < kMoments; ++m) padded_[m][std::size_t(i)] = moments[m];
        }
        for (std::size_t m = 0; m < kMoments; ++m)
            rows::convolve(padded_[m].data(), weights_, ring_row(m, y), columns_.count());
    }

    void add_row(int y, Means& total) {
        std::array<const double*, kSsimWindow_px> taps;
        for (std::size_t m = 0; m < kMoments; ++m) {
            for (int k = -kRadius_px; k <= kRadius_px; ++k)
                taps[std::size_t(k + kRadius_px)] = ring_row(m, y + k);
            rows::convolve_down(taps.data(), weights_, means_[m].data(), columns_.count());
        }
        for (std::size_t x = 0; x < std::size_t(columns_.count()); ++x) {
            if (areas_.is_left_out(columns_.first + int(x), y, reference_.width)) continue;
            ++total.pixels;
            const double r = means_[kR][x], t = means_[kT][x];
            const double variance = means_[kRR][x] - r * r + means_[kTT][x] - t * t;
            const double covariance = means_[kRT][x] - r * t;
            const double contrast = (2 * covariance + kSsimC2) / (variance + kSsimC2);
            const double ssim = contrast * (2 * r * t + kSsimC1) / (r * r + t * t + kSsimC1);
            total.contrast += contrast;
            total.ssim += ssim;
            if (map_.image) add_to_map(columns_.first + int(x), y, ssim);
        }
    }

    void add_to_map(int x, int y, double ssim) {
        float& value = map_.image->at(x, y, 0);
        value = float(map_.share * ssim) + (std::isnan(value) ? 0 : value);
    }

    const Plane& reference_;
    const Plane& test_;
    const Window11& weights_;
    const PixelAreas& areas_;
    const Map& map_;
    Extent columns_;
    std::array<std::vector<double>, kMoments> ring_, padded_, means_;
};

/// Means over the pixels that count; sums of none.
Means means_of(const Plane& reference, const Plane& test, int threads, const PixelAreas& areas,
               const Map& map = {}) {
    static const Window11 weights = gaussian_window();
    const Extent rows(reference.height);
    const int bands = (rows.count() + kBandHeight_px - 1) / kBandHeight_px;
    std::vector<Means> sums(std::size_t(bands), Means{});
    for_each_row(bands, threads, [&](int band) {
        const int first = rows.first + band * kBandHeight_px;
        sums[std::size_t(band)] = Band(reference, test, weights, areas, map)
                                      .sum(first, std::min(first + kBandHeight_px, rows.last));
    });
    Means means;
    for (const Means& sum : sums)
        means.ssim += sum.ssim, means.contrast += sum.contrast, means.pixels += sum.pixels;
    const double pixels = double(std::max<std::uint64_t>(means.pixels, 1));
    return {means.ssim / pixels, means.contrast / pixels, means.pixels};
}

}  // namespace

SsimFigures ssim_figures(const Image& reference, const Image& test, int threads, const PixelAreas& areas,
                         Image* map) {
    assert(reference.width() == test.width() && reference.height() == test.height());
    assert(reference.channels() == test.channels() && !reference.empty());
    const bool scales =
        std::min(reference.width(), reference.height()) >= kMsSsimMinSide_px && areas.of_pixel.empty();
    if (map) {
        *map = Image(reference.width(), reference.height(), 1);
        std::ranges::fill(map->floats(), std::numeric_limits<float>::quiet_NaN());
    }
    double sum = 0, multi_scale_sum = 0;
    bool any = false;
    for (int c = 0; c < reference.channels(); ++c) {
        Plane r = plane_of(reference, c), t = plane_of(test, c);
        Means means = means_of(r, t, thread_count(threads), areas, {map, 1.0 / reference.channels()});
        sum += means.ssim;
        any = means.pixels > 0;
        if (!scales) continue;
        double product = 1;
        for (std::size_t scale = 0; scale + 1 < kMsSsimScales; ++scale) {
            product *= std::pow(std::max(means.contrast, 0.0), kScaleWeights[scale]);
            r = halved(r), t = halved(t);
            means = means_of(r, t, thread_count(threads), areas);
        }
        multi_scale_sum += product * std::pow(std::max(means.ssim, 0.0), kScaleWeights.back());
    }
    SsimFigures figures;
    figures.ssim = sum / reference.channels();
    figures.measured = any;
    if (scales) figures.ms_ssim = multi_scale_sum / reference.channels();
    return figures;
}

}  // namespace aftershade
