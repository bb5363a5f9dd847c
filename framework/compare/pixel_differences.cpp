#include "framework/compare/pixel_differences.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <span>
#include <vector>

#include "framework/core/parallel.h"

namespace aftershade {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Two values of one channel.
struct Pair {
    double reference = 0, test = 0;
    bool finite = true;  ///< both are
    bool same_bits = true;
    bool comparable = true;  ///< finite, or equal under the rules
    double difference() const {
        if (finite) return std::abs(reference - test);
        return comparable ? 0 : kInfinity;
    }
};

Pair pair_at(const Image& reference, const Image& test, std::size_t index, bool nan_equal) {
    if (reference.type() == ComponentType::uint32) {
        const std::uint32_t r = reference.uints()[index], t = test.uints()[index];
        return {double(r), double(t), true, r == t, true};
    }
    const float r = reference.floats()[index], t = test.floats()[index];
    Pair pair{r, t, std::isfinite(r) && std::isfinite(t), true, true};
    pair.same_bits = std::bit_cast<std::uint32_t>(r) == std::bit_cast<std::uint32_t>(t);
    if (!pair.finite) pair.comparable = std::isnan(r) && std::isnan(t) ? nan_equal : r == t;
    return pair;
}

double relative_difference(const Pair& pair) {
    const double difference = pair.difference();
    return difference == 0 || difference == kInfinity ? difference : difference / std::abs(pair.reference);
}

double end_point_error(std::span<const Pair> pairs) {
    const auto length = [](std::span<const Pair> vector) {
        double sum = 0;
        for (const Pair& pair : vector) sum += pair.difference() * pair.difference();
        return std::sqrt(sum);
    };
    return pairs.size() == 4 ? std::max(length(pairs.first(2)), length(pairs.last(2))) : length(pairs);
}

double difference_of(std::span<const Pair> pairs, LayerRole role) {
    if (role == LayerRole::velocity) return end_point_error(pairs);
    double largest = 0;
    for (const Pair& pair : pairs) {
        double difference = pair.difference();
        if (role == LayerRole::depth) difference = relative_difference(pair);
        if (role == LayerRole::id) difference = pair.same_bits ? 0 : kInfinity;
        largest = std::max(largest, difference);
    }
    return largest;
}

/// The values of one pixel.
void take_pixel(const Image& reference, const Image& test, int x, int y, bool nan_equal,
                std::vector<Pair>& pairs) {
    const auto channels = std::size_t(reference.channels());
    const std::size_t first = (std::size_t(y) * std::size_t(reference.width()) + std::size_t(x)) * channels;
    pairs.resize(channels);
    for (std::size_t c = 0; c < channels; ++c) pairs[c] = pair_at(reference, test, first + c, nan_equal);
}

void add(FailingPixels& pixels, int x, int y) {
    if (pixels.count++ == 0) {
        pixels.box = {x, y, x, y};
        return;
    }
    Window& box = pixels.box;
    box = {std::min(box.min_x, x), std::min(box.min_y, y), std::max(box.max_x, x), std::max(box.max_y, y)};
}

void add(FailingPixels& sum, const FailingPixels& more) {
    if (more.count == 0) return;
    if (sum.count == 0) {
        sum = more;
        return;
    }
    sum.count += more.count;
    sum.box = {std::min(sum.box.min_x, more.box.min_x), std::min(sum.box.min_y, more.box.min_y),
               std::max(sum.box.max_x, more.box.max_x), std::max(sum.box.max_y, more.box.max_y)};
}

void count(NonFiniteCounts& counts, double value) {
    counts.nan += std::isnan(value) ? 1 : 0;
    counts.infinite += std::isinf(value) ? 1 : 0;
}

/// What a row adds; rows are added in order, so that sums do not depend on the threads.
struct RowSums {
    PixelDifferences figures;
    double absolute = 0, squares = 0, relative_squares = 0, pixel_sum = 0;
    std::uint64_t finite_pixels = 0;
    double peak = 0;
    bool has_largest = false;
};

class RowCounter {
public:
    RowCounter(const Image& reference, const Image& test, LayerRole role, const DifferenceRules& rules)
        : reference_(reference), test_(test), role_(role), rules_(rules) {}

    RowSums row(int y) const {
        RowSums sums;
        std::vector<Pair> pairs;
        for (int x = 0; x < reference_.width(); ++x) {
            take_pixel(reference_, test_, x, y, rules_.nan_equal, pairs);
            for (std::size_t c = 0; c < pairs.size(); ++c) add_value(pairs[c], x, y, int(c), sums);
            judge_pixel(pairs, x, y, sums.figures, sums);
        }
        return sums;
    }

private:
    void judge_pixel(std::span<const Pair> pairs, int x, int y, PixelDifferences& figures,
                     RowSums& sums) const {
        const double difference = difference_of(pairs, role_);
        figures.largest_pixel = std::max(figures.largest_pixel, difference);
        if (difference < kInfinity) sums.pixel_sum += difference, ++sums.finite_pixels;
        // Fails above any limit, infinity too.
        const bool wrong =
            role_ == LayerRole::id ? difference > 0 : !std::ranges::all_of(pairs, &Pair::comparable);
        if (wrong || difference > rules_.fail) add(figures.failing, x, y);
        if (wrong || difference > rules_.warn) add(figures.warning, x, y);
        if (difference > rules_.hard_fail) add(figures.hard_failing, x, y);
        if (difference > rules_.hard_warn) add(figures.hard_warning, x, y);
    }

