// The type of a parameter: one class has everything that differs between types. A new type is a file like
// those of framework/document/param_types and a name in the list of core_param_types(). A type that needs
// more than `document` has its name in framework/effect/param_types.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/document/param.h"

namespace aftershade {

namespace grammar {
struct Block;
}
namespace schema {
class LiteralParts;
}

/// One value being read; collects what a message needs.
struct ValueReader {
    const ParamSpec& spec;
    const std::string label;  // "bokeh.f_number"
    Diagnostics& diagnostics;

    std::nullopt_t fault(const Node& node, const std::string& text) const;
    std::nullopt_t wrong_kind(const Node& node, std::string_view expected) const;
    /// A number in the spec's unit and within its range.
    std::optional<double> scalar(const Node& node) const;

private:
    std::optional<double> in_range(const Node& node, double value) const;
};

/// A declaration being read, which its grammar (param_grammar.h) has found sound.
struct SpecReader {
    const Node& node;
    const std::string& label;          ///< "taps"
    std::span<const ParamType> types;  ///< that columns may have
    Diagnostics& diagnostics;
};

/// How a value reaches shaders.
enum class ParamHome {
    block,     ///< as a member of the block `param`, or as a define; as a table's cell
    resource,  ///< through a texture, a storage block or both
    file,      ///< the host makes a texture of the file that the value names
    host       ///< not at all: the host reads it
};

struct TexelSize {
    int width = 0;
    int height = 0;
    int channels = 1;  ///< 1 or 4, each a 32-bit float
};

/// The texture of a resource, which texelFetch alone reads.
class AbstractParamTexture {
public:
    virtual std::string_view label() const { return ""; }  ///< after the parameter's name, in the frame graph
    virtual TexelSize size(const ParamValue& value) const = 0;
    /// Rows from the top, channels interleaved.
    virtual std::vector<float> texels(const ParamSpec& spec, const ParamValue& value) const = 0;
    /// Declares the sampler, and what reads it without the table.
    virtual std::string glsl(const ParamSpec& spec, int binding) const = 0;

protected:
    ~AbstractParamTexture() = default;
};

/// The storage block of a resource, looked up by object. Its rows have `columns` of the spec.
class AbstractParamTable {
public:
    virtual TableValue rows(const ParamValue& value) const = 0;
    virtual std::size_t entries(const ParamValue& value) const;  ///< count_entries() of its rows
    /// After the parameter's name: the function that returns an object's row.
    virtual std::string_view lookup() const { return ""; }
    virtual std::string glsl(const ParamSpec&) const { return ""; }  ///< what follows that function

protected:
    ~AbstractParamTable() = default;
};

struct ParamTypeTraits {
    std::string_view name{};    ///< as manifests spell it
    std::string_view phrase{};  ///< in messages; "": the name with its article
    ParamHome home = ParamHome::block;
    int components = 1;            ///< block
    std::string_view glsl_type{};  ///< block
    bool is_integer = false;       ///< block: shaders have integers, or a bool of 32 bits
    bool has_range = false;        ///< unit, min, max and a slider's ends, of each number
    bool is_scalar = false;        ///< one number
    bool is_continuous = false;    ///< block: between two keys lie the values between theirs
    bool is_choice = false;        ///< one of the spec's `values`
    bool has_default = true;       ///< declarations must give one; else an empty object is read
    bool has_columns = false;      ///< declarations name the columns
    std::string_view usual_unit{};
    const AbstractParamTexture* texture = nullptr;  ///< resource; nullptr: none
    const AbstractParamTable* table = nullptr;      ///< resource; nullptr: none
    bool has_defines = false;                       ///< resource: defines() of a value
};

/// A type. There is one object of each, a constant. [thread-safe]
class AbstractParamType : public ParamTypeTraits {
public:
    constexpr explicit AbstractParamType(const ParamTypeTraits& traits) : ParamTypeTraits(traits) {}

    /// Adds the keys that only declarations of this type have, and rules; `column` declares a table's column.
    virtual void declare(grammar::Block&, const grammar::Block& column) const;
    /// Reads the type's own keys, or sets what follows from the type.
    virtual void read_declaration(const SpecReader&, ParamSpec&) const {}
    /// Whether a manifest's default may be that; reports what is wrong.
    virtual bool check_default(const ParamSpec&, const Node&, const std::string& label, Diagnostics&) const;
    virtual std::optional<ParamValue> parse(const ValueReader&, const Node&) const = 0;
    virtual nlohmann::ordered_json literal_schema(const ParamSpec&, const schema::LiteralParts&) const = 0;

    /// As a document would write it.
    virtual std::string format(const ParamSpec&, const ParamValue&) const;
    /// For people, without unit.
    virtual std::string type_text(const ParamSpec&) const;
    virtual std::string default_text(const ParamSpec&) const;
    /// The type's own keys for `describe --json`.
    virtual nlohmann::ordered_json describe(const ParamSpec&) const;

    /// block: numbers_of() and value_of_numbers(), which must be there; sweep_values(), without it the
    /// limits.
    virtual std::vector<double> numbers(const ParamSpec&, const ParamValue&) const;
    virtual ParamValue of_numbers(const ParamSpec&, const std::vector<double>& numbers) const;
    virtual std::vector<SweepValue> sweep(const ParamSpec&) const;

    /// scale_pixels(); without it numbers in px are scaled.
    virtual ParamValue scale(const ParamSpec&, const ParamValue&, double factor) const;
    /// resource: preprocessor lines that depend on the value. Each form is one program.
    virtual std::string defines(const ParamSpec&, const ParamValue&) const { return ""; }
    /// How far light goes that moves as the value says, mm; 0: it says nothing of that.
    virtual double length_mm(const ParamValue&) const { return 0; }
    /// The content that the value takes from files that documents name.
    virtual std::string content(const ParamValue&) const { return ""; }

protected:
    ~AbstractParamType() = default;
};

/// "40 mm", or "40" where the unit is "".
std::string with_unit(double value, const std::string& unit);
/// "[1, 0.5]"
std::string format_numbers(const std::vector<double>& numbers);
/// A table's text; without columns a row's cells stand in an array.
std::string format_table(const TableValue& table, const std::vector<ParamSpec>* columns);
/// `number` of a spec in px, for images whose sides are `factor` of what it was chosen for.
double scaled_px(const ParamSpec& spec, double number, double factor);

/// read_param_spec() for what messages call `label` ("taps"); of a manifest's parameter, or of a table's
/// column.
enum class SpecOwner { manifest, table };
std::optional<ParamSpec> read_spec(const std::string& name, const std::string& label, SpecOwner owner,
                                   const Node& node, Diagnostics& diagnostics,
                                   std::span<const ParamType> types);

}  // namespace aftershade
