// From a canonical image to the channels that a producer stores; for the sources of this folder.
#pragma once

#include <map>
#include <string>

#include "framework/capture/decode.h"
#include "framework/capture/profile.h"
#include "framework/image/image.h"

namespace aftershade {

/// One single-channel image for each stored channel of `role`. A sum of layers cannot be separated
/// again, so the first layer holds all of it. `ids_as_uint`: whether the file stores ids as integers. Colours
/// stay unchanged.
std::map<std::string, Image> encode_role(const std::string& role, Image canonical,
                                         const RoleDecoding& decoding, const FoundChannels& channels,
                                         bool ids_as_uint, const DecodeContext& context);

}  // namespace aftershade
