// Which frames a run renders, and which part of each at which size.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "framework/image/image.h"
#include "framework/render/native_steps.h"
#include "framework/render/renderer_options.h"
#include "framework/render/trace.h"

namespace aftershade {

/// Handling of a missing frame's file.
enum class MissingFrame {
    error,  ///< the frame has failed
    skip,   ///< leave it out
    hold    ///< run the last frame that was there again, under this frame's number
};

/// Handling of a capture or an output with pixels that are NaN or infinite. They are always counted.
enum class NanPolicy {
    warn,  ///< say so
    fail,  ///< the frame has failed, and nothing of it is written
    mend   ///< replace them (framework/image/non_finite.h), in captures before the effects see them, and say
           ///< so
};

struct RunOptions {
    std::vector<int> frames;
    int warmup_frames = 0;  ///< of these, the first ones are rendered for their history and not written
    MissingFrame missing = MissingFrame::error;
    NanPolicy on_nan = NanPolicy::warn;
    bool stop_on_error = false;  ///< the first frame that fails ends the run
    RendererOptions drawing{};
    int frames_ahead = 0;   ///< that are read, and that are written, while one is worked on; 0: a quarter of
                            ///< the cores, 8 at most, as far as memory has room
    int scale_divisor = 1;  ///< frames are rendered at 1/this of their size
    std::optional<Window> region;         ///< px of the display window at full scale, from its top left
    std::optional<int> region_margin_px;  ///< rendered around the region, and not written; nullopt: what it
                                          ///< needs (framework/look/reach.h)
    std::filesystem::path history_in;     ///< "" for none
    std::filesystem::path history_out;    ///< "" for none
    NativeSources natives{};
    Trace* trace = nullptr;  ///< gets what the run does and when; nullptr for none
};

}  // namespace aftershade
