// The conventions of one producer of captures, as data: profiles/<id>.json.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/core/document.h"
#include "framework/image/exr_file.h"

namespace aftershade {

/// Which two frames a motion vector subtracts. A `next` delta may only fill velocity_next.
enum class VelocityDelta { cur_minus_prev, prev_minus_cur, next_minus_cur, cur_minus_next };

/// How the stored channels of one role become the canonical image.
struct RoleDecoding {
    /// Layers to add up (irradiance = direct + indirect); each names its channels, in the role's order. A name may begin
    /// with "{layer}." and may list alternatives: "{layer}.Depth.Z|{layer}.Depth.V". A name that ends in "?" may be absent.
    std::vector<std::vector<std::string>> layers;
    float scale = 1;  ///< depth: stored value times this is metres
    float no_hit = std::numeric_limits<float>::infinity();  ///< depth: stored values from here up mean that nothing was hit
    VelocityDelta delta = VelocityDelta::cur_minus_prev;
    bool y_axis_up = false;
};

struct Profile {
    std::string id;
    std::string summary;
    std::vector<std::string> detect_attributes;  ///< any of these in the header ...
    std::vector<std::string> detect_channels;    ///< ... or all of these channels tell that the profile fits
    std::map<std::string, RoleDecoding> roles;
};

/// All *.json of `folder`, in the order of their ids.
std::vector<Profile> read_profiles(const std::filesystem::path& folder, Diagnostics& diagnostics);
std::optional<Profile> parse_profile(const Node& node, Diagnostics& diagnostics);

/// The stored channels that a role's decoding finds in a part: per layer, per component; "" for an optional one that is
/// absent. nullopt where a required one is missing.
using FoundChannels = std::vector<std::vector<std::string>>;
std::optional<FoundChannels> find_channels(const RoleDecoding& decoding, const std::string& layer, const ExrPart& part);

/// What "{layer}" stands for in this part: the prefix before the channels of the color role; "" where none fits.
std::string find_layer(const Profile& profile, const ExrPart& part);

struct ProfileChoice {
    const Profile* profile = nullptr;
    std::string reason;  ///< "attribute BlenderMultiChannel"
};

/// The profile that fits a part's header. Throws Error(ExitCode::capture) where none does and Error(ExitCode::usage)
/// where several do, naming the remedy.
ProfileChoice detect_profile(const std::vector<Profile>& profiles, const ExrPart& part, const std::string& path);

}  // namespace aftershade
