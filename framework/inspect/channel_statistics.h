// Statistics of a channel's stored values, for people who look for the fault in a capture.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "framework/image/image.h"

namespace aftershade {

struct ChannelStatistics {
    std::optional<double> min, max;  ///< of the finite values; nullopt where there is none
    std::uint64_t nan = 0;
    std::uint64_t infinite = 0;  ///< of either sign
    std::uint64_t negative = 0;  ///< below zero, -inf too, -0 not
};

/// Statistics of each channel.
std::vector<ChannelStatistics> channel_statistics(const Image& image);

/// A channel of a file, with its figures or why there are none.
struct InspectedChannel {
    ExrChannel channel;
    std::optional<ChannelStatistics> statistics;
    std::string reason;  ///< where there are no statistics
    bool readable =
        true;  ///< false: the file is damaged, incomplete or above the limits, and `reason` says how
};

/// Every channel of a part, in the file's order; of deep parts the figures are of all samples. Subsampled
/// channels have a reason instead of figures. At most three quarters of `limits.max_image_bytes` is read at
/// once, or a single channel.
std::vector<InspectedChannel> inspect_channels(const ExrFile& file, int part, const ReadLimits& limits);

}  // namespace aftershade
