// Roles: the meanings of images. One table serves reading, wiring, filtering rules and writing
// (docs/conventions.md).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/document/object_keys.h"
#include "framework/image/image.h"
#include "framework/image/pixel_type.h"

namespace aftershade {

/// The quantity that a role's values measure. Code that treats roles differently tests their kind, so that a
/// new role needs no change there.
enum class RoleKind {
    light,      ///< scene-linear colours in the capture's primaries
    distance,   ///< m along the view axis
    motion,     ///< px per frame
    direction,  ///< world space, unit vectors
    place,      ///< world space, m
    id,         ///< names, not amounts
    coverage,   ///< 0 to 1
    display,    ///< made by effects, never by renderers: encoded for a screen
    other       ///< "aov:<name>": passed through
};
inline constexpr std::array kRoleKinds = {RoleKind::light,     RoleKind::distance, RoleKind::motion,
                                          RoleKind::direction, RoleKind::place,    RoleKind::id,
                                          RoleKind::coverage,  RoleKind::display,  RoleKind::other};

// The roles that code means by themselves.
inline constexpr const char* kColorRole = "color";      ///< what a look starts from and ends with
inline constexpr const char* kDisplayRole = "display";  ///< what pictures for a screen hold
inline constexpr const char* kDepthRole = "depth";
inline constexpr const char* kIrradianceRole = "irradiance";
inline constexpr const char* kAlbedoRole = "albedo";
inline constexpr const char* kObjectIdRole = "object_id";
inline constexpr const char* kMaskRole = "mask";

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
    RoleKind kind = RoleKind::other;
    bool to_next = false;   ///< motion: to the next frame's position, not from the previous one's
    bool is_share = false;  ///< light: a share of it, 0 to 1, which needs no exposure to be seen

    /// Its alpha may be absent from files, which is 1 then; such a file may hold luminance alone.
    bool has_optional_alpha() const { return kind == RoleKind::light && channels == 4; }
};

/// The fixed roles, in the order of the documentation.
std::span<const ChannelRole> channel_roles();
/// nullopt for an unknown name; a coverage_role() is one; "aov:<name>" is a one-to-four channel image passed
/// through.
std::optional<ChannelRole> find_role(std::string_view name);
std::vector<std::string> role_names();

/// The role of the share of a pixel, 0 to 1, that some objects cover. The program reads it from captures
/// where a look names the objects of a mask; no document can.
std::string coverage_role(std::span<const TableKey> objects);
bool is_coverage_role(std::string_view name);
/// The objects that coverage_role() was made of.
std::vector<TableKey> objects_of_coverage(std::string_view role);

/// The image of a role in one layer of a capture, 0 in front: "layer1:depth". Manifests name it by "layer".
std::string layer_role(int layer, std::string_view role);
struct RoleOfLayer {
    int layer = -1;  ///< -1: not of a layer, but of the whole picture
    std::string role;
};
/// The role in a name that layer_role() made; any other name is itself.
RoleOfLayer split_layer_role(std::string_view name);

/// Whether the values of layers are put over one another, as light is; of others the layer that shows most
/// counts: depths, vectors and ids have no mean.
bool is_blended(RoleKind kind);

/// RoleKind::other for a name that is not a role's.
RoleKind kind_of_role(std::string_view name);

}  // namespace aftershade
