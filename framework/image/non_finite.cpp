#include "framework/image/non_finite.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "framework/base/parallel.h"

namespace aftershade {

namespace {

class FaultFinder {
public:
    explicit FaultFinder(bool infinity_allowed) : infinity_allowed_(infinity_allowed) {}

    bool is_fault(float value) const {
        return !std::isfinite(value) && !(infinity_allowed_ && std::isinf(value) && value > 0);
    }

    /// NaN and infinity have every bit of the exponent set (IEEE 754 binary32), so that adding 1 to the
    /// exponent carries into the place of the sign; for NaN, the largest mantissa added does. Two values at a
    /// time, without a branch.
    bool any_fault(std::span<const float> values) const {
        constexpr std::uint64_t kSigns = 0x80000000'80000000, kOnes = 0x00800000'00800000,
                                kMantissas = 0x007fffff'007fffff;
        std::uint64_t non_finite = 0, nan_or_negative = 0;
        std::size_t i = 0;
        for (; i + 1 < values.size(); i += 2) {
            std::uint64_t two = 0;
            std::memcpy(&two, &values[i], sizeof two);
            const std::uint64_t amounts = two & ~kSigns, carried = amounts + kOnes;
            non_finite |= carried;
            nan_or_negative |= (amounts + kMantissas) | (carried & two);
        }
        const std::uint64_t found = infinity_allowed_ ? nan_or_negative : non_finite;
        return (found & kSigns) != 0 || (i < values.size() && is_fault(values[i]));
    }

    std::span<const float> row(const Image& image, int y) const {
        const std::size_t width = std::size_t(image.width()) * std::size_t(image.channels());
        return image.floats().subspan(std::size_t(y) * width, width);
    }

    void count_row(const Image& image, int y, NonFinitePixels& found) const {
        for (int x = 0; x < image.width(); ++x) {
            bool nan = false, infinite = false;
            for (int c = 0; c < image.channels(); ++c) {
                const float value = image.at(x, y, c);
                nan |= std::isnan(value);
                infinite |= !std::isnan(value) && is_fault(value);
            }
            if (!nan && !infinite) continue;
            if (!found) found.x = x, found.y = y;
            ++(nan ? found.nan : found.infinite);
        }
    }

private:
    bool infinity_allowed_;
};

/// nullopt where no value around is finite.
std::optional<float> mean_around(const Image& image, int x, int y, int channel, int radius_px) {
    double sum = 0;
    int count = 0;
    for (int v = std::max(y - radius_px, 0); v <= std::min(y + radius_px, image.height() - 1); ++v)
        for (int u = std::max(x - radius_px, 0); u <= std::min(x + radius_px, image.width() - 1); ++u)
            if (const float value = image.at(u, v, channel); std::isfinite(value)) sum += value, ++count;
    return count > 0 ? std::optional(float(sum / count)) : std::nullopt;
}

struct Replacement {
    int x = 0, y = 0, channel = 0;
    float value = 0;
};

}  // namespace

bool are_finite(std::span<const float> values) {
    return !FaultFinder(false).any_fault(values);
}

NonFinitePixels find_non_finite(const Image& image, bool infinity_allowed, int threads) {
    NonFinitePixels all;
    if (image.type() != ComponentType::float32 || image.empty()) return all;
    const FaultFinder finder(infinity_allowed);
    const std::size_t row_values = image.floats().size() / std::size_t(image.height());
    const auto look = [&](const Part& part) {
        NonFinitePixels found;
        for (int y = int(part.begin / row_values); y < int(part.end / row_values); ++y)
            if (finder.any_fault(finder.row(image, y))) finder.count_row(image, y, found);
        return found;
    };
    for (const NonFinitePixels& found :
         for_each_part(parts_for_threads(image.floats().size(), row_values, threads), look)) {
        if (!all) all.x = found.x, all.y = found.y;
        all.nan += found.nan;
        all.infinite += found.infinite;
    }
    return all;
}

NonFinitePixels mend_non_finite(Image& image, bool infinity_allowed, int threads) {
    NonFinitePixels found = find_non_finite(image, infinity_allowed, threads);
    if (!found) return found;
    const FaultFinder finder(infinity_allowed);
    std::vector<Replacement> replacements;
    for (int y = found.y; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            bool zeroed = false;
            for (int c = 0; c < image.channels(); ++c) {
                if (!finder.is_fault(image.at(x, y, c))) continue;
                std::optional<float> value;
                for (int radius_px = 1; !value && radius_px <= kMendRadius_px; ++radius_px)
                    value = mean_around(image, x, y, c, radius_px);
                zeroed |= !value;
                replacements.push_back({x, y, c, value.value_or(0.0f)});
            }
            found.zeroed += zeroed;
        }
    for (const Replacement& r : replacements) image.at(r.x, r.y, r.channel) = r.value;
    found.mended = found.count();
    return found;
}

}  // namespace aftershade
