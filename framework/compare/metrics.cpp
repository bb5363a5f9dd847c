#include "framework/compare/metrics.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "framework/image/srgb.h"

namespace aftershade {

namespace {

double difference(double reference, double test, bool nan_equal) {
    if (std::isfinite(reference) && std::isfinite(test)) return std::abs(reference - test);
    const bool same = (std::isnan(reference) && std::isnan(test)) || reference == test;
    return same && nan_equal ? 0 : std::numeric_limits<double>::infinity();
}

double psnr_of_mse(double mse) {
    return mse == 0 ? std::numeric_limits<double>::infinity() : -10 * std::log10(mse);
}

}  // namespace

ImageMetrics compare_images(const Image& reference, const Image& test, int channels, bool nan_equal) {
    assert(reference.width() == test.width() && reference.height() == test.height());
    assert(reference.channels() >= channels && test.channels() >= channels);
    ImageMetrics metrics;
    metrics.max.value = -1;
    double sum = 0;
    double sum_of_squares = 0;
    for (int y = 0; y < reference.height(); ++y)
        for (int x = 0; x < reference.width(); ++x)
            for (int c = 0; c < channels; ++c) {
                const double d = difference(reference.at(x, y, c), test.at(x, y, c), nan_equal);
                sum += d;
                sum_of_squares += d * d;
                if (d > metrics.max.value) metrics.max = {d, x, y, c};
            }
    const double count = double(reference.width()) * reference.height() * channels;
    metrics.mean_absolute = sum / count;
    metrics.rmse = std::sqrt(sum_of_squares / count);
    metrics.psnr_db = psnr_of_mse(sum_of_squares / count);
    return metrics;
}

double srgb_of_clamped(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return encode_srgb(linear);
}

double display_psnr_db(const Image& reference, const Image& test) {
    assert(reference.width() == test.width() && reference.height() == test.height());
    assert(reference.channels() >= 3 && test.channels() >= 3);
    double sum_of_squares = 0;
    for (int y = 0; y < reference.height(); ++y)
        for (int x = 0; x < reference.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                const double d = srgb_of_clamped(reference.at(x, y, c)) - srgb_of_clamped(test.at(x, y, c));
                sum_of_squares += d * d;
            }
    return psnr_of_mse(sum_of_squares / (double(reference.width()) * reference.height() * 3));
}

}  // namespace aftershade
