// One spelling for the names of channels, which programs write in several; which of them make up a role.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "framework/file/exr_file.h"

namespace aftershade {

/// The name in lower case, with a dot for every dot, underscore, hyphen and space, without a dot before it,
/// and with r, g, b or a where it ends in red, green, blue or alpha: "view.layer.combined.r" for
/// "View Layer.Combined.R", and for "View_Layer_Combined.red", as Nuke writes it again.
std::string canonical_name(std::string_view name);

/// A channel's name as a layer, "" for none, and a component in the spelling of canonical_name(). In a name
/// without a dot, the component of a colour may follow an underscore: "beauty_R".
struct ChannelName {
    std::string layer;
    std::string component;
    bool operator==(const ChannelName&) const = default;
};
ChannelName split_channel_name(const std::string& name);

/// "'A', 'B' and 'G'", or the first of many with "and 12 more".
std::string channel_list(const ExrPart& part);

/// Channels whose names are those of motion vectors; names have neither unit nor direction.
std::vector<std::string> channels_of_motion(const std::vector<std::string>& channels);

/// The role that the last word of a file's name says, before the number of the frame: "depth" of
/// shot_zdepth.0001.exr. "" for none. `stem` is the name without its extension.
std::string role_in_file_name(std::string_view stem);

/// Per layer that is added up, per component; "" for an optional channel that is absent.
using FoundChannels = std::vector<std::vector<std::string>>;

/// Those that a file has, of all layers.
inline std::vector<std::string> names_of(const FoundChannels& found) {
    std::vector<std::string> names;
    for (const auto& layer : found)
        for (const std::string& name : layer)
            if (!name.empty()) names.push_back(name);
    return names;
}

}  // namespace aftershade
