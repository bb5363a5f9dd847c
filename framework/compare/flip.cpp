#include "framework/compare/flip.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <span>

#include "framework/base/parallel.h"
#include "framework/compare/flip_band.h"
#include "framework/compare/row_filter.h"
#include "framework/image/luminance.h"

namespace aftershade {

namespace {

using rows::kBandHeight_px;

struct Root {
    float a, b, c;
};

/// The larger root of a x^2 + b x + c, in single precision as NVIDIA's exposures.
float larger_root(const Root& k) {
    if (k.a == 0) return -k.c / k.b;
    const float half = -0.5f * (k.b / k.a);
    return half + std::sqrt(half * half - k.c / k.a);
}

float white_point(ToneMapper mapper) {
    const float t = 0.85f;
    // Of x / (1 + x) as well.
    static constexpr std::array<float, 6> divide = {0, 1, 0, 0, 1, 1};
    const auto& k = mapper == ToneMapper::reinhard ? divide : tone_mapper_coefficients(mapper);
    return larger_root({k[0] - t * k[3], k[1] - t * k[4], k[2] - t * k[5]});
}

struct Luminances {
    float largest = 0, median = 0;
    bool above_zero = false;
};

Luminances luminances_of(const Image& image) {
    std::vector<float> values;
    values.reserve(image.floats().size() / 3);
    for (std::size_t i = 0; i + 2 < image.floats().size(); i += 3) {
        const std::span<const float> pixel = image.floats().subspan(i, 3);
        const float y = float(kRec709Luminance[0]) * pixel[0] + float(kRec709Luminance[1]) * pixel[1] +
                        float(kRec709Luminance[2]) * pixel[2];
        // As black, which is what FLIP takes such a pixel for.
        values.push_back(std::isfinite(y) ? y : 0);
    }
    const auto median = [&] {
        const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    };
    Luminances result;
    result.largest = *std::max_element(values.begin(), values.end());
    result.above_zero = result.largest > 0;
    result.median = median();
    if (result.median > 0 || !result.above_zero) return result;
    std::erase_if(values, [](float y) { return !(y > 0); });
    result.median = median();
    return result;
}

FlipResult evaluate(const Image& reference, const Image& test, std::span<const FlipExposure> exposures,
                    const FlipOptions& options) {
    assert(reference.width() == test.width() && reference.height() == test.height());
    assert(reference.channels() == 3 && test.channels() == 3 && !reference.empty());
    FlipResult result;
    result.error = Image(reference.width(), reference.height(), 1);
    const FlipFilters filters(float(options.pixels_per_degree));
    const int bands = (reference.height() + kBandHeight_px - 1) / kBandHeight_px;
    for_each_row(bands, thread_count(options.threads), [&](int band) {
        FlipBand work(reference, test, filters);
        const int first = band * kBandHeight_px;
        const int last = std::min(first + kBandHeight_px, reference.height());
        for (const FlipExposure& exposure : exposures) work.add(first, last, exposure, result.error);
    });
    double sum = 0;
    result.max = -1;
    for (int y = 0; y < reference.height(); ++y) {
        double row = 0;
        for (int x = 0; x < reference.width(); ++x) {
            const double error = result.error.at(x, y, 0);
            row += error;
            if (error > result.max) result.max = error, result.max_x = x, result.max_y = y;
        }
        sum += row;
    }
    result.mean = sum / (double(reference.width()) * reference.height());
    return result;
}

}  // namespace

double pixels_per_degree(double distance_m, double width_px, double width_m) {
    return distance_m * (width_px / width_m) * (std::numbers::pi / 180);
}

FlipResult ldr_flip(const Image& reference, const Image& test, const FlipOptions& options) {
    const FlipExposure only{ToneMapper::aces, 1, false};
    return evaluate(reference, test, {&only, 1}, options);
}

FlipExposures flip_exposures(const Image& reference, const Image& test, const FlipOptions& options) {
    FlipExposures exposures;
    if (!options.start_exposure || !options.stop_exposure) {
        Luminances light = luminances_of(reference);
        if (!light.above_zero) light = luminances_of(test);
        if (light.above_zero) {
            const float white = white_point(options.tone_mapper);
            exposures.start = std::log2(white / light.largest);
            exposures.stop = std::log2(white / light.median);
        }
    }
    if (options.start_exposure) {
        exposures.start = *options.start_exposure;
        exposures.stop = std::max(exposures.stop, exposures.start);
    }
    if (options.stop_exposure) {
        exposures.stop = *options.stop_exposure;
        if (!options.start_exposure) exposures.start = std::min(exposures.start, exposures.stop);
    }
    exposures.count =
        options.exposures.value_or(std::max(2, int(std::ceil(float(exposures.stop - exposures.start)))));
    return exposures;
}

FlipResult hdr_flip(const Image& reference, const Image& test, const FlipOptions& options) {
    const FlipExposures range = flip_exposures(reference, test, options);
    std::vector<FlipExposure> exposures;
    for (int i = 0; i < range.count; ++i) {
        const float scale = std::exp2(float(range.at(i)));
        // Where start is stop, all are one.
        if (exposures.empty() || exposures.back().scale != scale)
            exposures.push_back({options.tone_mapper, scale, true});
    }
    FlipResult result = evaluate(reference, test, exposures, options);
    result.start_exposure = range.start;
    result.stop_exposure = range.stop;
    result.exposures = range.count;
    return result;
}

}  // namespace aftershade
