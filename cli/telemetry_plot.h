// Telemetry of a sequence as line charts.
#pragma once

#include <string>
#include <vector>

#include "framework/render/telemetry.h"

namespace aftershade::cli {

/// SVG: a panel for each statistic of each step, its mean and largest over the frames, and one for the time
/// of all passes. Frames without a statistic leave a gap.
std::string telemetry_plot(const std::vector<FrameTelemetry>& frames, const std::string& title);

}  // namespace aftershade::cli
