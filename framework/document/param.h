// The declaration of one parameter, from which validation, --set, schema, docs and GLSL all come.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/document/object_keys.h"

namespace aftershade {

class AbstractParamType;

/// One of the types that a table lists (core_param_types()); framework/document/param_type.h has what a type
/// is. The named ones are those that code means by themselves. [value type]
class ParamType {
public:
    constexpr ParamType(const AbstractParamType& type) : type_(&type) {}
    const AbstractParamType* operator->() const { return type_; }
    const AbstractParamType& operator*() const { return *type_; }
    bool operator==(const ParamType&) const = default;

    static const ParamType float_, int_, bool_, enum_, angle, color, vec2, vec3, vec4, curve, file, table;
    static const ParamType objects;  ///< which objects: a list of ids, ranges of ids and names; empty for all
    static const ParamType text;     ///< a word for the host alone

private:
    const AbstractParamType* type_;
};

/// The types that need only core, in the order of messages and schemas. [thread-safe]
std::span<const ParamType> core_param_types();

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

/// The part of a value that only its type's own module defines. Immutable, since values share it.
/// [thread-safe]
class ValueContent {
public:
    virtual ~ValueContent() = default;
    /// `other` is of the same class.
    virtual bool equals(const ValueContent& other) const = 0;
    /// As a document would write it; one line.
    virtual std::string text() const = 0;
};

/// A value of a type that is declared above core. [value type]
class OpaqueValue {
public:
    /// There must be content.
    explicit OpaqueValue(std::shared_ptr<const ValueContent> content) : content_(std::move(content)) {}
    const ValueContent& content() const { return *content_; }
    bool operator==(const OpaqueValue& other) const;

private:
    std::shared_ptr<const ValueContent> content_;
};

/// float_ and angle hold a double, in the declared unit; color and vec2..4 hold that many doubles; enum_ a
/// string; text likewise; file a path, "" for none; objects a table of one column, 1 for what is listed.
using ParamValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, CurveValue,
                                TableValue, OpaqueValue>;

/// The file of a file parameter: a picture (EXR, PNG, JPEG), a colour table (.cube, Adobe Cube LUT 1.0), or
/// one that OpenColorIO reads: a config, for which "" is the user's own, or a transform.
enum class FileKind { image, lut, ocio_config, ocio_transform };

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
    std::vector<int> numbers;                       ///< enum_: stand for its values, too; or none
    ParamBind bind = ParamBind::uniform;
    std::string section;       ///< heading that it stands under, in words; "" for the first ones
    bool is_advanced = false;  ///< stands last, and folded on the page
    std::string from;          ///< "camera.focus_distance": the default where the capture has that value
    std::optional<ParamValue> identity;  ///< the value that leaves the image as it is
    std::vector<ParamRelation> relations;
    FileKind file_kind = FileKind::image;  ///< file
    bool warn_if_empty = false;   ///< objects: an empty list, which means all of them, is likely a slip
    std::string per_metre;        ///< scattering_profile: the parameter that has its mm for each metre
    std::string ocio;             ///< text, bool: the part of the effect's OpenColorIO transform that it says
    bool file_is_data = false;    ///< image, "space": "data": a PNG's numbers as they are stored
    bool file_is_linear = false;  ///< image, "filter": "linear": read between its texels
    std::array<double, 2> domain = {0.0, 1.0};  ///< curve: the range of x
    std::vector<ParamSpec> columns;  ///< table: each a scalar or vector with its own default; of another type
                                     ///< that shaders look up by object: what the type has
    Place place;
};

/// A value that a uniform block holds and a table's column may have: numbers, bools and enums.
bool is_block_type(ParamType type);
/// One number: has an order, and a number of the capture may fill it.
bool is_scalar_type(ParamType type);
/// Names a file, which the host reads.
bool is_file_type(ParamType type);
/// A file from which OpenColorIO makes a transform, with the effect's parameters that have an `ocio`.
bool is_ocio_file(const ParamSpec& spec);
/// Reaches shaders through a texture for any value; a file parameter only if it has a file.
bool is_param_texture(ParamType type);
/// Reaches shaders through a storage block, looked up by object.
bool is_param_buffer(ParamType type);

/// Components of a value of this type: 1 for scalars, 3 for color.
int component_count(ParamType type);
/// "float", "int", ...: as manifests spell them.
std::string_view param_type_name(ParamType type);

inline constexpr std::size_t kMaxCurvePoints = 64;

/// A value of a block type as numbers, which is what a cell of a table holds: one per component, in the
/// declared unit; a bool is 0 or 1, an enum the index of its name in `spec.values`.
std::vector<double> numbers_of(const ParamSpec& spec, const ParamValue& value);
/// The way back, from as many numbers as the type has components. An int is rounded.
ParamValue value_of_numbers(const ParamSpec& spec, const std::vector<double>& numbers);

/// One value to try: "at its min, 0.5", "hexagon".
struct SweepValue {
    std::string how;
    ParamValue value;
};
/// Every value of a bool or an enum; the limits of numbers, in each component. None of other types.
std::vector<SweepValue> sweep_values(const ParamSpec& spec);

/// Reads one entry of a manifest's "params", which is of one of `types`; check() has found it sound by
/// param_block() (param_grammar.h). nullopt after a fault that leaves nothing usable.
/// check_relation_declarations checks the names in `requires`, once all parameters are known.
std::optional<ParamSpec> read_param_spec(const std::string& name, const Node& node, Diagnostics& diagnostics,
                                         std::span<const ParamType> types);

/// Reads a value for `spec`: a literal in the declared unit, or a string with a compatible unit. `label`
/// names the parameter in messages: "bokeh.f_number: 0.02 is below the minimum 0.05".
std::optional<ParamValue> parse_param_value(const ParamSpec& spec, const Node& node, const std::string& label,
                                            Diagnostics& diagnostics);

/// The value as a document would write it, without unit; one line. A row of a table has its cells in the
/// order of its columns under "cells", because the value does not hold their names.
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
    bool operator==(const ParamSet&) const = default;

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
/// For a manifest: relations to parameters that do not exist, are not scalars or measure something else, and
/// defaults that do not hold.
void check_relation_declarations(std::span<const ParamSpec> specs, Diagnostics& diagnostics);

/// The value at `t` of the way from `a` (0) to `b` (1): linear for what is continuous (float, angle, vec,
/// color); everything else is `a` until t is 1.
ParamValue interpolate(const ParamSpec& spec, const ParamValue& a, const ParamValue& b, double t);

/// The value for images whose sides are `factor` of what it was chosen for: what is in px (the cells of such
/// columns and the y of such curves too) is multiplied. Ints are rounded, but not to below their `min`: a
/// tile of 0 px would have no meaning. Everything else is unchanged.
ParamValue scale_pixels(const ParamSpec& spec, const ParamValue& value, double factor);

}  // namespace aftershade
