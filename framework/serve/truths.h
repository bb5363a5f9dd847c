// Truths that `aftershade render --truth` wrote next to a frame: the same picture through a lens or a
// shutter.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/capture/capture.h"
#include "framework/capture/sequence.h"

namespace aftershade::serve {

/// Names as `render --truth` has them ("lens", "lens+shutter"), by frame. Links are left out.
std::map<int, std::vector<std::string>> truths_of(const Sequence& sequence);

/// The colour of a truth in the frame's primaries, with the frame's header. Throws Refusal where there is
/// none, or where it has another size; Error(ErrorKind::capture) where it cannot be read.
Capture read_truth(const Sequence& sequence, int frame, const std::string& name, const CaptureHeader& header,
                   const ReadLimits& limits);

/// |test - truth| by channel, opaque. Both images have one size.
Image absolute_difference(const Image& truth, const Image& test);

/// {"truth", "psnr_db", "flip"}: as docs/measures.md, has PSNR, and the mean of LDR-FLIP, both of light in
/// Rec. 709's primaries. `color` has the truth's size and primaries.
nlohmann::ordered_json metrics_json(const std::string& name, const Capture& truth, const Image& color);

}  // namespace aftershade::serve
