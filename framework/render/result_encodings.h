// What the numbers of a frame's colours mean where OpenColorIO has taken them to another space.
#pragma once

#include "framework/look/pipeline.h"
#include "framework/render/frame_result.h"
#include "framework/render/step_files.h"

namespace aftershade {

/// Sets the encodings of `display` and `color` by the last steps that made them of other images, with the
/// transforms that the steps' files are of now.
void set_encodings(const Pipeline& pipeline, const StepFiles& files, FrameResult& result);

}  // namespace aftershade
