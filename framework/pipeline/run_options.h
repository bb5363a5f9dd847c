// Which frames a run renders, and which part of each at which size.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "framework/image/image.h"
#include "framework/pipeline/native_steps.h"

namespace aftershade {

/// What to do where a frame's file is not there.
enum class MissingFrame {
    error,  ///< the frame has failed
    skip,   ///< leave it out
    hold    ///< run the last frame that was there again, under this frame's number
};

struct RunOptions {
    std::vector<int> frames;
    int warmup_frames = 0;  ///< of these, the first ones are rendered for their history and not written
    MissingFrame missing = MissingFrame::error;
    bool audit = false;
    bool telemetry = false;
    int scale_divisor = 1;              ///< frames are rendered at 1/this of their size
    std::optional<Window> region;       ///< px of the display window at full scale, from its top left
    int region_margin_px = 64;          ///< rendered around the region, and not written
    std::filesystem::path history_in;   ///< "" for none
    std::filesystem::path history_out;  ///< "" for none
    NativeSources natives{};
};

}  // namespace aftershade
