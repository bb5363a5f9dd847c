// FLIP: how different two pictures look when one is flipped to the other on a display.
//
// Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild: "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020, doi:10.1145/3406183 (LDR); Andersson, Nilsson, Shirley, Akenine-Moeller:
// "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021, doi:10.2312/egs.20211015
// (HDR). Figures agree with NVIDIA's implementation, version 1.6.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/compare/flip_band.h"
#include "framework/image/image.h"

namespace aftershade {

/// Pixels per degree of visual angle of a display `width_px` wide and `width_m` broad, seen from
/// `distance_m`.
double pixels_per_degree(double distance_m, double width_px, double width_m);

struct FlipOptions {
    double pixels_per_degree = 67.020643;  ///< a display 0.7 m broad, 3840 px wide, 0.7 m away
    ToneMapper tone_mapper = ToneMapper::aces;
    /// Exposures of HDR-FLIP, in stops. nullopt: from the reference. If that is on the wrong side of a
    /// given exposure, it is set equal to the given one.
    std::optional<double> start_exposure, stop_exposure;
    std::optional<int> exposures;  ///< nullopt: max(2, ceil(stop - start))
    int threads = 0;               ///< 0: as many as there are cores; changes no bit
};

struct FlipResult {
    Image error;  ///< one channel, 0 (no difference to be seen) to 1
    double mean = 0;
    double max = 0;
    int max_x = 0, max_y = 0;  ///< the first pixel of that error
    // HDR-FLIP only:
    double start_exposure = 0, stop_exposure = 0;
    int exposures = 0;
};

/// Both images have three channels, linear, with Rec. 709 primaries, and one size (asserted). They are
/// clamped to [0, 1].
///
/// A pixel that is NaN or infinite in either image is black in both, for its neighbours; its own error is 1,
/// or 0 where both images have the same NaNs and infinities there. [thread-safe]
FlipResult ldr_flip(const Image& reference, const Image& test, const FlipOptions& options = {});

/// The largest LDR-FLIP over exposures. Where the white point of the tone mapper is x (its root at 0.85), the
/// exposures run from log2(x / largest luminance) to log2(x / median luminance) of the reference.
///
/// The published definition has no stop where the median is not above 0, and neither start nor stop for a
/// black reference (version 1.6 has no defined number of exposures then). Here the median is then that of the
/// luminances above 0; of a reference without any, exposures come from the test by the same rules; and where
/// that has none either, both are 0. [thread-safe]
FlipResult hdr_flip(const Image& reference, const Image& test, const FlipOptions& options = {});

/// The exposures that hdr_flip takes.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 0;
    double at(int index) const { return count < 2 ? start : start + index * ((stop - start) / (count - 1)); }
};
FlipExposures flip_exposures(const Image& reference, const Image& test, const FlipOptions& options);

}  // namespace aftershade
