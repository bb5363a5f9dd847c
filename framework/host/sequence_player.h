// Frames of a sequence for a session, as `aftershade run` renders them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/host/rendering.h"
#include "framework/run/frame_run.h"

namespace aftershade::host {

/// [the host's thread; reads ahead on threads of its own]
class SequencePlayer {
public:
    /// `rendering` must outlive it.
    SequencePlayer(Rendering& rendering, std::shared_ptr<const Sequence::Data> sequence, NonFinite policy);

    /// Whether these are what it was made for.
    bool plays(const std::shared_ptr<const Sequence::Data>& sequence, NonFinite policy, int revision) const {
        return sequence == from_ && policy == policy_ && revision == revision_;
    }
    /// Throws as Session::render.
    Result::Data render(int frame, const RenderOptions& options);

private:
    Rendering& rendering_;
    std::shared_ptr<const Sequence::Data> from_;
    NonFinite policy_;
    int revision_;
    aftershade::Sequence sequence_;  // with the look's objects
    CaptureReader reader_;
    RunOptions run_;
    std::unique_ptr<FrameLoader> loader_;
    std::vector<RoleId> asked_;  // roles that the loader reads
};

}  // namespace aftershade::host
