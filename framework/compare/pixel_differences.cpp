#include "framework/compare/pixel_differences.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <vector>

#include "framework/base/parallel.h"
#include "framework/compare/difference_rules.h"
#include "framework/compare/forgiveness.h"
#include "framework/compare/pixel_pair.h"

namespace aftershade {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

void add(LimitCounts& sum, const LimitCounts& more) {
    sum.pixels += more.pixels;
    add(sum.failing, more.failing);
    add(sum.hard_failing, more.hard_failing);
    add(sum.warning, more.warning);
    add(sum.hard_warning, more.hard_warning);
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
    RowCounter(const Image& reference, const Image& test, LayerRole role, const DifferenceRules& rules,
               const PixelAreas& areas, int threads)
        : reference_(reference),
          test_(test),
          role_(role),
          rules_(rules),
          areas_(areas),
          forgiveness_(reference, test, role, rules, areas, threads) {}

    RowSums row(int y) const {
        RowSums sums;
        sums.figures.by_area.resize(areas_.limits.size() + 1);
        std::vector<ValuePair> pairs;
        for (int x = 0; x < reference_.width(); ++x) {
            const std::size_t area = areas_.at(x, y, reference_.width());
            if (area == PixelAreas::kLeftOut) {
                ++sums.figures.left_out;
                continue;
            }
            take_pair(reference_, {x, y}, test_, {x, y}, rules_.nan_equal, pairs);
            for (std::size_t c = 0; c < pairs.size(); ++c) add_value(pairs[c], x, y, int(c), sums);
            judge_pixel(difference_of(pairs, role_), {x, y}, area, pairs, sums);
        }
        for (const LimitCounts& area : sums.figures.by_area) add(sums.figures, area);
        return sums;
    }

private:
    void judge_pixel(PixelDifference difference, PixelPlace place, std::size_t area,
                     std::vector<ValuePair>& pairs, RowSums& sums) const {
        PixelDifferences& figures = sums.figures;
        figures.largest_pixel = std::max(figures.largest_pixel, difference.value);
        if (difference.value < kInfinity) sums.pixel_sum += difference.value, ++sums.finite_pixels;
        const DifferenceRules& limits = area == 0 ? rules_ : areas_.limits[area - 1];
        // What limits that depend on the value leave of the difference.
        const auto left_by = [&](double relative, double ulp) {
            const Leeway leeway{relative, ulp, rules_.stored};
            return leeway.any() ? difference_of(pairs, role_, leeway).value : kInfinity;
        };
        const double fail_left = left_by(limits.fail_relative, limits.fail_ulp),
                     warn_left = left_by(limits.warn_relative, limits.warn_ulp),
                     hard_fail_left = left_by(0, limits.fail_ulp),
                     hard_warn_left = left_by(0, limits.warn_ulp);
        // Fails above any limit, infinity too.
        const auto exceeds = [&](double limit, double left = kInfinity) {
            return !difference.comparable || std::min(difference.value, left) > limit;
        };
        if (forgiveness_.forgives()) {
            const double least = std::min({limits.fail, limits.hard_fail, limits.warn, limits.hard_warn});
            const bool failed = exceeds(limits.fail, fail_left);
            if (exceeds(least)) difference = forgiveness_.least(place, difference, least, pairs);
            if (failed && !exceeds(limits.fail, fail_left)) ++figures.forgiven;
        }
        LimitCounts& counts = figures.by_area[area];
        ++counts.pixels;
        if (exceeds(limits.fail, fail_left)) add(counts.failing, place.x, place.y);
        if (exceeds(limits.warn, warn_left)) add(counts.warning, place.x, place.y);
        if (std::min(difference.value, hard_fail_left) > limits.hard_fail)
            add(counts.hard_failing, place.x, place.y);
        if (std::min(difference.value, hard_warn_left) > limits.hard_warn)
            add(counts.hard_warning, place.x, place.y);
    }

    bool is_larger(const ValuePair& pair, const RowSums& sums) const {
        if (!sums.has_largest) return role_ != LayerRole::id || !pair.same_bits;
        return role_ != LayerRole::id && pair.difference() > sums.figures.largest.value;
    }

    void add_value(const ValuePair& pair, int x, int y, int channel, RowSums& sums) const {
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
    const PixelAreas& areas_;
    Forgiveness forgiveness_;
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
    add(sum, static_cast<const LimitCounts&>(more));
    for (std::size_t i = 0; i < more.by_area.size(); ++i) add(sum.by_area[i], more.by_area[i]);
    sum.left_out += more.left_out;
    sum.forgiven += more.forgiven;
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
                                   const DifferenceRules& rules, const PixelAreas& areas, int threads) {
    assert(reference.width() == test.width() && reference.height() == test.height());
    assert(reference.channels() == test.channels() && reference.type() == test.type());
    assert(areas.of_pixel.empty() ||
           areas.of_pixel.size() == std::size_t(reference.width()) * std::size_t(reference.height()));
    const RowCounter counter(reference, test, role, rules, areas, threads);
    std::vector<RowSums> rows(std::size_t(reference.height()));
    for_each_row(reference.height(), threads, [&](int y) { rows[std::size_t(y)] = counter.row(y); });
    RowSums total;
    total.figures.by_area.resize(areas.limits.size() + 1);
    for (int y = 0; y < reference.height(); ++y) add(total, rows[std::size_t(y)], role);
    finish(total, role);
    return total.figures;
}

PixelDifferences pixel_differences(const Image& reference, const Image& test, LayerRole role,
                                   const DifferenceRules& rules, int threads) {
    return pixel_differences(reference, test, role, rules, PixelAreas{}, threads);
}

double pixel_difference(const Image& reference, const Image& test, int x, int y, LayerRole role,
                        bool nan_equal) {
    std::vector<ValuePair> pairs;
    take_pair(reference, {x, y}, test, {x, y}, nan_equal, pairs);
    return difference_of(pairs, role).value;
}

}  // namespace aftershade
