// Roles of data under names that many programs use.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/capture/channel_names.h"
#include "framework/file/exr_file.h"

namespace aftershade {

/// The channels of a role of data (depth, normal, position, object_id) under one of its usual names. They are
/// looked for in the layer that the colour's channel lies in, then in each one above it. Above `layer` they
/// are looked for where that is "" only: then the file's only channels of such a name do, too. nullopt where
/// there is none, or several would do.
std::optional<FoundChannels> find_common_data(const ExrPart& part, std::string_view role,
                                              const std::string& layer, const std::string& color_channel);

/// All channels of the role under its usual names, in `layer` and below it: what find_common_data() chooses
/// from, and what would do as well. Without those of layers that are another picture.
std::vector<FoundChannels> find_all_common_data(const ExrPart& part, std::string_view role,
                                                const std::string& layer, const std::string& color_channel);

}  // namespace aftershade
