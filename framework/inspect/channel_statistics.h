// Statistics of a channel's stored values, for people who look for the fault in a capture; the values at one
// pixel, and the numbers of samples of deep pixels.
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

/// Pixels with `least` to `most` samples.
struct SampleCount {
    std::uint64_t least = 0;
    std::uint64_t most = 0;
    std::uint64_t pixels = 0;
};

/// Pixels of a deep part with 0, 1, 2, 3 to 4, 5 to 8, ... samples, up to the largest count. Reads only
/// counts. Throws Error(ErrorKind::capture).
std::vector<SampleCount> sample_histogram(const ExrFile& file, int part);

/// The stored values of a part at one pixel: a list for each sample, of flat parts one. Empty outside of the
/// data window. Subsampled channels are left out.
struct PixelSamples {
    std::vector<std::string> channels;
    std::vector<std::vector<double>> samples;
};

/// `x` and `y` in the file's coordinates. Throws Error(ErrorKind::capture).
PixelSamples samples_at(const ExrFile& file, int part, int x, int y);

}  // namespace aftershade
