// The grammar of capture.json and its parts, declared once (framework/document/grammar.h).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "framework/document/grammar.h"
#include "framework/image/role.h"

namespace aftershade {

/// How the stored alpha of color is read: "keep", or "opaque", as 1.
const std::vector<std::string>& alpha_names();
inline constexpr std::string_view kOpaqueAlpha = "opaque";

/// capture.json
const grammar::Block& capture_block();
const grammar::Block& capture_camera_block();
const grammar::Block& capture_light_block();
const grammar::Block& capture_layer_block();
/// How the stored channels of a role become its image: in "channels" of a capture, in "roles" of a profile.
/// One for every image that is passed through, "aov:<name>".
const grammar::Block& decoding_block(const std::string& role);
/// The keys of all decodings, for the docs.
const grammar::Block& decoding_table();
/// An object with a decoding for each of some roles.
grammar::Form decodings();

/// JSON Schema of a capture.json.
std::string capture_schema();

/// Whether the role may be stored as the mean of a pixel's samples: what is not filtered and not an id.
bool can_be_mean(const ChannelRole& role);

/// The key of one component: "x" of "velocity.X", "z" of "Z".
std::string component_key(const std::string& native_channel);

// Names in the order of their enumerations.
const std::vector<std::string>& velocity_delta_names();
const std::vector<std::string>& velocity_unit_names();
const std::vector<std::string>& depth_encoding_names();

}  // namespace aftershade
