#include "framework/host/sequence_player.h"

#include <algorithm>
#include <string>
#include <utility>

#include "framework/host/host_non_finite.h"

namespace aftershade::host {

namespace {

aftershade::Sequence with_objects(aftershade::Sequence sequence, const Pipeline& pipeline) {
    sequence.object_names = pipeline.object_names();
    return sequence;
}

NanPolicy policy_of(NonFinite policy) {
    return policy == NonFinite::mend ? NanPolicy::mend : NanPolicy::warn;
}

void check_played_options(const RenderOptions& options) {
    const RenderOptions usual;
    const char* option = options.previous           ? "previous"
                         : options.next             ? "next"
                         : options.begins_shot      ? "begins_shot"
                         : options.fps != usual.fps ? "fps"
                                                    : nullptr;
    if (option)
        fail_at(ErrorKind::usage, std::string("RenderOptions::") + option, "the sequence decides this");
}

}  // namespace

SequencePlayer::SequencePlayer(Rendering& rendering, std::shared_ptr<const Sequence::Data> sequence,
                               NonFinite policy)
    : rendering_(rendering),
      from_(std::move(sequence)),
      policy_(policy),
      revision_(rendering.look().revision),
      sequence_(with_objects(from_->sequence, rendering.look().pipeline)),
      reader_(sequence_, from_->profiles, from_->limits) {
    reader_.share_first_of(*from_->reader);
    run_.frames = sequence_.frames;
    run_.on_nan = policy_of(policy);
    run_.scale_divisor = from_->options.scale_divisor;
}

Result::Data SequencePlayer::render(int frame, const RenderOptions& options) {
    check_played_options(options);
    const auto index = std::find(run_.frames.begin(), run_.frames.end(), frame);
    if (index == run_.frames.end())
        fail_at(ErrorKind::usage, "frame", "the sequence has no frame " + std::to_string(frame));
    const Pipeline& pipeline = rendering_.look().pipeline;
    std::vector<RoleId> reads = pipeline.capture_roles();
    const std::vector<std::string> made = made_roles(pipeline);
    for (const std::string& role : options.roles)
        if (std::find(made.begin(), made.end(), role) == made.end()) reads.emplace_back(role);
    if (!loader_ || reads != asked_) {
        asked_ = reads;
        loader_.reset();
        loader_ = std::make_unique<FrameLoader>(sequence_, reader_, pipeline, run_, std::move(reads));
    }
    rendering_.prepare(options);
    // What the capture lacks is known when it is read.
    const std::vector<std::string> roles = rendering_.asked_roles(options, options.roles);
    Result::Data result;
    RunReport report;
    RunObserver observer;
    observer.frame_started = [&](const aftershade::Capture& capture) {
        result.non_finite = non_finite_of(capture);
        if (policy_ == NonFinite::fail && !result.non_finite.empty())
            refuse_non_finite(result.non_finite.front());
    };
    FrameRun run(rendering_.renderer(), *loader_, sequence_, run_);
    const FrameRun::Rendered rendered =
        run.render(std::size_t(index - run_.frames.begin()), roles, report, observer);
    const auto found = non_finite_of(rendered.non_finite);
    if (policy_ == NonFinite::fail && !found.empty()) refuse_non_finite(found.front());
    result.non_finite.insert(result.non_finite.end(), found.begin(), found.end());
    if (policy_ == NonFinite::ignore) result.non_finite.clear();
    result.frame = rendered.result;
    result.capture = rendered.capture;
    for (const std::string& role : roles)
        if (!options.targets.contains(role) && !result.frame->images.contains(role) &&
            !result.capture->images.contains(role))
            fail_at(ErrorKind::capture, "RenderOptions::roles",
                    "no step makes '" + role + "', and frame " + std::to_string(frame) + " does not have it");
    rendering_.finish(options, roles, result);
    return result;
}

}  // namespace aftershade::host
