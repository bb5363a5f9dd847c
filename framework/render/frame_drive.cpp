#include "framework/render/frame_drive.h"

#include <utility>

namespace aftershade {

FrameInputs FrameSetting::inputs(const Capture& capture, int subframe, const Capture* centre) const {
    FrameInputs inputs;
    inputs.capture = &capture;
    for (const auto& [offset, neighbour] : neighbours) inputs.neighbours[offset] = neighbour.get();
    inputs.begins_shot = begins_shot;
    inputs.subframe = subframe;
    inputs.subframe_count = subframe_count;
    inputs.centre = centre;
    inputs.scale = scale;
    inputs.fps = fps;
    return inputs;
}

DrawnFrame draw_frame(PipelineRenderer& renderer, const FrameSetting& setting, const TakeSubframe& take,
                      const std::vector<std::string>& roles, bool again) {
    DrawnFrame drawn;
    std::vector<graph::PassTime> times;
    std::vector<std::string> messages;
    std::string history_reset;
    for (int subframe = 0; subframe < setting.subframe_count; ++subframe) {
        const std::shared_ptr<const Capture> capture = take(subframe);
        if (subframe == setting.subframe_count / 2) drawn.centre = capture;
        const FrameInputs inputs = setting.inputs(*capture, subframe, drawn.centre.get());
        FrameResult result =
            again ? renderer.render_again(inputs, roles, true) : renderer.render(inputs, roles, true);
        times.insert(times.end(), result.times.begin(), result.times.end());
        messages.insert(messages.end(), result.messages.begin(), result.messages.end());
        if (subframe == 0) history_reset = result.history_reset;
        drawn.result = std::move(result);
    }
    drawn.result.times = std::move(times);
    drawn.result.messages = std::move(messages);
    drawn.result.history_reset = std::move(history_reset);
    return drawn;
}

}  // namespace aftershade
