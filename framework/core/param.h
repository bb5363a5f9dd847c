// The declaration of one parameter, from which validation, --set, schema, docs and GLSL all come.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/core/document.h"

namespace aftershade {

enum class ParamType { float_, int_, bool_, enum_, angle, color, vec2, vec3, vec4 };

/// float_ and angle hold a double, in the declared unit; color and vec2..4 hold that many doubles; enum_ a
/// string.
using ParamValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

/// How a value reaches GLSL: as a member of the block `param`, or as a preprocessor define, which makes one
/// program for every value that is used.
enum class ParamBind { uniform, define };

struct ParamSpec {
    std::string name;
    ParamType type = ParamType::float_;
    std::string unit;  ///< "" for a pure number; the unit that GLSL receives
    std::string doc;   ///< one sentence
    ParamValue default_value = 0.0;
    std::optional<double> min;  ///< of each component, in `unit`
    std::optional<double> max;
    std::optional<std::array<double, 2>> ui_range;  ///< a slider's ends, within min and max
    std::vector<std::string> values;                ///< enum_
    ParamBind bind = ParamBind::uniform;
    std::string from;  ///< "camera.focus_distance": the default where the capture has that value
    std::optional<ParamValue> identity;  ///< the value that leaves the image as it is
    Place place;
};

/// Components of a value of this type: 1 for scalars, 3 for color.
int component_count(ParamType type);
/// "float", "int", ...: as manifests spell them.
std::string_view param_type_name(ParamType type);

/// Reads one entry of a manifest's "params". nullopt after a fault that leaves nothing usable.
std::optional<ParamSpec> parse_param_spec(const std::string& name, const Node& node,
                                          Diagnostics& diagnostics);

/// Reads a value for `spec`: a literal in the declared unit, or a string with a compatible unit. `label`
/// names the parameter in messages: "bokeh.f_number: 0.02 is below the minimum 0.05".
std::optional<ParamValue> parse_param_value(const ParamSpec& spec, const Node& node, const std::string& label,
                                            Diagnostics& diagnostics);

/// The value as a document would write it, without unit.
std::string format_value(const ParamValue& value);

/// The values of one effect instance, complete: every parameter of its manifest has one.
class ParamSet {
public:
    void set(const std::string& name, ParamValue value) { values_[name] = std::move(value); }
    const ParamValue& get(const std::string& name) const { return values_.at(name); }
    bool has(const std::string& name) const { return values_.contains(name); }

private:
    std::map<std::string, ParamValue> values_;
};

}  // namespace aftershade
