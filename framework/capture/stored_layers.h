// The stored channels of a role as one image; for the sources of this folder.
#pragma once

#include <string>
#include <vector>

#include "framework/capture/channel_names.h"
#include "framework/capture/frame_file.h"

namespace aftershade {

/// Those that a file has.
std::vector<std::string> present_of(const std::vector<std::string>& names);

/// The sum of the layers over the grid, as stored. If the file lacks alpha, it is 1, or the
/// coverage of deep samples; other missing components are 0.
Image read_layers(const FrameFile& file, const FoundChannels& channels, const Window& grid, float outside,
                  const DeepRead& how);

}  // namespace aftershade
