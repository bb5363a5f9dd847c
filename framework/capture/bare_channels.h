// Channels that are named by a component alone (R, G, B): which roles may be read from them. In a capture's
// main file they are the colour; a file that was given for one role holds that role.
#pragma once

#include <optional>
#include <string>

#include "framework/capture/profile.h"
#include "framework/image/role.h"

namespace aftershade {

/// The decoding without names that are a component of colour alone. A channel without another name is not
/// found.
RoleDecoding without_bare_names(RoleDecoding decoding);

/// Whether every channel is of the same layer, or of none.
bool has_one_layer(const ExrPart& part);

/// The channels of a file that was given for one role and calls them something else. nullopt where the
/// choice would be a guess.
std::optional<FoundChannels> find_only_channels(const ChannelRole& role, const ExrPart& part);

/// Why a file that was given for a role does not have it, its channels, and how to name them.
std::string no_channels_for_role(const ChannelRole& role, const ExrPart& part, bool are_named);

}  // namespace aftershade
