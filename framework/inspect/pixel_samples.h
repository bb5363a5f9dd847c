// Stored values at one pixel, and the numbers of samples of deep pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"

namespace aftershade {

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
