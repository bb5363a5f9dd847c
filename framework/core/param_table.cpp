#include <utility>

#include "framework/core/param_internal.h"
#include "framework/core/text.h"

namespace aftershade {

namespace {

/// Reads one table.
class TableReader {
public:
    explicit TableReader(const ValueReader& value) : value_(value), diagnostics_(value.diagnostics) {}

    std::optional<ParamValue> read(const Node& node) {
        if (!node.is_object()) return value_.wrong_kind(node, "an object with 'default' and 'rows'");
        const int errors_before = diagnostics_.error_count();
        for (const ParamSpec& column : value_.spec.columns)
            table_.default_row.push_back(numbers_of(column, column.default_value));
        ObjectReader reader(node, value_.label, diagnostics_);
        if (const Node* row = reader.object("default")) {
            const std::string label = value_.label + ".default";
            ObjectReader row_reader(*row, label, diagnostics_);
            table_.default_row = cells(row_reader, *row, label);
            row_reader.finish();
        }
        if (const Node* rows = reader.array("rows"))
            for (std::size_t i = 0; i < rows->items.size(); ++i)
                read_row(rows->items[i], value_.label + ".rows[" + std::to_string(i) + "]");
        reader.finish();
        keys_.check_overlaps();
        if (diagnostics_.error_count() > errors_before) return std::nullopt;
        return std::move(table_);
    }

private:
    /// The default row with the cells that `node` gives.
    TableValue::Row cells(ObjectReader& reader, const Node& node, const std::string& label) {
        TableValue::Row row = table_.default_row;
        for (std::size_t i = 0; i < value_.spec.columns.size(); ++i) {
            const ParamSpec& column = value_.spec.columns[i];
            reader.any(column.name);
            const Node* cell = node.find(column.name);
            if (!cell) continue;
            const auto value = parse_param_value(column, *cell, label + "." + column.name, diagnostics_);
            if (value) row[i] = numbers_of(column, *value);
        }
        return row;
    }

    void read_row(const Node& node, const std::string& label) {
        ObjectReader reader(node, label, diagnostics_);
        if (!reader.is_object()) return;
        const TableValue::Row row = cells(reader, node, label);
        const std::vector<TableKey> keys = keys_.read_row(reader, node, label);
        reader.finish();
        for (const TableKey& key : keys) table_.rows.emplace_back(key, row);
    }

    const ValueReader& value_;
    Diagnostics& diagnostics_;
    TableKeyReader keys_{diagnostics_};
    TableValue table_;
};

}  // namespace

std::optional<ParamValue> ValueReader::table(const Node& node) const {
    return TableReader(*this).read(node);
}

std::optional<ParamValue> ValueReader::objects(const Node& node) const {
    if (!node.is_array())
        return wrong_kind(node, "an array of objects' ids, ranges such as \"3-7\" and names");
    const int errors_before = diagnostics.error_count();
    TableKeyReader keys(diagnostics);
    TableValue table;
    table.default_row = {{node.items.empty() ? 1.0 : 0.0}};
    for (std::size_t i = 0; i < node.items.size(); ++i)
        for (const TableKey& key : keys.read_item(node.items[i], label + "[" + std::to_string(i) + "]"))
            table.rows.push_back({key, {{1.0}}});
    keys.check_overlaps();
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return table;
}

void read_columns(const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    if (node.members.empty())
        diagnostics.error(node.place, "table parameter '" + spec.name + "' has no columns");
    for (const Member& member : node.members) {
        const std::string thing = "column '" + member.key + "' of parameter '" + spec.name + "'";
        if (!is_snake_case(member.key)) diagnostics.error(member.key_place, thing + " " + kMustBeSnakeCase);
        if (TableKeyReader::is_key(member.key))
            diagnostics.error(member.key_place, thing + ": a row says by this key which object it is for");
        auto column = parse_spec(member.key, thing, spec.name + ".columns." + member.key, SpecOwner::table,
                                 member.value, diagnostics);
        if (column) spec.columns.push_back(std::move(*column));
    }
}

}  // namespace aftershade
