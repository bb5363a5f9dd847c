// What the steps of a look ask of OpenColorIO.
#pragma once

#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/effect/color_param.h"
#include "framework/look/pipeline.h"

namespace aftershade {

struct StepColorRequest {
    const ParamSpec* file = nullptr;  ///< the parameter that it is for; of the step's manifest
    ColorRequest request;
};
/// With every value that the step's parameters may have in any frame.
std::vector<StepColorRequest> color_requests(const PipelineStep& step);

/// Reports those that OpenColorIO cannot meet, each at the value that is at fault, else at `place`.
void check_color_requests(const PipelineStep& step, const Place& place, Diagnostics& diagnostics);

}  // namespace aftershade
