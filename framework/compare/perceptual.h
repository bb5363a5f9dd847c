// The measures of how a layer looks: FLIP and SSIM of compare_layer.
#pragma once

#include <optional>

#include "framework/compare/compare_files.h"

namespace aftershade {

/// Fills FLIP and SSIM of a color or display layer of one or three channels over one size; others are left
/// alone. Light is brought to Rec. 709's primaries; it goes into HDR-FLIP as it is then, and clamped and
/// sRGB-encoded into SSIM. Encoded colours are clamped, and decoded for FLIP; those of PQ and HLG count as
/// light. Where a value is not finite,
/// SSIM sees 0 in both images, or 0 and 1 where they are not the same NaN or infinity. Equal bits of equal
/// primaries are not measured: 0 and 1. Pixels that are left out do not count in any mean, and their
/// neighbours see the reference there in both images; MS-SSIM, whose scales have no such pixels, is then not
/// measured. [thread-safe]
void measure_perceptually(const LayerImages& images, const CompareRules& rules, LayerComparison& comparison);

/// Both images with their light in Rec. 709's primaries, or with their pictures for a display as sRGB encodes
/// their light; nullopt where they need no conversion, or are not pictures. Pixels with a value
/// that is not finite stay as they are stored.
std::optional<LayerImages> in_rec709(const LayerImages& images, LayerRole role);

/// Linear RGB of a color or display image of one (repeated) or three channels.
Image linear_rgb(const Image& image, LayerRole role, int threads);

}  // namespace aftershade
