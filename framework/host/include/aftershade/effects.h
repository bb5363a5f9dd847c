// Effects and their parameters as data: what `aftershade list` and `aftershade describe` print.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace aftershade::host {

/// A value as a document writes it, for types without a simpler form: curves, tables, scattering profiles,
/// values by keys ({"keys": {"1": 2.0, "24": 5.6}}) or of the capture ({"from": "camera.f_number"}).
struct Json {
    std::string text;
    bool operator==(const Json&) const = default;
};

/// bool; int; float and angle in the parameter's unit; enum, path of a file, or a number with a unit ("2 m",
/// "50 mm"); color and vectors; and the rest.
using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, Json>;

/// One parameter, as its effect declares it.
struct ParamInfo {
    std::string name;                    ///< snake_case, unique in its effect
    std::string type;                    ///< float, int, bool, enum, angle, color, vec2, curve, ...
    std::string unit;                    ///< of min, max, default and values; "": a pure number
    std::string doc;                     ///< one sentence
    std::optional<Value> default_value;  ///< empty where the type has none
    std::optional<double> min, max;      ///< inclusive, of each component; empty: not bounded
    /// Ends of a slider, within min and max; empty: none is suggested.
    std::optional<std::array<double, 2>> ui_range;
    std::vector<std::string> values;  ///< of an enum
    std::string from;  ///< the default where the capture has it: "camera.focus_distance"; "": none
    std::optional<Value> identity;   ///< that leaves the image as it is; empty: none is declared
    std::vector<ParamInfo> columns;  ///< of a table
};

struct InputInfo {
    std::string name;
    std::string role;
    std::string doc;
    bool optional = false;
    bool history = false;  ///< the frame before is read too
    int frame = 0;         ///< -1 and 1: of the capture before and after
};

struct OutputInfo {
    std::string name;
    std::string role;
    std::string doc;
};

struct PresetValue {
    std::string param;
    Value value;
};

struct PresetInfo {
    std::string name;
    std::vector<PresetValue> values;
};

struct EffectInfo {
    std::string id;
    std::string version;
    std::string summary;  ///< one line
    std::string folder;   ///< path
    std::vector<InputInfo> inputs;
    std::vector<OutputInfo> outputs;
    std::vector<ParamInfo> params;
    std::vector<std::string> textures;  ///< by name; with `outputs`, what LookOptions::taps may name
    std::vector<PresetInfo> presets;
    std::vector<std::string> sources;  ///< papers
    bool has_history = false;          ///< a frame depends on those before it
    bool has_native_code = false;      ///< needs the plug-in that offers it
    int warmup_frames = 0;             ///< rendered before the first frame that counts
};

}  // namespace aftershade::host
