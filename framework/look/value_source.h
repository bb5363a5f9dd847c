// The forms that a value may have in a look, and what each gives for one frame.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/document/param.h"
#include "framework/look/ease.h"

namespace aftershade {

/// {"from": "camera.focus_distance"}: of the capture; it is an error where the capture lacks it.
struct CameraValue {
    std::string field;  ///< "focus_distance", "lens_model"
};

/// {"from": "depth", "uv": [0.5, 0.5]} or {"from": "depth", "object": 2}: of one point of the display window
/// (u right, v down, from 0 to 1) or the median over the pixels of objects.
struct PixelValue {
    enum class Measure {
        depth,     ///< metres along the view axis
        luminance  ///< stops that bring the light of `color` to 18 % grey
    };
    Measure measure = Measure::depth;
    std::optional<std::array<double, 2>> uv;
    std::vector<TableKey> objects;  ///< one entry of a document: a name, or ids and ranges of ids
};

using KeyValue = std::variant<ParamValue, CameraValue, PixelValue>;

/// {"keys": {"1": 2.0, "24": {"from": ...}}, "interpolation": "linear"}: by frame, constant before the first
/// key and after the last. A key from the capture has the value that the capture gives for each frame.
struct KeyedValue {
    /// 2.0, or {"value": 2.0, "interpolation": "smooth"}
    struct Key {
        KeyValue value;
        std::optional<Ease> ease;  ///< to the next key; absent: the one of all keys
    };
    std::map<int, Key> keys;
    Ease ease;
};

using ValueSource = std::variant<ParamValue, KeyedValue, CameraValue, PixelValue>;

/// Each value that the source takes from pixels, by itself or in a key.
std::vector<const PixelValue*> pixel_values(const ValueSource& source);

/// Reads a value for `spec` in any form. `label` names the parameter in messages.
std::optional<ValueSource> parse_value_source(const ParamSpec& spec, const Node& node,
                                              const std::string& label, Diagnostics& diagnostics);

/// The value as a document would write it.
std::string format_source(const ValueSource& source);

/// Roles that the value is taken from: depth or color; object_id, or the coverage of named objects.
std::vector<RoleId> roles_of(const ValueSource& source);

/// The value for one frame. Throws Error(ErrorKind::capture) naming `label` where the capture lacks what it
/// is taken from or gives a value outside the range of `spec`.
ParamValue evaluate(const ValueSource& source, const ParamSpec& spec, const std::string& label,
                    const Capture& capture);

/// The camera's value for a parameter in the parameter's unit; nullopt where it is not known. Throws
/// Error(ErrorKind::capture) for one outside the range of `spec`.
std::optional<ParamValue> camera_value(const ParamSpec& spec, const std::string& field,
                                       const std::string& label, const CaptureHeader& header);

}  // namespace aftershade
