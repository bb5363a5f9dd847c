// A list of objects: shaders ask whether an object is in it. Its value is a table of one column.
#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/table_keys.h"

namespace aftershade {

namespace objects_type {

class ObjectsTable final : public AbstractParamTable {
public:
    TableValue rows(const ParamValue& value) const override { return std::get<TableValue>(value); }

    std::string_view lookup() const override { return "_row"; }

    std::string glsl(const ParamSpec& spec) const override {
        return "bool " + spec.name + "(uint object_id) { return " + spec.name + "_row(object_id).listed; }\n";
    }
};

constexpr ObjectsTable kTable;

class ObjectsType final : public AbstractParamType {
public:
    constexpr ObjectsType()
        : AbstractParamType({.name = "objects",
                             .phrase = "a list of objects",
                             .home = ParamHome::resource,
                             .table = &kTable}) {}

    void declare(grammar::Block& declaration, const grammar::Block&) const override {
        declaration.keys.push_back(
            grammar::optional("warn_if_empty", grammar::boolean(),
                              "Warn where the list is empty, the step has no mask and frames have several "
                              "objects.",
                              "false"));
    }

    void read_declaration(const SpecReader& reader, ParamSpec& spec) const override {
        const Node* const warn = reader.node.find("warn_if_empty");
        spec.warn_if_empty = warn && warn->boolean;
        ParamSpec listed;
        listed.name = "listed";
        listed.type = ParamType::bool_;
        listed.default_value = false;
        spec.columns = {listed};
    }

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        if (!node.is_array())
            return reader.wrong_kind(node, "an array of objects' ids, ranges such as \"3-7\" and names");
        const int errors_before = reader.diagnostics.error_count();
        TableKeyReader keys(reader.diagnostics);
        TableValue objects;
        objects.default_row = {{node.items.empty() ? 1.0 : 0.0}};
        for (std::size_t i = 0; i < node.items.size(); ++i)
            for (const TableKey& key :
                 keys.read_item(node.items[i], reader.label + "[" + std::to_string(i) + "]"))
                objects.rows.push_back({key, {{1.0}}});
        keys.check_overlaps();
        if (reader.diagnostics.error_count() > errors_before) return std::nullopt;
        return objects;
    }

    schema::json literal_schema(const ParamSpec&, const schema::LiteralParts& parts) const override {
        return schema::array_of(parts.part(schema::object_key()));
    }

    std::string format(const ParamSpec&, const ParamValue& value) const override {
        std::string items;
        for (const auto& [key, row] : std::get<TableValue>(value).rows)
            items += (items.empty() ? "" : ", ") + format_object_keys({&key, 1});
        return "[" + items + "]";
    }
};

constexpr ObjectsType kType;

}  // namespace objects_type

constinit const ParamType ParamType::objects{objects_type::kType};

}  // namespace aftershade
