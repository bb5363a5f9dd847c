// Readings of motion vectors that differ from a profile's in their bias or unit: what the stored values hint
// at. No other file than velocity_check.cpp includes it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/image/image.h"
#include "framework/inspect/velocity_result.h"

namespace aftershade {

/// Vectors as the file stores them: what `settings` decoded to px, undone. An exchange of channels is not
/// undone.
Image stored_vectors(const Image& decoded, const VelocitySettings& settings);

/// Stored vectors in px. Those at a limit of the stored range become NaN, as a clamped vector is false.
Image read_vectors(const Image& stored, const VelocitySettings& settings);

struct OtherReading {
    VelocitySettings settings;
    /// The bias is the stored value, in both channels, of a large part of the picture.
    bool is_common_value = false;
};

/// Hints from the range and the most common value of the stored vectors of both frames.
std::vector<OtherReading> other_readings(const std::vector<Image>& stored, const VelocitySettings& claim);

/// "1298 pixels are stored as 1, the end of the range 0 to 1"; "" where no values pile up at a limit.
std::string describe_limit(const std::vector<Image>& stored, const VelocitySettings& settings);

}  // namespace aftershade
