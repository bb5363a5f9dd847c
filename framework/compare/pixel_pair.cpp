#include "framework/compare/pixel_pair.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace aftershade {

namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

ValuePair pair_of(std::uint32_t reference, std::uint32_t test) {
    return {double(reference), double(test), true, reference == test, true};
}

ValuePair pair_of(float reference, float test, bool nan_equal) {
    ValuePair pair{reference, test, std::isfinite(reference) && std::isfinite(test), true, true};
    pair.same_bits = std::bit_cast<std::uint32_t>(reference) == std::bit_cast<std::uint32_t>(test);
    if (!pair.finite)
        pair.comparable = std::isnan(reference) && std::isnan(test) ? nan_equal : reference == test;
    return pair;
}

double relative_difference(const ValuePair& pair) {
    const double difference = pair.difference();
    return difference == 0 || difference == kEndless ? difference : difference / std::abs(pair.reference);
}

bool is_within_ulp(double difference, const Leeway& leeway, double reference, double test) {
    return leeway.ulp > 0 && difference <= leeway.ulp * leeway.stored.unit_at(std::max(reference, test));
}

/// `difference`, or 0 where it is within the leeway of these magnitudes.
double beyond(double difference, const Leeway& leeway, double reference, double test) {
    const bool is_within = difference <= leeway.relative * (reference + test) / 2 ||
                           is_within_ulp(difference, leeway, reference, test);
    return is_within && difference < kEndless ? 0 : difference;
}

double end_point_error(std::span<const ValuePair> pairs, const Leeway& leeway) {
    const auto error = [&](std::span<const ValuePair> vector) {
        double difference = 0, reference = 0, test = 0;
        for (const ValuePair& pair : vector) {
            difference += pair.difference() * pair.difference();
            reference += pair.reference * pair.reference;
            test += pair.test * pair.test;
        }
        return beyond(std::sqrt(difference), leeway, std::sqrt(reference), std::sqrt(test));
    };
    return pairs.size() == 4 ? std::max(error(pairs.first(2)), error(pairs.last(2))) : error(pairs);
}

double value_of(std::span<const ValuePair> pairs, LayerRole role, const Leeway& leeway) {
    if (role == LayerRole::velocity) return end_point_error(pairs, leeway);
    double largest = 0;
    for (const ValuePair& pair : pairs) {
        const double reference = std::abs(pair.reference), test = std::abs(pair.test);
        double difference = beyond(pair.difference(), leeway, reference, test);
        if (role == LayerRole::depth)
            difference = is_within_ulp(pair.difference(), leeway, reference, test) && pair.finite
                             ? 0
                             : relative_difference(pair);
        if (role == LayerRole::id) difference = pair.same_bits ? 0 : kEndless;
        largest = std::max(largest, difference);
    }
    return largest;
}

std::size_t first_value(const Image& image, PixelPlace place) {
    return (std::size_t(place.y) * std::size_t(image.width()) + std::size_t(place.x)) *
           std::size_t(image.channels());
}

}  // namespace

void take_pair(const Image& reference, PixelPlace in_reference, const Image& test, PixelPlace in_test,
               bool nan_equal, std::vector<ValuePair>& pairs) {
    const auto channels = std::size_t(reference.channels());
    const std::size_t r = first_value(reference, in_reference), t = first_value(test, in_test);
    pairs.resize(channels);
    for (std::size_t c = 0; c < channels; ++c)
        pairs[c] = reference.type() == ComponentType::uint32
                       ? pair_of(reference.uints()[r + c], test.uints()[t + c])
                       : pair_of(reference.floats()[r + c], test.floats()[t + c], nan_equal);
}

PixelDifference difference_of(std::span<const ValuePair> pairs, LayerRole role, const Leeway& leeway) {
    const double value = value_of(pairs, role, leeway);
    const bool comparable =
        role == LayerRole::id ? value == 0 : std::ranges::all_of(pairs, &ValuePair::comparable);
    return {value, comparable};
}

}  // namespace aftershade
