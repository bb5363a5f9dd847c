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

namespace {

/// The last sub-frame's result, with the times and the messages of all.
class Joined {
public:
    void add(FrameResult result) {
        times_.insert(times_.end(), result.times.begin(), result.times.end());
        messages_.insert(messages_.end(), result.messages.begin(), result.messages.end());
        if (!std::exchange(any_, true)) history_reset_ = result.history_reset;
        last_ = std::move(result);
    }
    FrameResult take() {
        last_.times = std::move(times_);
        last_.messages = std::move(messages_);
        last_.history_reset = std::move(history_reset_);
        return std::move(last_);
    }

private:
    FrameResult last_;
    std::vector<graph::PassTime> times_;
    std::vector<std::string> messages_;
    std::string history_reset_;
    bool any_ = false;
};

/// Calls draw(inputs) for each sub-frame; returns the one at the middle of the exposure.
template <typename Draw>
std::shared_ptr<const Capture> for_each_subframe(const FrameSetting& setting, const TakeSubframe& take,
                                                 const Draw& draw) {
    std::shared_ptr<const Capture> centre;
    for (int subframe = 0; subframe < setting.subframe_count; ++subframe) {
        const std::shared_ptr<const Capture> capture = take(subframe);
        if (subframe == setting.subframe_count / 2) centre = capture;
        draw(setting.inputs(*capture, subframe, centre.get()));
    }
    return centre;
}

}  // namespace

BegunFrame begin_frame(PipelineRenderer& renderer, const FrameSetting& setting, const TakeSubframe& take,
                       const std::vector<std::string>& roles) {
    BegunFrame begun;
    begun.centre = for_each_subframe(setting, take, [&](const FrameInputs& inputs) {
        begun.subframes.push_back(renderer.begin(inputs, roles, true));
    });
    return begun;
}

DrawnFrame finish_frame(BegunFrame begun) {
    Joined joined;
    for (PendingFrame& subframe : begun.subframes) joined.add(subframe.finish());
    return {std::move(begun.centre), joined.take()};
}

DrawnFrame draw_frame(PipelineRenderer& renderer, const FrameSetting& setting, const TakeSubframe& take,
                      const std::vector<std::string>& roles, bool again) {
    Joined joined;
    auto centre = for_each_subframe(setting, take, [&](const FrameInputs& inputs) {
        joined.add(again ? renderer.render_again(inputs, roles, true) : renderer.render(inputs, roles, true));
    });
    return {std::move(centre), joined.take()};
}

}  // namespace aftershade
