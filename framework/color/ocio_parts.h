// The parts of a transform of OpenColorIO: those that are curves of each channel, and what lies between.
// Empty where the library is absent.
#pragma once

#ifdef AFTERSHADE_HAS_OPENCOLORIO
#include <optional>
#include <string_view>
#include <vector>

#include "framework/color/color_glsl.h"
#include "framework/color/ocio_config.h"

namespace aftershade {

struct TransformPart {
    ocio::ConstProcessorRcPtr processor;
    /// What the part makes of a channel, where reading that from a table costs less than OpenColorIO's own
    /// text and is as good: within kCurveTolerance.
    std::optional<BitCurve> curve;
    /// Our shorter text of the same function, "vec3 $name(vec3 rgb)"; "" where OpenColorIO's is to be taken.
    std::string_view text;
};

/// Shares of a value, or of 0.01 where that is more. For a view kPartsTolerance is a difference of the
/// display's numbers.
inline constexpr double kCurveTolerance = 5e-5;
inline constexpr float kPartsTolerance = 2.5e-4f;

/// In the order in which they apply: one part where the curves of several would be too far from the whole.
/// Throws ocio::Exception.
std::vector<TransformPart> parts_of(const ocio::ConstConfigRcPtr& config,
                                    const ocio::ConstProcessorRcPtr& processor, bool is_view);

}  // namespace aftershade
#endif
