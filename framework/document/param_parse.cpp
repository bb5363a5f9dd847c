#include <algorithm>
#include <utility>

#include "framework/document/grammar_form.h"
#include "framework/document/param.h"
#include "framework/document/param_grammar.h"
#include "framework/document/param_type.h"

namespace aftershade {

namespace {

std::string text_of(const Node& node, const char* key, std::string_view otherwise = "") {
    const Node* value = node.find(key);
    return value ? value->string : std::string(otherwise);
}

std::optional<double> number_of(const Node& node, const char* key) {
    const Node* value = node.find(key);
    return value ? std::optional(value->number) : std::nullopt;
}

void read_range(const SpecReader& reader, ParamSpec& spec) {
    spec.unit = text_of(reader.node, "unit", spec.type->usual_unit);
    spec.min = number_of(reader.node, "min");
    spec.max = number_of(reader.node, "max");
    if (const Node* ui = reader.node.find("ui")) {
        spec.ui_range = {ui->items[0].number, ui->items[1].number};
        const auto& [low, high] = *spec.ui_range;
        if (low >= high || (spec.min && low < *spec.min) || (spec.max && high > *spec.max))
            reader.diagnostics.error(ui->place, "'ui' must rise and stay within 'min' and 'max'");
    }
    if (spec.min && spec.max && *spec.min > *spec.max)
        reader.diagnostics.error(reader.node.place, reader.label + ": 'min' is above 'max'");
}

/// What only a parameter of a manifest has, not a column of a table.
void read_manifest_keys(const Node& node, ParamSpec& spec) {
    spec.from = text_of(node, "from");
    spec.section = text_of(node, "section");
    if (const Node* advanced = node.find("advanced")) spec.is_advanced = advanced->boolean;
    if (text_of(node, "bind") == "define") spec.bind = ParamBind::define;
    if (const Node* relations = node.find("requires"))
        for (const Node& item : relations->items)
            spec.relations.push_back(*parse_relation(item.string, item.place));
}

/// The value and the identity; false after a fault of the value.
bool read_values(const SpecReader& reader, SpecOwner owner, ParamSpec& spec) {
    Node empty;
    empty.kind = Node::Kind::object;
    const Node* default_node = reader.node.find("default");
    const Node* identity_node = owner == SpecOwner::manifest ? reader.node.find("identity") : nullptr;
    const Node& written = default_node ? *default_node : empty;
    const std::string& label = reader.label;
    const auto value = parse_param_value(spec, written, label + ".default", reader.diagnostics);
    if (value) spec.default_value = *value;
    if (identity_node)
        spec.identity = parse_param_value(spec, *identity_node, label + ".identity", reader.diagnostics);
    if (!value) return false;
    return spec.type->check_default(spec, written, label, reader.diagnostics);
}

}  // namespace

bool is_block_type(ParamType type) {
    return type->home == ParamHome::block;
}

bool is_scalar_type(ParamType type) {
    return type->is_scalar;
}

bool is_file_type(ParamType type) {
    return type->home == ParamHome::file;
}

bool is_ocio_file(const ParamSpec& spec) {
    return is_file_type(spec.type) &&
           (spec.file_kind == FileKind::ocio_config || spec.file_kind == FileKind::ocio_transform);
}

bool is_param_texture(ParamType type) {
    return type->texture != nullptr;
}

bool is_param_buffer(ParamType type) {
    return type->table != nullptr;
}

int component_count(ParamType type) {
    return type->components;
}

std::string_view param_type_name(ParamType type) {
    return type->name;
}

std::optional<ParamSpec> read_spec(const std::string& name, const std::string& label, SpecOwner owner,
                                   const Node& node, Diagnostics& diagnostics,
                                   std::span<const ParamType> types) {
    const int errors_before = diagnostics.error_count();
    ParamSpec spec;
    spec.name = name;
    spec.place = node.place;
    spec.doc = text_of(node, "doc");
    spec.type = *std::ranges::find(types, text_of(node, "type"), [](ParamType known) { return known->name; });
    const SpecReader reader{node, label, types, diagnostics};
    read_range(reader, spec);
    spec.type->read_declaration(reader, spec);
    if (owner == SpecOwner::manifest) read_manifest_keys(node, spec);
    if (diagnostics.error_count() > errors_before || !read_values(reader, owner, spec)) return std::nullopt;
    return spec;
}

std::optional<ParamSpec> read_param_spec(const std::string& name, const Node& node, Diagnostics& diagnostics,
                                         std::span<const ParamType> types) {
    return read_spec(name, name, SpecOwner::manifest, node, diagnostics, types);
}

}  // namespace aftershade
