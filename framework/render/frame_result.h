// What a frame gives.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "framework/graph/executor.h"
#include "framework/image/color_encoding.h"
#include "framework/image/image.h"
#include "framework/render/audit.h"
#include "framework/render/telemetry.h"

namespace aftershade {

struct FrameResult {
    std::map<std::string, Image> images;      ///< by role: what the steps made of the roles asked for
    std::set<std::string> finite_roles;       ///< of images that were seen to hold no NaN and no infinity
    std::map<std::string, Image> taps;        ///< by "step.texture"
    std::vector<graph::PassTime> times;       ///< upload, each pass, readback; empty unless timed
    std::vector<AuditFinding> audit;          ///< in the order of the passes; empty unless audited
    std::optional<Window> region;             ///< the part of the display window that was requested
    std::vector<std::string> messages;        ///< what native code logged
    std::optional<FrameTelemetry> telemetry;  ///< where it was requested
    ColorEncoding display_encoding = kSrgbDisplay;  ///< of the image `display`; its curve may be unknown
    /// Of the image `color`, if it is not light in the capture's primaries.
    std::optional<ColorEncoding> color_encoding;
    std::string history_reset;  ///< why history restarted: "a cut"; "" where it continued or is none
};

}  // namespace aftershade
