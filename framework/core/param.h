// The declaration of one parameter, from which validation, --set, schema, docs and GLSL all come.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/core/document.h"
#include "framework/core/object_keys.h"
#include "framework/core/scattering_profile.h"

namespace aftershade {

enum class ParamType {
    float_,
    int_,
    bool_,
    enum_,
    angle,
    color,
    vec2,
    vec3,
    vec4,
    curve,
    file,
    table,
    objects,            ///< which objects: a list of ids, ranges of ids and names; empty for all
    scattering_profile  ///< how light scatters, by object
};

/// A function of one variable through points, x rising; constant before the first and after the last.
struct CurveValue {
    enum class Interpolation { linear, smooth };  ///< smooth: monotone cubic (Fritsch and Carlson 1980)
    std::vector<std::array<double, 2>> points;    ///< x in the curve's domain, y in the parameter's unit
    Interpolation interpolation = Interpolation::linear;
    /// There must be a point. A smooth curve never leaves the range of two neighbouring points' y.
    double at(double x) const;
    bool operator==(const CurveValue&) const = default;
};

/// Rows by object; an object that no row names has the default row.
struct TableValue {
    /// Per column, in the table's order, as numbers: the declared unit, 0 or 1, or the index of an enum's
    /// value; as many as the column's type has components.
    using Row = std::vector<std::vector<double>>;
    Row default_row;
    std::vector<std::pair<TableKey, Row>> rows;  ///< no id and no name twice
    bool operator==(const TableValue&) const = default;
};

/// Profiles by object; an object that no row names has the usual one.
struct ScatteringValue {
    ScatteringProfile usual;
    std::vector<std::pair<TableKey, ScatteringProfile>> rows;  ///< no id and no name twice
    bool operator==(const ScatteringValue&) const = default;
};
inline constexpr std::size_t kMaxScatteringRows = 1024;

/// The different profiles of a value, the usual one first.
std::vector<ScatteringProfile> scattering_profiles_of(const ScatteringValue& value);
/// Whether each of them is Burley's: shaders then compute it without tables.
bool is_burley(const ScatteringValue& value);
/// What shaders look up by object: rows of the type's columns (index among scattering_profiles_of(); d and
/// falloff, mm, own or fitted; direct; reach, mm).
TableValue scattering_table(const ScatteringValue& value);

/// float_ and angle hold a double, in the declared unit; color and vec2..4 hold that many doubles; enum_ a
/// string; file a path, "" for none; objects a table of one column, 1 for what is listed.
using ParamValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, CurveValue,
                                TableValue, ScatteringValue>;

/// What a file parameter names: a picture (EXR, PNG), or a colour table (.cube, Adobe Cube LUT 1.0).
enum class FileKind { image, lut };

/// "requires": ["> focal_length"]: how this value stands to another parameter's, units minded.
struct ParamRelation {
    enum class Order { less, less_equal, greater, greater_equal };
    Order order = Order::less;
    std::string other;  ///< a parameter of the same effect
    Place place;
};

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
    std::vector<ParamRelation> relations;
    FileKind file_kind = FileKind::image;  ///< file
    bool file_is_data = false;             ///< image, "space": "data": a PNG's numbers as they are stored
    std::array<double, 2> domain = {0.0, 1.0};  ///< curve: the range of x
    std::vector<ParamSpec> columns;  ///< table: each a scalar or vector with its own default; objects and
                                     ///< scattering_profile: what their type has
    Place place;
};

/// float_ ... vec4: a value that a uniform block holds and a table's column may have.
bool is_block_type(ParamType type);

/// Reaches shaders through a texture: curve and scattering_profile; a file where there is one.
bool is_param_texture(ParamType type);
/// Reaches shaders through a storage block, looked up by object: table, objects and scattering_profile.
bool is_param_buffer(ParamType type);

/// Components of a value of this type: 1 for scalars, 3 for color.
int component_count(ParamType type);
/// "float", "int", ...: as manifests spell them.
std::string_view param_type_name(ParamType type);

inline constexpr std::size_t kMaxCurvePoints = 64;

/// A value of a block type as numbers, which is what a cell of a table holds: one per component, in the
/// declared unit; a bool is 0 or 1, an enum the index of its name in `spec.values`.
std::vector<double> numbers_of(const ParamSpec& spec, const ParamValue& value);

/// Reads one entry of a manifest's "params". nullopt after a fault that leaves nothing usable. What
/// `requires` names is checked by check_relation_declarations, once all parameters are known.
std::optional<ParamSpec> parse_param_spec(const std::string& name, const Node& node,
                                          Diagnostics& diagnostics);

/// Reads a value for `spec`: a literal in the declared unit, or a string with a compatible unit. `label`
/// names the parameter in messages: "bokeh.f_number: 0.02 is below the minimum 0.05".
std::optional<ParamValue> parse_param_value(const ParamSpec& spec, const Node& node, const std::string& label,
                                            Diagnostics& diagnostics);

/// The value as a document would write it, without unit; one line. Of a table, a row's cells stand in the
/// order of its columns under "cells": the value does not know their names.
std::string format_value(const ParamValue& value);
/// The same with the columns' names, as a document would write a table too.
std::string format_value(const ParamSpec& spec, const ParamValue& value);
/// "0.05 to 1000", "at least 0", "" where nothing bounds it.
std::string range_text(const ParamSpec& spec);

/// The values of one effect instance, complete: every parameter of its manifest has one.
class ParamSet {
public:
    void set(const std::string& name, ParamValue value) { values_[name] = std::move(value); }
    const ParamValue& get(const std::string& name) const { return values_.at(name); }
    bool has(const std::string& name) const { return values_.contains(name); }

private:
    std::map<std::string, ParamValue> values_;
};

/// A relation of "requires" that two values do not hold. The pointers are into the specs that were checked.
struct RelationFault {
    const ParamSpec* spec = nullptr;
    const ParamSpec* other = nullptr;
    ParamRelation::Order order = ParamRelation::Order::less;
    double value = 0;        ///< in spec's unit
    double other_value = 0;  ///< in other's unit
};

/// Every relation of `specs` that `values`, which must have a value for each of them, does not hold. Values
/// are compared in one unit; two that are equal in either's unit are equal. Relations to parameters that are
/// not among `specs` hold.
std::vector<RelationFault> check_relations(std::span<const ParamSpec> specs, const ParamSet& values);
/// "bokeh.focus_distance: 0.04 m must be above focal_length, 50 mm"; `step` is "bokeh".
std::string relation_message(const std::string& step, const RelationFault& fault);
/// For a manifest: relations to parameters that do not exist, are no scalars or measure something else, and
/// defaults that do not hold.
void check_relation_declarations(std::span<const ParamSpec> specs, Diagnostics& diagnostics);

/// The value at `t` of the way from `a` (0) to `b` (1): linear for float, angle, vec and color; everything
/// else is `a` until t is 1.
ParamValue interpolate(const ParamSpec& spec, const ParamValue& a, const ParamValue& b, double t);

/// The value for images whose sides are `factor` of what it was chosen for: what is in px (the cells of such
/// columns and the y of such curves too) is multiplied. Ints are rounded, but not to below their `min`: a
/// tile of 0 px would have no meaning. Everything else is unchanged.
ParamValue scale_pixels(const ParamSpec& spec, const ParamValue& value, double factor);

}  // namespace aftershade
