// A list of objects: shaders ask whether an object is in it. Its value is a table of one column.
#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/table_keys.h"

namespace aftershade {

namespace objects_type {

void declare(grammar::Block& declaration, const grammar::Block&) {
    declaration.keys.push_back(
        grammar::optional("warn_if_empty", grammar::boolean(),
                          "Warn where the list is empty, the step has no mask and frames have several "
                          "objects.",
                          "false"));
}

void read_declaration(const SpecReader& reader, ParamSpec& spec) {
    const Node* const warn = reader.node.find("warn_if_empty");
    spec.warn_if_empty = warn && warn->boolean;
    ParamSpec listed;
    listed.name = "listed";
    listed.type = ParamType::bool_;
    listed.default_value = false;
    spec.columns = {listed};
}

std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) {
    if (!node.is_array())
        return reader.wrong_kind(node, "an array of objects' ids, ranges such as \"3-7\" and names");
    const int errors_before = reader.diagnostics.error_count();
    TableKeyReader keys(reader.diagnostics);
    TableValue table;
    table.default_row = {{node.items.empty() ? 1.0 : 0.0}};
    for (std::size_t i = 0; i < node.items.size(); ++i)
        for (const TableKey& key :
             keys.read_item(node.items[i], reader.label + "[" + std::to_string(i) + "]"))
            table.rows.push_back({key, {{1.0}}});
    keys.check_overlaps();
    if (reader.diagnostics.error_count() > errors_before) return std::nullopt;
    return table;
}

schema::json literal(const ParamSpec&, const schema::LiteralParts& parts) {
    return schema::array_of(parts.part(schema::object_key()));
}

std::string format(const ParamSpec&, const ParamValue& value) {
    std::string items;
    for (const auto& [key, row] : std::get<TableValue>(value).rows)
        items += (items.empty() ? "" : ", ") + format_object_keys({&key, 1});
    return "[" + items + "]";
}

std::size_t entries(const ParamValue& value) {
    return count_entries(std::get<TableValue>(value).rows);
}

TableValue rows(const ParamValue& value) {
    return std::get<TableValue>(value);
}

std::string glsl(const ParamSpec& spec) {
    return "bool " + spec.name + "(uint object_id) { return " + spec.name + "_row(object_id).listed; }\n";
}

constexpr ParamTypeTraits type() {
    ParamTypeTraits traits;
    traits.name = "objects";
    traits.phrase = "a list of objects";
    traits.home = ParamHome::resource;
    traits.declare = declare;
    traits.read_declaration = read_declaration;
    traits.parse = parse;
    traits.schema = literal;
    traits.format = format;
    traits.table = {entries, rows, "_row", glsl};
    return traits;
}

}  // namespace objects_type

constinit const ParamTypeTraits kObjectsParam = objects_type::type();

}  // namespace aftershade
