// The conventions of one producer of captures, as data: profiles/<id>.json.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/capture/channel_names.h"
#include "framework/document/document.h"
#include "framework/file/exr_file.h"

namespace aftershade {

/// Which two frames a motion vector subtracts. A `next` delta may only fill velocity_next.
enum class VelocityDelta { cur_minus_prev, prev_minus_cur, next_minus_cur, cur_minus_next };

/// Length 1 of a stored motion vector: a pixel, the image's side, or half of it (from -1 to +1).
enum class VelocityUnit { px, uv, ndc };

/// The quantity that a stored depth is a function of: distance; 1 / distance; a perspective z-buffer; or
/// linear between near and far.
enum class DepthEncoding { linear, inverse, z_buffer, normalized };

/// No material reflects less: charcoal reflects 0.02 to 0.04. An albedo of 8 bits is up to 0.002 off.
inline constexpr double kAlbedoFloor = 0.01;

/// How the stored channels of one role become the canonical image.
struct RoleDecoding {
    /// Layers to add up (irradiance = direct + indirect); each names its channels, in the role's order. A
    /// name may begin with "{layer}.", which stands for nothing where a file has no layers, and may list
    /// alternatives: "{layer}.Depth.Z|{layer}.Depth.V"; "*" stands for any text. A name that ends in "?" may
    /// be absent.
    std::vector<std::vector<std::string>> layers;
    std::string
        luminance;  ///< color: the Y channel that stands for it in luminance-chroma files; "" for none

    /// Each value is the mean of a pixel's samples, so at edges it lies between two surfaces: the nearer
    /// one's stands for it (repair_means). Of images that are not filtered: depth, motion, normals,
    /// positions.
    bool is_mean = false;

    float scale = 1;  ///< depth: metres for one stored unit; irradiance: of what is decoded

    // depth
    float no_hit =
        std::numeric_limits<float>::infinity();  ///< stored values from here up mean that nothing was hit
    std::optional<float> no_hit_stored;          ///< what the producer itself writes there; else no_hit
    bool zero_is_no_hit = false;
    DepthEncoding encoding = DepthEncoding::linear;
    bool reversed = false;                ///< z_buffer and normalized: 1 is near, 0 is far
    bool radial = false;                  ///< distance to the camera's point, not along its axis
    std::optional<double> near_m, far_m;  ///< z_buffer and normalized; else the camera's near and far
    double offset_m = 0;                  ///< added to the planar depth: where the stored one begins

    // velocity and velocity_next, in the order in which they are undone
    float bias = 0;              ///< stored value of no motion
    bool premultiplied = false;  ///< by color's alpha
    VelocityUnit unit = VelocityUnit::px;
    std::array<float, 2> velocity_scale = {1, 1};
    VelocityDelta delta = VelocityDelta::cur_minus_prev;
    bool y_axis_up = false;
    /// A stored x above the one or below the other marks a pixel without motion data.
    std::optional<float> no_motion_above, no_motion_below;
    double shutter_frames = 1;  ///< frames that the stored vector spans

    // irradiance, in the order in which they are done
    std::vector<std::string> plus;       ///< roles to add where they are there: light in files of its own
    bool times_albedo = false;           ///< the sum is light that the surface reflects: divided by albedo
    double albedo_floor = kAlbedoFloor;  ///< the least that it is divided by
    /// Other ways, of which the first counts whose channels are there.
    std::vector<RoleDecoding> otherwise;
};

/// A camera value out of the header: the first of these attributes that is there. "*" stands for any text.
struct CameraSource {
    std::vector<std::string> attributes;
    std::string unit;                 ///< that the attribute is in
    bool times_sensor_width = false;  ///< it counts in widths of the sensor instead
};

/// One thing that is known of the producer, for the table of the docs.
struct ProfileFact {
    std::string fact;
    std::string verified;  ///< the real file that showed it; "" where none has
    std::string source;
};

struct Profile {
    std::string id;
    std::filesystem::path file;  ///< that it was read from
    std::string summary;
    /// Any of these in the header, by name or as "name=text" ...
    std::vector<std::string> detect_attributes;
    std::vector<std::string> detect_channels;  ///< ... or all of these channels show that the profile fits
    bool rewrites = false;  ///< also writes other producers' files again, whose attributes then say more
    std::string color_space = "auto";  ///< of the stored colours; auto: what the header says, else Rec. 709
    std::string lens_model;            ///< "thin" or "pinhole"; "" where not known
    std::map<std::string, RoleDecoding> roles;
    std::map<std::string, std::string> remedies;  ///< by role: settings of the producer that write it
    std::map<std::string, CameraSource> camera;   ///< by camera field
    std::optional<CameraSource> field_of_view;    ///< across the picture's width
    std::vector<std::string> seen_on;             ///< real files, below the folder of captures for tests
    std::vector<ProfileFact> facts;
};

/// All *.json of the folders, in the order of their ids; an earlier folder's profile replaces a later one's
/// of the same id.
std::vector<Profile> read_profiles(const std::vector<std::filesystem::path>& folders,
                                   Diagnostics& diagnostics);
std::vector<Profile> read_profiles(const std::filesystem::path& folder, Diagnostics& diagnostics);
std::optional<Profile> parse_profile(const Node& node, Diagnostics& diagnostics);
/// "roles" of a profile, or "channels" of a capture.json, which has been checked.
std::map<std::string, RoleDecoding> read_decodings(const Node& node);

/// The stored channels that a role's decoding finds in a part. nullopt where a required one is missing. Names
/// are first taken as they are, then in any case, then by canonical_name().
std::optional<FoundChannels> find_channels(const RoleDecoding& decoding, const std::string& layer,
                                           const ExrPart& part);

/// Values of "{layer}" in this part: the prefixes before the channels of the color role, in the
/// part's order.
std::vector<std::string> find_layers(const Profile& profile, const ExrPart& part);
/// The first of them; "" where none fits.
std::string find_layer(const Profile& profile, const ExrPart& part);

struct ProfileChoice {
    const Profile* profile = nullptr;
    std::string reason;  ///< "attribute BlenderMultiChannel"
};

/// The profile that fits a part's header: by attribute first, else the one that names the most channels, else
/// `native` where the file has a plain colour. A file of this program with native names is `native`. Throws
/// Error(ErrorKind::capture) where none does and Error(ErrorKind::usage) where several do alike, naming the
/// remedy; with `has_declared_color`, where capture.json names the colour's channels, it is `native` then.
ProfileChoice detect_profile(const std::vector<Profile>& profiles, const ExrPart& part,
                             const std::string& path, bool has_declared_color = false);

/// Whether `name` is `pattern` with each "*" in it replaced by some text.
bool matches_pattern(const std::string& name, const std::string& pattern);

}  // namespace aftershade
