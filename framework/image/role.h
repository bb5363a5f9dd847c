// Roles: the meanings of images. One table serves reading, wiring, filtering rules and writing
// (docs/conventions.md).
#pragma once

#include <array>
#include <compare>
#include <cstddef>
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

/// The contract of a role, which documents spell by name ("color", "velocity_next", "aov:mist").
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

/// Which image of a capture: a role as documents spell it ("color", "aov:mist"), the layer that it is of, and
/// the objects whose share of each pixel it holds, which no document can spell.
class RoleId {
public:
    /// "layer1:depth" is of a layer; any other name is of the whole picture.
    RoleId(std::string name);
    RoleId(std::string_view name) : RoleId(std::string(name)) {}
    RoleId(const char* name) : RoleId(std::string(name)) {}
    /// The role of the share of a pixel, 0 to 1, that some objects cover. The program reads it from captures
    /// where a look names the objects of a mask; no document can.
    static RoleId coverage(std::span<const TableKey> objects);
    /// The image of a role in one layer of a capture, 0 in front. Manifests name it by "layer".
    static RoleId of_layer(int layer, std::string_view role);

    const std::string& name() const { return name_; }
    /// -1: not of a layer, but of the whole picture.
    int layer() const { return layer_; }
    /// Without its layer.
    std::string of_any_layer() const { return name_.substr(layer_prefix_); }
    bool is_coverage() const { return !objects_.empty(); }
    const std::vector<TableKey>& objects() const { return objects_; }

    /// By name. A role made of the name of a coverage equals it, but has no objects.
    bool operator==(const RoleId& other) const { return name_ == other.name_; }
    auto operator<=>(const RoleId& other) const { return name_ <=> other.name_; }

private:
    std::string name_;
    int layer_ = -1;
    std::size_t layer_prefix_ = 0;  // how much of the name says the layer
    std::vector<TableKey> objects_;
};

/// The fixed roles, in the order of the documentation.
std::span<const ChannelRole> channel_roles();
/// nullopt for an unknown name; "aov:<name>" is a one-to-four channel image passed through.
std::optional<ChannelRole> find_role(const RoleId& role);
std::vector<std::string> role_names();
std::vector<RoleId> role_ids(std::span<const std::string> names);

/// Whether the values of layers are put over one another, as light is; of others the layer that shows most
/// counts: depths, vectors and ids have no mean.
bool is_blended(RoleKind kind);

/// RoleKind::other for a name that is not a role's.
RoleKind kind_of_role(const RoleId& role);

}  // namespace aftershade
