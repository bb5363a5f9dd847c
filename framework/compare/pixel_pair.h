// One pixel of the reference against one of the test image: what every count of differences is made of.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "framework/compare/difference_rules.h"
#include "framework/compare/layer.h"
#include "framework/image/image.h"

namespace aftershade {

/// Two values of one channel.
struct ValuePair {
    double reference = 0, test = 0;
    bool finite = true;  ///< both are
    bool same_bits = true;
    bool comparable = true;  ///< finite, or equal under the rules
    double difference() const {
        if (finite) return std::abs(reference - test);
        return comparable ? 0 : std::numeric_limits<double>::infinity();
    }
};

/// Where a pixel lies in an image.
struct PixelPlace {
    int x = 0, y = 0;
};

/// The values of a pixel of each image, channel by channel, into `pairs`. Both images have one type and
/// channel count.
void take_pair(const Image& reference, PixelPlace in_reference, const Image& test, PixelPlace in_test,
               bool nan_equal, std::vector<ValuePair>& pairs);

/// Differences that do not count, as DifferenceRules defines them.
struct Leeway {
    double relative = 0;
    double ulp = 0;
    StoredPrecision stored;
    bool any() const { return relative > 0 || ulp > 0; }
};

/// A pixel's difference as DifferenceRules defines it; of what the leeway leaves alone.
struct PixelDifference {
    double value = 0;
    bool comparable = true;  ///< else the pixel fails whatever the limit
    bool operator<(const PixelDifference& other) const {
        return comparable != other.comparable ? comparable : value < other.value;
    }
};
PixelDifference difference_of(std::span<const ValuePair> pairs, LayerRole role, const Leeway& leeway = {});

}  // namespace aftershade
