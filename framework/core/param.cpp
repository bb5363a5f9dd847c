#include "framework/core/param.h"

#include <algorithm>
#include <set>
#include <utility>

#include "framework/core/units.h"

namespace aftershade {

namespace {

constexpr std::array<std::pair<ParamType, std::string_view>, 9> kTypeNames = {{
    {ParamType::float_, "float"},
    {ParamType::int_, "int"},
    {ParamType::bool_, "bool"},
    {ParamType::enum_, "enum"},
    {ParamType::angle, "angle"},
    {ParamType::color, "color"},
    {ParamType::vec2, "vec2"},
    {ParamType::vec3, "vec3"},
    {ParamType::vec4, "vec4"},
}};

std::vector<std::string> type_names() {
    std::vector<std::string> names;
    for (const auto& [type, name] : kTypeNames) names.emplace_back(name);
    return names;
}

ParamType type_of_name(const std::string& name) {
    const auto found =
        std::find_if(kTypeNames.begin(), kTypeNames.end(), [&](auto& t) { return t.second == name; });
    return found->first;
}

bool is_numeric(ParamType type) {
    return type != ParamType::bool_ && type != ParamType::enum_;
}

void read_unit(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    const auto unit = reader.text("unit");
    if (spec.type == ParamType::angle && !unit) spec.unit = "deg";
    if (!unit) return;
    const Place place = node.find("unit")->place;
    if (!is_numeric(spec.type))
        diagnostics.error(place, "a " + std::string(param_type_name(spec.type)) + " has no unit");
    else if (!is_unit(*unit))
        diagnostics.error(place,
                          "'" + *unit + "' is not a unit; known: " + list_of_names(unit_names(), "and"));
    else spec.unit = *unit;
}

void read_enum_values(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    spec.values = reader.texts("values");
    if (spec.type == ParamType::enum_ && spec.values.size() < 2)
        diagnostics.error(node.place, "enum parameter '" + spec.name + "' needs at least two 'values'");
    if (spec.type != ParamType::enum_ && node.find("values"))
        diagnostics.error(node.find("values")->place, "only an enum has 'values'");
    if (spec.values.empty()) return;
    std::set<std::string> seen;
    for (const Node& item : node.find("values")->items) {
        if (!item.is_string()) continue;
        // Shaders see a value as a preprocessor symbol: SHAPE_HEXAGON.
        if (item.string.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
            diagnostics.error(item.place, "'" + item.string + "' cannot name a value: a-z, 0-9 and _ only");
        if (!seen.insert(item.string).second)
            diagnostics.error(item.place, "'" + item.string + "' stands twice in 'values'");
    }
}

void refuse_range(const Node& node, const ParamSpec& spec, Diagnostics& diagnostics) {
    for (const char* key : {"min", "max", "ui"})
        if (const Node* value = node.find(key))
            diagnostics.error(value->place,
                              "a " + std::string(param_type_name(spec.type)) + " has no '" + key + "'");
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

}  // namespace

bool is_block_type(ParamType type) {
    return type != ParamType::curve && type != ParamType::file && type != ParamType::table;
}

int component_count(ParamType type) {
    switch (type) {
        case ParamType::vec2: return 2;
        case ParamType::vec3:
        case ParamType::color: return 3;
        case ParamType::vec4: return 4;
        default: return 1;
    }
}

std::string_view param_type_name(ParamType type) {
    const auto found =
        std::find_if(kTypeNames.begin(), kTypeNames.end(), [&](auto& t) { return t.first == type; });
    return found->second;
}

std::optional<ParamSpec> parse_param_spec(const std::string& name, const Node& node,
                                          Diagnostics& diagnostics) {
    using Presence = ObjectReader::Presence;
    ObjectReader reader(node, "parameter '" + name + "'", diagnostics);
    if (!reader.is_object()) return std::nullopt;
    const int errors_before = diagnostics.error_count();

    ParamSpec spec;
    spec.name = name;
    spec.place = node.place;
    const auto type = reader.choice("type", type_names(), Presence::required);
    if (type) spec.type = type_of_name(*type);
    read_unit(reader, node, spec, diagnostics);
    read_enum_values(reader, node, spec, diagnostics);
    spec.min = reader.number("min");
    spec.max = reader.number("max");
    read_ui_range(reader, spec, diagnostics);
    if (!is_numeric(spec.type)) refuse_range(node, spec, diagnostics);
    spec.doc = reader.text("doc", Presence::required).value_or("");
    spec.from = reader.text("from").value_or("");
    const auto bind = reader.choice("bind", std::vector<std::string>{"uniform", "define"});
    if (bind == "define") spec.bind = ParamBind::define;
    const Node* default_node = reader.any("default", Presence::required);
    const Node* identity_node = reader.any("identity");
    reader.finish();
    if (!type || diagnostics.error_count() > errors_before) return std::nullopt;

    if (spec.min && spec.max && *spec.min > *spec.max) {
        diagnostics.error(node.place, "parameter '" + name + "': 'min' is above 'max'");
        return std::nullopt;
    }
    const auto value = parse_param_value(spec, *default_node, name + ".default", diagnostics);
    if (value) spec.default_value = *value;
    if (identity_node)
        spec.identity = parse_param_value(spec, *identity_node, name + ".identity", diagnostics);
    return value ? std::optional(spec) : std::nullopt;
}

}  // namespace aftershade
