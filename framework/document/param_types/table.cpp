// Rows by object, of columns that the declaration names.
#include <utility>

#include "framework/base/text.h"
#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/table_keys.h"

namespace aftershade {

namespace table_type {

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

bool is_column(const std::string& name) {
    return is_snake_case(name) && !TableKeyReader::is_key(name);
}

void scale_row(const ParamSpec& table, TableValue::Row& row, double factor) {
    for (std::size_t i = 0; i < row.size(); ++i)
        if (table.columns[i].unit == "px")
            for (double& number : row[i]) number = scaled_px(table.columns[i], number, factor);
}

class RowsAsTheyAre final : public AbstractParamTable {
public:
    TableValue rows(const ParamValue& value) const override { return std::get<TableValue>(value); }
};

constexpr RowsAsTheyAre kTable;

class TableType final : public AbstractParamType {
public:
    constexpr TableType()
        : AbstractParamType({.name = "table",
                             .home = ParamHome::resource,
                             .has_default = false,
                             .has_columns = true,
                             .table = &kTable}) {}

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        return TableReader(reader).read(node);
    }

    void declare(grammar::Block& declaration, const grammar::Block& column) const override {
        declaration.keys.push_back(grammar::required(
            "columns",
            grammar::map(
                grammar::object(column),
                {.pattern = {"^(?!(object|objects|name)$)[a-z][a-z0-9_]*$", is_column},
                 .fault =
                     std::string("column '{}' ") + kMustBeSnakeCase +
                     ", and not 'object', 'objects' or 'name', by which a row says for which object it is",
                 .min = 1,
                 .count_fault = "a table has at least one column"}),
            "Columns, declared like parameters of the block types."));
    }

    void read_declaration(const SpecReader& reader, ParamSpec& spec) const override {
        for (const Member& member : reader.node.find("columns")->members)
            if (auto column = read_spec(member.key, spec.name + ".columns." + member.key, SpecOwner::table,
                                        member.value, reader.diagnostics, reader.types))
                spec.columns.push_back(std::move(*column));
    }

    schema::json literal_schema(const ParamSpec& spec, const schema::LiteralParts& parts) const override {
        // A declaration's columns are not known where the schema is of every declaration.
        if (spec.columns.empty()) {
            const schema::json row = {{"type", "object"}};
            schema::json keyed = row;
            keyed["oneOf"] = schema::LiteralParts::one_key();
            return schema::object({{"default", row}, {"rows", schema::array_of(keyed)}});
        }
        schema::json cells = schema::json::object();
        for (const ParamSpec& column : spec.columns) {
            cells[column.name] = parts.literal(column);
            cells[column.name]["description"] = column.doc;
        }
        return schema::object({{"default", parts.part(schema::object(cells))},
                               {"rows", parts.part(schema::array_of(parts.part(parts.keyed_row(cells))))}});
    }

    std::string format(const ParamSpec& spec, const ParamValue& value) const override {
        return format_table(std::get<TableValue>(value), &spec.columns);
    }

    std::string type_text(const ParamSpec&) const override { return "table by object"; }

    std::string default_text(const ParamSpec&) const override { return "its columns'"; }

    ParamValue scale(const ParamSpec& spec, const ParamValue& value, double factor) const override {
        TableValue scaled = std::get<TableValue>(value);
        scale_row(spec, scaled.default_row, factor);
        for (auto& [key, row] : scaled.rows) scale_row(spec, row, factor);
        return scaled;
    }
};

constexpr TableType kType;

}  // namespace table_type

constinit const ParamType ParamType::table{table_type::kType};

}  // namespace aftershade
