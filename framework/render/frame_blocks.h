// The uniform blocks that the host fills for a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/effect/shader_source.h"
#include "framework/look/look_grammar.h"
#include "framework/look/pipeline.h"
#include "framework/look/pixel_shape.h"

namespace aftershade {

/// The frame that was rendered before this one and belongs to the same shot.
struct FrameBefore {
    bool history_valid = false;
    std::optional<Camera> camera;
};

/// Differs between the steps of a look, by their names: a step inserted before one changes nothing of it.
std::uint32_t step_seed(const std::string& step);

/// The block `frame` of one step.
FrameBlock frame_block(const FrameInputs& frame, const StepGrid& grid, const std::string& step,
                       bool history_valid);

/// The block `camera`; `before` gives the prev_ matrices, unless the capture before is at hand.
CameraBlock camera_block(const FrameInputs& frame, const StepGrid& grid, const FrameBefore& before);

/// The block `lights` of a step that uses it. Throws Error(ErrorKind::capture) where the capture has more
/// than kMaxShaderLights.
LightsBlock lights_block(const FrameInputs& frame, const std::string& step);

/// The block of a step's "mix" and "mask" (glsl/host/mix.frag). Throws Error(ErrorKind::capture) where the
/// mix comes from the capture and does not fit.
std::vector<std::byte> mix_block(const PipelineStep& step, const StepGrid& grid, const FrameInputs& frame);
inline constexpr std::size_t kMixBlockBytes = 32 + 16 * kMaxMaskObjects;
inline constexpr int kMixBinding = 0;

template <typename Block>
std::vector<std::byte> bytes_of(const Block& block) {
    const auto* first = reinterpret_cast<const std::byte*>(&block);
    return {first, first + sizeof block};
}

}  // namespace aftershade
