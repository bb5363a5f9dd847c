// SSIM and MS-SSIM, mean over the channels.
//
// Wang, Bovik, Sheikh, Simoncelli: "Image Quality Assessment: From Error Visibility to Structural
// Similarity", IEEE TIP 13(4), 2004, doi:10.1109/TIP.2003.819861. Wang, Simoncelli, Bovik: "Multiscale
// Structural Similarity for Image Quality Assessment", Asilomar 2003, doi:10.1109/ACSSC.2003.1292216.
#pragma once

#include <optional>

#include "framework/compare/difference_rules.h"
#include "framework/image/image.h"

namespace aftershade {

inline constexpr int kSsimWindow_px = 11;  ///< Gaussian, sigma 1.5, weights that sum to 1
inline constexpr double kSsimSigma_px = 1.5;
inline constexpr double kSsimC1 = 0.01 * 0.01, kSsimC2 = 0.03 * 0.03;  ///< for values in 0..1
inline constexpr int kMsSsimScales = 5;
/// The least side with MS-SSIM: the window must fit into the smallest scale.
inline constexpr int kMsSsimMinSide_px = kSsimWindow_px << (kMsSsimScales - 1);

struct SsimFigures {
    double ssim = 1;
    std::optional<double>
        ms_ssim;           ///< nullopt where a side is below kMsSsimMinSide_px, or pixels are left out
    bool measured = true;  ///< false where no pixel with a window counts
};

/// SSIM of encoded values in 0..1, for each of 1 to 4 channels; 1 for equal images. Both images have one
/// size (asserted) and are finite. The figures do not depend on `threads`, 0: as many as there are cores.
///
/// SSIM: population variances; mean over the pixels whose window lies inside, as scikit-image with
/// gaussian_weights and data_range 1. A side below 11 px is extended by reflection, and all its pixels count.
/// MS-SSIM: weights 0.0448, 0.2856, 0.3001, 0.2363, 0.1333 over scales halved by means of 2 x 2 px; a mean
/// below 0 counts as 0. Pixels that `areas` leaves out have no window of their own. `map`, where given,
/// becomes one channel, of each pixel's window, whose mean is the SSIM; NaN where no window counts.
/// [thread-safe]
SsimFigures ssim_figures(const Image& reference, const Image& test, int threads = 0,
                         const PixelAreas& areas = {}, Image* map = nullptr);

}  // namespace aftershade
