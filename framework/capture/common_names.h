// Names of channels that many programs use, for files in which a producer's profile finds nothing.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/capture/channel_names.h"
#include "framework/file/exr_file.h"

namespace aftershade {

/// Layers that hold a colour: every prefix before R, G and B, in upper or lower case or in full (`red`), in
/// the file's order; "" for none, which may also be before X, Y and Z where the chromaticities are CIE XYZ's.
/// Without Cryptomattes and layers whose name says that they are not a picture.
std::vector<std::string> color_layers(const ExrPart& part);

/// The colour of a file whose profile does not name it: of `layer`, or of a layer below it. With "" the
/// channels without a layer, else the layer that has one of the usual names, else the only one. nullopt where
/// there is none or several would do.
std::optional<FoundChannels> find_common_color(const ExrPart& part, const std::string& layer);

/// Red, green and blue of the file's own picture under each name that is usual for it, not below any layer.
std::vector<FoundChannels> find_all_common_colors(const ExrPart& part);

/// The alpha that belongs to a colour whose first channel is `red`: of its layer, else the file's only one,
/// under one of the usual names (A, alpha, alpha.V); "" where there is none.
std::string find_common_alpha(const ExrPart& part, const std::string& red);

/// Whether it has a channel of that full name.
bool has_channel(const ExrPart& part, std::string_view name);

/// Whether a channel is one of the three of a colour in CIE XYZ, and so no depth and no luminance.
bool is_tristimulus(const ExrPart& part, const std::string& channel);

/// Whether X, Y and Z stand side by side without a layer: a colour in CIE XYZ, positions or normals, so that
/// Y is not a luminance.
bool has_x_y_z(const ExrPart& part);

/// Whether a channel lies in the layer or in one below it.
bool has_layer(const ExrPart& part, const std::string& layer);

}  // namespace aftershade