    bool is_larger(const Pair& pair, const RowSums& sums) const {
        if (!sums.has_largest) return role_ != LayerRole::id || !pair.same_bits;
        return role_ != LayerRole::id && pair.difference() > sums.figures.largest.value;
    }

    void add_value(const Pair& pair, int x, int y, int channel, RowSums& sums) const {
        PixelDifferences& figures = sums.figures;
        figures.bits_equal = figures.bits_equal && pair.same_bits;
        count(figures.reference_counts, pair.reference);
        count(figures.test_counts, pair.test);
        const double difference = pair.difference();
        if (is_larger(pair, sums)) {
            figures.largest = {difference, x, y, channel, pair.reference, pair.test};
            sums.has_largest = true;
        }
        if (!pair.finite) {
            figures.incomparable += pair.comparable || role_ == LayerRole::id ? 0 : 1;
            return;
        }
        ++figures.values;
        sums.absolute += difference;
        sums.squares += difference * difference;
        sums.relative_squares +=
            difference * difference / (pair.reference * pair.reference + kRelativeMseEpsilon);
        sums.peak = std::max(sums.peak, std::abs(pair.reference));
    }

    const Image& reference_;
    const Image& test_;
    LayerRole role_;
    const DifferenceRules& rules_;
};

void add(RowSums& total, const RowSums& row, LayerRole role) {
    PixelDifferences& sum = total.figures;
    const PixelDifferences& more = row.figures;
    sum.values += more.values;
    sum.incomparable += more.incomparable;
    const bool larger = role != LayerRole::id && more.largest.value > sum.largest.value;
    if (row.has_largest && (larger || !total.has_largest)) sum.largest = more.largest;
    total.has_largest = total.has_largest || row.has_largest;
    sum.largest_pixel = std::max(sum.largest_pixel, more.largest_pixel);
    add(sum.failing, more.failing);
    add(sum.hard_failing, more.hard_failing);
    add(sum.warning, more.warning);
    add(sum.hard_warning, more.hard_warning);
    sum.reference_counts.nan += more.reference_counts.nan;
    sum.reference_counts.infinite += more.reference_counts.infinite;
    sum.test_counts.nan += more.test_counts.nan;
    sum.test_counts.infinite += more.test_counts.infinite;
    sum.bits_equal = sum.bits_equal && more.bits_equal;
    total.absolute += row.absolute;
    total.squares += row.squares;
    total.relative_squares += row.relative_squares;
    total.pixel_sum += row.pixel_sum;
    total.finite_pixels += row.finite_pixels;
    total.peak = std::max(total.peak, row.peak);
}

void finish(RowSums& total, LayerRole role) {
    PixelDifferences& figures = total.figures;
    const double values = double(std::max<std::uint64_t>(figures.values, 1));
    figures.mean_absolute = total.absolute / values;
    figures.rmse = std::sqrt(total.squares / values);
    figures.relative_mse = total.relative_squares / values;
    figures.mean_pixel = total.pixel_sum / double(std::max<std::uint64_t>(total.finite_pixels, 1));
    const bool of_peak_one = role == LayerRole::display || role == LayerRole::alpha || total.peak == 0;
    figures.psnr_peak = of_peak_one ? 1 : total.peak;
    figures.psnr_db = 20 * std::log10(figures.psnr_peak / figures.rmse);
    if (figures.rmse == 0)
        figures.psnr_db = figures.incomparable == 0 ? kInfinity : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

PixelDifferences pixel_differences(const Image& reference, const Image& test, LayerRole role,
                                   const DifferenceRules& rules, int threads) {
    assert(reference.width() == test.width() && reference.height() == test.height());
    assert(reference.channels() == test.channels() && reference.type() == test.type());
    const RowCounter counter(reference, test, role, rules);
    std::vector<RowSums> rows(std::size_t(reference.height()));
    for_each_row(reference.height(), threads, [&](int y) { rows[std::size_t(y)] = counter.row(y); });
    RowSums total;
    for (int y = 0; y < reference.height(); ++y) add(total, rows[std::size_t(y)], role);
    total.figures.pixels = std::uint64_t(reference.width()) * std::uint64_t(reference.height());
    finish(total, role);
    return total.figures;
}

double pixel_difference(const Image& reference, const Image& test, int x, int y, LayerRole role,
                        bool nan_equal) {
    std::vector<Pair> pairs;
    take_pixel(reference, test, x, y, nan_equal, pairs);
    return difference_of(pairs, role);
}

}  // namespace aftershade
