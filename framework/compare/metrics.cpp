#include "framework/compare/metrics.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "framework/image/srgb.h"

namespace aftershade {

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
    if (sum_of_squares == 0) return std::numeric_limits<double>::infinity();
    return -10 * std::log10(sum_of_squares / (double(reference.width()) * reference.height() * 3));
}

}  // namespace aftershade
