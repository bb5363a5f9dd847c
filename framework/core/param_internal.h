// Shared by the sources that read parameters. Internal to framework/core.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/core/param.h"
#include "framework/core/units.h"

namespace aftershade {

/// One value being read; collects what a message needs.
struct ValueReader {
    const ParamSpec& spec;
    const std::string label;  // "bokeh.f_number"
    Diagnostics& diagnostics;

    std::nullopt_t fault(const Node& node, const std::string& text) const;
    std::nullopt_t wrong_kind(const Node& node, std::string_view expected) const;
    /// A number in the spec's unit and within its range.
    std::optional<double> scalar(const Node& node) const;
    std::optional<ParamValue> vector(const Node& node) const;
    std::optional<ParamValue> integer(const Node& node) const;
    std::optional<ParamValue> enumerator(const Node& node) const;
    std::optional<ParamValue> curve(const Node& node) const;
    std::optional<ParamValue> file(const Node& node) const;
    std::optional<ParamValue> table(const Node& node) const;
    std::optional<ParamValue> objects(const Node& node) const;
    std::optional<ParamValue> scattering(const Node& node) const;

private:
    std::optional<double> in_range(const Node& node, double value) const;
};

/// "40 mm", or "40" where the unit is "".
std::string with_unit(double value, const std::string& unit);

/// Reads which objects rows and lists are for, and finds those that are named twice.
class TableKeyReader {
public:
    explicit TableKeyReader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    static bool is_key(std::string_view word);
    /// Of a row: one of 'object', 'objects' and 'name'. `label` is the row's.
    std::vector<TableKey> read_row(ObjectReader& reader, const Node& node, const std::string& label);
    /// Of a list: 3, "3-7,9" or "Wheel".
    std::vector<TableKey> read_item(const Node& node, const std::string& label);
    /// Reports what more than one of those read is for. Call once, last.
    void check_overlaps();

private:
    struct Found {
        TableKey key;
        std::string label;
        Place place;
    };

    std::vector<TableKey> kept(std::vector<TableKey> keys, const Node& node, const std::string& label);
    std::vector<TableKey> row_keys(ObjectReader& reader, const Node& node, const std::string& label);
    void report_overlap(std::size_t later, std::size_t earlier);

    Diagnostics& diagnostics_;
    std::vector<Found> found_;
};

/// The declaration of a table's columns, into spec.columns.
void read_columns(const Node& node, ParamSpec& spec, Diagnostics& diagnostics);

/// The columns that shaders have of a scattering_profile.
std::vector<ParamSpec> scattering_columns();

/// parse_param_spec for what messages call `thing` ("parameter 'taps'") and `label` ("taps"). A column is of
/// a block type, a uniform, and has no relation to anything else.
enum class SpecOwner { manifest, table };
std::optional<ParamSpec> parse_spec(const std::string& name, const std::string& thing,
                                    const std::string& label, SpecOwner owner, const Node& node,
                                    Diagnostics& diagnostics);

}  // namespace aftershade
