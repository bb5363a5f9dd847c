// A frame that was issued, whose results may still be on their way.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/gpu/texture.h"
#include "framework/gpu/timer.h"
#include "framework/graph/executor.h"
#include "framework/render/frame_result.h"

namespace aftershade {

/// Made by PipelineRenderer::begin(). [the context's thread, within the renderer's life]
class PendingFrame {
public:
    /// The texels of a role or a tap.
    struct Read {
        std::string name;
        bool is_tap = false;
        Image image;  ///< where they will be
        gpu::TexelRead texels;
    };

    explicit PendingFrame(gpu::Context& context) : context_(context) {}
    PendingFrame(PendingFrame&&) noexcept = default;

    /// What was known when the passes had been issued: all but images, taps and times.
    FrameResult result;
    std::vector<Read> reads;
    bool is_timed = false;
    bool is_partial = false;  ///< of a sub-frame before the last: nothing is read
    std::vector<gpu::Duration> uploads;
    std::vector<graph::PendingTime> passes;
    std::optional<gpu::Duration> readback;  ///< of reads that were issued; nullopt: finish() does it all

    /// Waits for the passes and the texels. Once.
    FrameResult finish();

private:
    gpu::Context& context_;
};

}  // namespace aftershade
