// The layers of a picture file: channels that are compared together, by a role.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/compare/difference_rules.h"
#include "framework/file/exr_file.h"
#include "framework/image/image.h"

namespace aftershade {

/// How a layer is compared. `color`: scene-linear light. `display`: encoded colours in [0, 1]. `alpha`: apart
/// from its colours, so that it is in no perceptual measure. `depth`: relative to the reference. `velocity`:
/// vectors in px. `id`: equal or not. `data`: plain numbers.
enum class LayerRole { color, display, alpha, depth, velocity, id, data };

std::string_view layer_role_name(LayerRole role);
std::optional<LayerRole> find_layer_role(std::string_view name);
/// In the order of the enumeration.
std::vector<std::string> layer_role_names();
/// color and display: the roles with FLIP and SSIM.
bool is_perceptual(LayerRole role);

/// Channels of one part that share their name up to the last dot, without their alpha. [value type]
struct LayerInfo {
    std::string part;   ///< "" where the file has one part only
    std::string view;   ///< the part's own; "" where the file has one part only
    std::string name;   ///< up to the last dot: "diffuse" of diffuse.R; "" of R
    std::string group;  ///< separates layers of one name: "color", "alpha", "depth", "id", "" or a channel
    LayerRole role = LayerRole::data;
    std::vector<std::string> channels;  ///< whole names; R G B, X Y Z W, u v in that order, others as stored
    ComponentType type = ComponentType::float32;  ///< uint32 where every channel is uint
    StoredPrecision stored;                       ///< of the coarsest channel
    Window data_window;
    Window display_window;

    /// For people, and for CompareRules::roles: "RGB", "A", "Z", "diffuse.RGB", "left:forward.uv".
    std::string label() const;
    /// Layers of two files with one key are compared with each other.
    std::string key() const { return part + "\n" + name + "\n" + group; }
};

/// `part` empty: the only one of its file. A channel without a layer's name has the part's: R, G and B of
/// the part "N" are plain numbers, X and Y of "velocity" are one layer.
std::vector<LayerInfo> layers_of_channels(const std::string& part, std::span<const ExrChannel> channels,
                                          const Window& data_window, const Window& display_window);

}  // namespace aftershade
