#include "framework/core/param.h"

#include <algorithm>
#include <utility>

#include "framework/core/param_type.h"
#include "framework/core/text.h"
#include "framework/core/units.h"

namespace aftershade {

using Presence = ObjectReader::Presence;

namespace {

std::vector<std::string> type_names(std::span<const ParamType> types, SpecOwner owner) {
    std::vector<std::string> names;
    for (const ParamType type : types)
        if (owner == SpecOwner::manifest || is_block_type(type)) names.emplace_back(type->name);
    return names;
}

/// "a bool", "an enum", for messages.
std::string a_type(ParamType type) {
    if (!type->phrase.empty()) return std::string(type->phrase);
    const std::string name(type->name);
    return (std::string_view("aeiou").find(name[0]) == std::string_view::npos ? "a " : "an ") + name;
}

void read_unit(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    const auto unit = reader.text("unit");
    if (!unit) {
        spec.unit = spec.type->usual_unit;
        return;
    }
    const Place place = node.find("unit")->place;
    if (!spec.type->has_range) diagnostics.error(place, a_type(spec.type) + " has no unit");
    else if (!is_unit(*unit))
        diagnostics.error(place,
                          "'" + *unit + "' is not a unit; known: " + list_of_names(unit_names(), "and"));
    else spec.unit = *unit;
}

/// Of the types whose home is the block, or of the others: the keys of the declared type, while those of the
/// other types are refused.
void read_own_keys(const SpecReader& reader, ParamSpec& spec, bool of_block) {
    for (const ParamType type : reader.types) {
        if (is_block_type(type) != of_block) continue;
        if (type == spec.type) {
            if (type->read_declaration) type->read_declaration(reader, spec);
            continue;
        }
        for (const OwnKey& key : type->own_keys)
            if (const Node* value = reader.node.find(key.name)) {
                (void)reader.object.any(key.name);  // known, so that it is refused once
                reader.diagnostics.error(
                    value->place, "only " + a_type(type) + " has " + key.article + "'" + key.name + "'");
            }
    }
}

void refuse_keys(const Node& node, std::initializer_list<const char*> keys, const std::string& owner,
                 Diagnostics& diagnostics) {
    for (const char* key : keys)
        if (const Node* value = node.find(key))
            diagnostics.error(value->place, owner + " has no '" + key + "'");
}

void read_ui_range(ObjectReader& reader, ParamSpec& spec, Diagnostics& diagnostics) {
    const Node* ui = reader.array("ui");
    if (!ui) return;
    if (ui->items.size() != 2 || !ui->items[0].is_number() || !ui->items[1].is_number()) {
        diagnostics.error(ui->place, "'ui' holds two numbers, the ends of a slider");
        return;
    }
    spec.ui_range = {ui->items[0].number, ui->items[1].number};
    const auto& [low, high] = *spec.ui_range;
    if (low >= high || (spec.min && low < *spec.min) || (spec.max && high > *spec.max))
        diagnostics.error(ui->place, "'ui' must rise and stay within 'min' and 'max'");
}

/// "> focal_length", spaces where one likes.
std::optional<ParamRelation> parse_relation(std::string_view text, const Place& place) {
    using Order = ParamRelation::Order;
    constexpr std::string_view kSpace = " \t\n\v\f\r";
    const auto trim = [&] {
        text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
        text = text.substr(0, text.find_last_not_of(kSpace) + 1);
    };
    trim();
    if (!text.starts_with('<') && !text.starts_with('>')) return std::nullopt;
    const bool is_less = text.starts_with('<');
    text.remove_prefix(1);
    const bool is_equal = text.starts_with('=');
    if (is_equal) text.remove_prefix(1);
    trim();
    if (!is_snake_case(text)) return std::nullopt;
    const Order order = is_less ? (is_equal ? Order::less_equal : Order::less)
                                : (is_equal ? Order::greater_equal : Order::greater);
    return ParamRelation{order, std::string(text), place};
}

void read_relations(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    reader.texts("requires");
    const Node* list = node.find("requires");
    if (!list || !list->is_array()) return;
    if (!spec.type->is_scalar) {
        diagnostics.error(list->place, a_type(spec.type) + " has no 'requires': it has no order");
        return;
    }
    for (const Node& item : list->items) {
        if (!item.is_string()) continue;
        if (auto relation = parse_relation(item.string, item.place))
            spec.relations.push_back(std::move(*relation));
        else
            diagnostics.error(item.place, "'" + item.string +
                                              "' is no relation; write '<', '<=', '>' or '>=' and the name "
                                              "of a parameter: \"> focal_length\"");
    }
}

/// What only a parameter of a manifest has, not a column of a table.
void read_manifest_keys(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    spec.from = reader.text("from").value_or("");
    const auto bind = reader.choice("bind", std::vector<std::string>{"uniform", "define"});
    if (bind == "define") spec.bind = ParamBind::define;
    read_relations(reader, node, spec, diagnostics);
    if (is_block_type(spec.type)) return;
    if (node.find("from")) diagnostics.error(node.find("from")->place, a_type(spec.type) + " has no 'from'");
    if (spec.bind == ParamBind::define)
        diagnostics.error(node.find("bind")->place,
                          a_type(spec.type) +
                              " cannot be a define: it reaches a shader as a texture or a "
                              "buffer");
}

/// The value and the identity of a declaration whose keys have no fault; false after one of theirs.
bool read_values(const SpecReader& reader, const Node* default_node, const Node* identity_node,
                 ParamSpec& spec) {
    Node empty;
    empty.kind = Node::Kind::object;
    const Node& written = default_node ? *default_node : empty;
    const std::string& label = reader.label;
    const auto value = parse_param_value(spec, written, label + ".default", reader.diagnostics);
    if (value) spec.default_value = *value;
    if (identity_node)
        spec.identity = parse_param_value(spec, *identity_node, label + ".identity", reader.diagnostics);
    if (!value) return false;
    const auto check = spec.type->check_default;
    return !check || check(spec, written, label, reader.diagnostics);
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

bool is_param_texture(ParamType type) {
    return type->texture.size != nullptr;
}

bool is_param_buffer(ParamType type) {
    return type->table.rows != nullptr;
}

int component_count(ParamType type) {
    return type->components;
}

std::string_view param_type_name(ParamType type) {
    return type->name;
}

std::optional<ParamSpec> parse_spec(const std::string& name, const std::string& thing,
                                    const std::string& label, SpecOwner owner, const Node& node,
                                    Diagnostics& diagnostics, std::span<const ParamType> types) {
    ObjectReader reader(node, thing, diagnostics);
    if (!reader.is_object()) return std::nullopt;
    const int errors_before = diagnostics.error_count();

    ParamSpec spec;
    spec.name = name;
    spec.place = node.place;
    const auto type = reader.choice("type", type_names(types, owner), Presence::required);
    if (type) spec.type = *std::ranges::find(types, *type, [](ParamType known) { return known->name; });
    read_unit(reader, node, spec, diagnostics);
    const SpecReader keys{reader, node, label, types, diagnostics};
    read_own_keys(keys, spec, true);
    spec.min = reader.number("min");
    spec.max = reader.number("max");
    read_ui_range(reader, spec, diagnostics);
    if (!spec.type->has_range) refuse_keys(node, {"min", "max", "ui"}, a_type(spec.type), diagnostics);
    read_own_keys(keys, spec, false);
    spec.doc = reader.text("doc", Presence::required).value_or("");
    const Node* identity_node = nullptr;
    if (owner == SpecOwner::manifest) {
        read_manifest_keys(reader, node, spec, diagnostics);
        identity_node = reader.any("identity");
    }
    const Node* default_node =
        reader.any("default", spec.type->has_default ? Presence::required : Presence::optional);
    reader.finish();
    if (!type || diagnostics.error_count() > errors_before) return std::nullopt;

    if (spec.min && spec.max && *spec.min > *spec.max) {
        diagnostics.error(node.place, thing + ": 'min' is above 'max'");
        return std::nullopt;
    }
    if (!read_values(keys, default_node, identity_node, spec)) return std::nullopt;
    return spec;
}

std::optional<ParamSpec> parse_param_spec(const std::string& name, const Node& node, Diagnostics& diagnostics,
                                          std::span<const ParamType> types) {
    return parse_spec(name, "parameter '" + name + "'", name, SpecOwner::manifest, node, diagnostics, types);
}

}  // namespace aftershade
