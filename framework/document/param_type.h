// The type of a parameter: one table entry has everything that differs between types. A new type is a file
// like those of framework/document/param_types and a line in the list of core_param_types(). A type that
// needs more than core has its line in framework/effect/param_types.cpp.
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

/// Traits of a resource's texture, which texelFetch alone reads.
struct ParamTextureTraits {
    std::string_view label;  ///< after the parameter's name, in the frame graph
    TexelSize (*size)(const ParamValue& value) = nullptr;
    /// Rows from the top, channels interleaved.
    std::vector<float> (*texels)(const ParamSpec& spec, const ParamValue& value) = nullptr;
    /// Declares the sampler, and what reads it without the table.
    std::string (*glsl)(const ParamSpec& spec, int binding) = nullptr;
};

/// Traits of a resource's storage block, looked up by object. Its rows have `columns` of the spec.
struct ParamTableTraits {
    std::size_t (*entries)(const ParamValue& value) = nullptr;  ///< count_entries() of its rows
    TableValue (*rows)(const ParamValue& value) = nullptr;
    std::string_view lookup;  ///< after the parameter's name: the function that returns an object's row
    std::string (*glsl)(const ParamSpec& spec) = nullptr;  ///< what follows that function; may be null
};

/// Functions that are null have the behaviour that their comment names.
struct ParamTypeTraits {
    std::string_view name;    ///< as manifests spell it
    std::string_view phrase;  ///< in messages; "": the name with its article
    ParamHome home = ParamHome::block;
    int components = 1;          ///< block
    std::string_view glsl_type;  ///< block
    bool is_integer = false;     ///< block: shaders have integers, or a bool of 32 bits
    bool has_range = false;      ///< unit, min, max and a slider's ends, of each number
    bool is_scalar = false;      ///< one number
    bool is_continuous = false;  ///< block: between two keys lie the values between theirs
    bool is_choice = false;      ///< one of the spec's `values`
    bool has_default = true;     ///< declarations must give one; else an empty object is read
    bool has_columns = false;    ///< declarations name the columns
    std::string_view usual_unit;

    /// Adds the keys that only declarations of this type have, and rules; `column` declares a table's column.
    /// Null: none.
    void (*declare)(grammar::Block& declaration, const grammar::Block& column) = nullptr;
    /// Reads the type's own keys, or sets what follows from the type; null: nothing.
    void (*read_declaration)(const SpecReader& reader, ParamSpec& spec) = nullptr;
    /// Whether a manifest's default may be that; reports what is wrong. Null: any value.
    bool (*check_default)(const ParamSpec& spec, const Node& node, const std::string& label,
                          Diagnostics& diagnostics) = nullptr;
    std::optional<ParamValue> (*parse)(const ValueReader& reader, const Node& node) = nullptr;
    nlohmann::ordered_json (*schema)(const ParamSpec& spec, const schema::LiteralParts& parts) = nullptr;

    /// As a document would write it; null: as format_value() without a spec.
    std::string (*format)(const ParamSpec& spec, const ParamValue& value) = nullptr;
    /// For people, without unit; null: the name.
    std::string (*type_text)(const ParamSpec& spec) = nullptr;
    /// For people, without unit; null: as `format`.
    std::string (*default_text)(const ParamSpec& spec) = nullptr;
    /// The type's own keys for `describe --json`; null: none.
    nlohmann::ordered_json (*describe)(const ParamSpec& spec) = nullptr;

    // block: must be there
    std::vector<double> (*numbers)(const ParamSpec& spec, const ParamValue& value) = nullptr;
    ParamValue (*of_numbers)(const ParamSpec& spec, const std::vector<double>& numbers) = nullptr;
    /// block; null: the limits.
    std::vector<SweepValue> (*sweep)(const ParamSpec& spec) = nullptr;

    /// resource; null: the value stays. See scale_pixels().
    ParamValue (*scale)(const ParamSpec& spec, const ParamValue& value, double factor) = nullptr;
    ParamTextureTraits texture;
    ParamTableTraits table;
    /// resource: preprocessor lines that depend on the value; null: none. Each form is one program.
    std::string (*defines)(const ParamSpec& spec, const ParamValue& value) = nullptr;
    /// How far light goes that moves as the value says, mm; null: it says nothing of that.
    double (*length_mm)(const ParamValue& value) = nullptr;
    /// The content that the value takes from files that documents name; null: none.
    std::string (*content)(const ParamValue& value) = nullptr;
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
