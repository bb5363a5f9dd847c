// What an image means. One table serves reading, wiring, filtering rules and writing (docs/conventions.md).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/image/exr_file.h"
#include "framework/image/image.h"

namespace aftershade {

/// A role is spelled by name everywhere ("color", "velocity_next", "aov:mist"); this is its contract.
struct ChannelRole {
    std::string name;
    int channels = 0;
    ComponentType type = ComponentType::float32;
    bool filterable = false;                   ///< linear filtering is an error where it is not
    float outside = 0;                         ///< value outside the image's own data window
    std::vector<std::string> native_channels;  ///< names in the `native` profile and in outputs
    PixelType pixel_type = PixelType::half;    ///< stored as this by default
    std::string meaning;                       ///< one line with unit and space
};

/// The fixed roles, in the order of the documentation.
std::span<const ChannelRole> channel_roles();
/// nullopt for an unknown name; "aov:<name>" is a one-to-four channel image passed through.
std::optional<ChannelRole> find_role(std::string_view name);
std::vector<std::string> role_names();

}  // namespace aftershade
