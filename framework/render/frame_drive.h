// One frame of a look, from its first sub-frame to its result: by whoever has the captures.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/render/renderer.h"

namespace aftershade {

/// How a frame stands among the others, and the captures around it.
struct FrameSetting {
    std::map<int, std::shared_ptr<const Capture>> neighbours{};  ///< of the same shot, by offset
    bool begins_shot = false;                                    ///< a cut: nothing before it counts
    int subframe_count = 1;
    double scale = 1;  ///< of the capture's pixels relative to those that values in px refer to
    double fps = 24;

    /// Inputs of resolving and rendering. `centre`: FrameInputs::centre. [refers to the captures]
    FrameInputs inputs(const Capture& capture, int subframe = 0, const Capture* centre = nullptr) const;
};

/// A frame whose sub-frames were all issued.
struct BegunFrame {
    std::shared_ptr<const Capture> centre;  ///< the sub-frame at the middle of the exposure
    std::vector<PendingFrame> subframes;
};

struct DrawnFrame {
    std::shared_ptr<const Capture> centre;  ///< the sub-frame at the middle of the exposure
    FrameResult result;                     ///< with the times and the messages of all sub-frames
};

using TakeSubframe = std::function<std::shared_ptr<const Capture>(int subframe)>;

/// Takes and issues each sub-frame in turn (PipelineRenderer::begin).
BegunFrame begin_frame(PipelineRenderer& renderer, const FrameSetting& setting, const TakeSubframe& take,
                       const std::vector<std::string>& roles);
DrawnFrame finish_frame(BegunFrame begun);

/// Takes and draws each sub-frame in turn; `again` as PipelineRenderer::render_again. Throws what `take` and
/// PipelineRenderer::render throw.
DrawnFrame draw_frame(PipelineRenderer& renderer, const FrameSetting& setting, const TakeSubframe& take,
                      const std::vector<std::string>& roles, bool again = false);

}  // namespace aftershade
