// Differences that a comparison forgives: a small shift, or what a blur hides.
#pragma once

#include <vector>

#include "framework/compare/difference_rules.h"
#include "framework/compare/pixel_pair.h"

namespace aftershade {

/// The difference of a pixel p under Forgive.
///
/// `shift_px` N: the larger of two differences: of the reference at p and the pixel of the test image that is
/// nearest to it in value, within N px of p in x and in y; and of the test image at p and the nearest pixel
/// of the reference, likewise. A thin line that one image lacks therefore still fails, in whichever image it
/// is.
///
/// `blur_px` S: the difference at p after both images are filtered with a Gaussian of standard deviation S,
/// cut off at 3 S, where that is smaller than p's own. Values that are not finite in either image take no
/// part in the filter, nor do pixels that it does not reach; a pixel with such a value keeps its own
/// difference. Ids are not filtered.
///
/// Pixels that are left out, or outside of the images, match nothing and take no part in the filter.
class Forgiveness {
public:
    /// `reference`, `test` and `areas` outlive it.
    Forgiveness(const Image& reference, const Image& test, LayerRole role, const DifferenceRules& rules,
                const PixelAreas& areas, int threads);

    bool forgives() const { return shift_px_ > 0 || !blurred_[0].empty(); }
    /// At most `plain`, the difference of p itself. The search ends where nothing above `enough` is left.
    /// `pairs` is for use meanwhile. [thread-safe]
    PixelDifference least(PixelPlace p, PixelDifference plain, double enough,
                          std::vector<ValuePair>& pairs) const;

private:
    PixelDifference nearest(PixelPlace p, bool in_test, PixelDifference plain, double enough,
                            std::vector<ValuePair>& pairs) const;
    PixelDifference after_blur(PixelPlace p, PixelDifference plain, std::vector<ValuePair>& pairs) const;

    const Image& reference_;
    const Image& test_;
    LayerRole role_;
    bool nan_equal_;
    const PixelAreas& areas_;
    int shift_px_ = 0;
    Image blurred_[2];  ///< reference and test; empty without a blur
};

}  // namespace aftershade
