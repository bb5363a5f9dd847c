// One spelling for the names of channels, which programs write in several.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/capture/found_channels.h"
#include "framework/file/exr_file.h"

namespace aftershade {

/// The name in lower case, with a dot for every dot, underscore, hyphen and space, without a dot before it,
/// and with r, g, b or a where it ends in red, green, blue or alpha: "view.layer.combined.r" for
/// "View Layer.Combined.R", and for "View_Layer_Combined.red", as Nuke writes it again.
std::string canonical_name(std::string_view name);

/// A channel's name as a layer, "" for none, and a component in the spelling of canonical_name(). Of a name
/// without a dot the component of a colour may follow an underscore: "beauty_R".
struct ChannelName {
    std::string layer;
    std::string component;
    bool operator==(const ChannelName&) const = default;
};
ChannelName split_channel_name(const std::string& name);

/// The channels of a role of data (depth, normal, position, object_id) under one of its usual names. They are
/// looked for in the layer that the colour's channel lies in, then in each one above it. Above `layer` they
/// are looked for where that is "" only: then the file's only channels of such a name do, too. nullopt where
/// there is none, or several would do.
std::optional<FoundChannels> find_common_data(const ExrPart& part, std::string_view role,
                                              const std::string& layer, const std::string& color_channel);

/// Channels whose name says that they are motion vectors; no name tells their unit and their direction.
std::vector<std::string> channels_of_motion(const std::vector<std::string>& channels);

}  // namespace aftershade
