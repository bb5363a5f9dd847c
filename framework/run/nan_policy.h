// NaN and infinite pixels of captures and outputs: found, reported with their source, repaired or refused.
#pragma once

#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/image/non_finite.h"
#include "framework/render/renderer.h"
#include "framework/run/run_options.h"

namespace aftershade {

/// Notes the non-finite pixels of each role in `capture.non_finite`, by the pixels of the file; repairs them
/// where the policy says so. Positive infinity is sound in roles whose outside is infinite, such as depth.
void apply_nan_policy(NanPolicy policy, Capture& capture);

/// An image that a frame's files are made of, with non-finite pixels.
struct NonFiniteOutput {
    std::string name;        ///< a role, or a tap: "bokeh.coc"
    NonFinitePixels pixels;  ///< by the pixels of the image
};

/// The same for the images that the steps made. Of taps only NaN counts: they show what an effect works
/// with, where an infinity may mean something; they are never repaired.
std::vector<NonFiniteOutput> apply_nan_policy(NanPolicy policy, FrameResult& result);

/// One sentence for each: "frame 2: the role 'color' of cap_0002.exr has 12 NaN pixels, the first at (30,
/// 17);
/// ...", with what was done or can be done.
std::vector<std::string> describe_non_finite(NanPolicy policy, const Capture& capture);
std::vector<std::string> describe_non_finite(NanPolicy policy, const std::vector<NonFiniteOutput>& outputs,
                                             const Capture& capture);

}  // namespace aftershade
