#include "framework/core/param.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <set>
#include <utility>

#include "framework/core/param_internal.h"
#include "framework/core/units.h"

namespace aftershade {

using Presence = ObjectReader::Presence;

namespace {

constexpr std::array<std::pair<ParamType, std::string_view>, 14> kTypeNames = {{
    {ParamType::float_, "float"},
    {ParamType::int_, "int"},
    {ParamType::bool_, "bool"},
    {ParamType::enum_, "enum"},
    {ParamType::angle, "angle"},
    {ParamType::color, "color"},
    {ParamType::vec2, "vec2"},
    {ParamType::vec3, "vec3"},
    {ParamType::vec4, "vec4"},
    {ParamType::curve, "curve"},
    {ParamType::file, "file"},
    {ParamType::table, "table"},
    {ParamType::objects, "objects"},
    {ParamType::scattering_profile, "scattering_profile"},
}};

std::vector<std::string> type_names(SpecOwner owner) {
    std::vector<std::string> names;
    for (const auto& [type, name] : kTypeNames)
        if (owner == SpecOwner::manifest || is_block_type(type)) names.emplace_back(name);
    return names;
}

ParamType type_of_name(const std::string& name) {
    const auto found =
        std::find_if(kTypeNames.begin(), kTypeNames.end(), [&](auto& t) { return t.second == name; });
    return found->first;
}

/// Has a unit and a range: numbers, and the y of curves.
bool is_numeric(ParamType type) {
    return type == ParamType::curve ||
           (is_block_type(type) && type != ParamType::bool_ && type != ParamType::enum_);
}

bool is_numeric_scalar(ParamType type) {
    return type == ParamType::float_ || type == ParamType::int_ || type == ParamType::angle;
}

/// "a bool", "an enum", for messages.
std::string a_type(ParamType type) {
    if (type == ParamType::objects) return "a list of objects";
    const std::string name(param_type_name(type));
    return (std::string_view("aeiou").find(name[0]) == std::string_view::npos ? "a " : "an ") + name;
}

void read_unit(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    const auto unit = reader.text("unit");
    if (spec.type == ParamType::angle && !unit) spec.unit = "deg";
    if (!unit) return;
    const Place place = node.find("unit")->place;
    if (!is_numeric(spec.type)) diagnostics.error(place, a_type(spec.type) + " has no unit");
    else if (!is_unit(*unit))
        diagnostics.error(place,
                          "'" + *unit + "' is not a unit; known: " + list_of_names(unit_names(), "and"));
    else spec.unit = *unit;
}

void read_enum_values(ObjectReader& reader, const Node& node, ParamSpec& spec, const std::string& label,
                      Diagnostics& diagnostics) {
    spec.values = reader.texts("values");
    if (spec.type == ParamType::enum_ && spec.values.size() < 2)
        diagnostics.error(node.place, "enum parameter '" + label + "' needs at least two 'values'");
    if (spec.type != ParamType::enum_ && node.find("values"))
        diagnostics.error(node.find("values")->place, "only an enum has 'values'");
    if (spec.values.empty()) return;
    std::set<std::string> seen;
    for (const Node& item : node.find("values")->items) {
        if (!item.is_string()) continue;
        // Shaders see a value as a preprocessor symbol: SHAPE_HEXAGON.
        if (item.string.empty() ||
            item.string.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
            diagnostics.error(item.place, "'" + item.string + "' cannot name a value: a-z, 0-9 and _ only");
        if (!seen.insert(item.string).second)
            diagnostics.error(item.place, "'" + item.string + "' stands twice in 'values'");
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

void read_domain(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    if (spec.type != ParamType::curve) {
        if (node.find("domain"))
            diagnostics.error(reader.any("domain")->place, "only a curve has a 'domain'");
        return;
    }
    const Node* domain = reader.array("domain");
    if (!domain) return;
    const auto& ends = domain->items;
    if (ends.size() == 2 && ends[0].is_number() && ends[1].is_number() && ends[0].number < ends[1].number)
        spec.domain = {ends[0].number, ends[1].number};
    else diagnostics.error(domain->place, "'domain' holds two numbers that rise, the ends of x");
}

void read_file_keys(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    static const std::vector<std::string> kinds = {"image", "lut"};
    static const std::vector<std::string> spaces = {"srgb", "data"};
    if (spec.type != ParamType::file) {
        for (const char* key : {"kind", "space"})
            if (node.find(key))
                diagnostics.error(reader.any(key)->place, "only a file has a '" + std::string(key) + "'");
        return;
    }
    if (reader.choice("kind", kinds, Presence::required) == "lut") spec.file_kind = FileKind::lut;
    spec.file_is_data = reader.choice("space", spaces) == "data";
    if (spec.file_kind == FileKind::lut && node.find("space"))
        diagnostics.error(node.find("space")->place, "only a file of kind image has a 'space'");
}

void read_relations(ObjectReader& reader, const Node& node, ParamSpec& spec, Diagnostics& diagnostics) {
    using Order = ParamRelation::Order;
    static const std::map<std::string, Order> orders = {
        {"<", Order::less}, {"<=", Order::less_equal}, {">", Order::greater}, {">=", Order::greater_equal}};
    static const std::regex form(R"(\s*([<>]=?)\s*([a-z][a-z0-9_]*)\s*)");
    reader.texts("requires");
    const Node* list = node.find("requires");
    if (!list || !list->is_array()) return;
    if (!is_numeric_scalar(spec.type)) {
        diagnostics.error(list->place, a_type(spec.type) + " has no 'requires': it has no order");
        return;
    }
    for (const Node& item : list->items) {
        std::smatch match;
        if (!item.is_string()) continue;
        if (std::regex_match(item.string, match, form))
            spec.relations.push_back({orders.at(match[1]), match[2], item.place});
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

ParamSpec listed_column() {
    ParamSpec spec;
    spec.name = "listed";
    spec.type = ParamType::bool_;
    spec.default_value = false;
    return spec;
}

/// A manifest's own files lie in its effect's folder.
bool check_default_path(const ParamSpec& spec, const Node& node, const std::string& label,
                        Diagnostics& diagnostics) {
    if (spec.type != ParamType::file) return true;
    const std::filesystem::path path = std::get<std::string>(spec.default_value);
    const std::filesystem::path normal = path.lexically_normal();
    if (path.empty() || (path.is_relative() && *normal.begin() != "..")) return true;
    diagnostics.error(node.place,
                      label + ".default: '" + path.string() + "' must lie in the effect's folder");
    return false;
}

}  // namespace

bool is_block_type(ParamType type) {
    return type < ParamType::curve;
}

bool is_param_texture(ParamType type) {
    return type == ParamType::curve || type == ParamType::scattering_profile;
}

bool is_param_buffer(ParamType type) {
    return type == ParamType::table || type == ParamType::objects || type == ParamType::scattering_profile;
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

std::optional<ParamSpec> parse_spec(const std::string& name, const std::string& thing,
                                    const std::string& label, SpecOwner owner, const Node& node,
                                    Diagnostics& diagnostics) {
    ObjectReader reader(node, thing, diagnostics);
    if (!reader.is_object()) return std::nullopt;
    const int errors_before = diagnostics.error_count();

    ParamSpec spec;
    spec.name = name;
    spec.place = node.place;
    const auto type = reader.choice("type", type_names(owner), Presence::required);
    if (type) spec.type = type_of_name(*type);
    read_unit(reader, node, spec, diagnostics);
    read_enum_values(reader, node, spec, label, diagnostics);
    spec.min = reader.number("min");
    spec.max = reader.number("max");
    read_ui_range(reader, spec, diagnostics);
    if (!is_numeric(spec.type)) refuse_keys(node, {"min", "max", "ui"}, a_type(spec.type), diagnostics);
    read_domain(reader, node, spec, diagnostics);
    read_file_keys(reader, node, spec, diagnostics);
    if (spec.type == ParamType::table) {
        if (const Node* columns = reader.object("columns", Presence::required))
            read_columns(*columns, spec, diagnostics);
    } else if (node.find("columns")) {
        diagnostics.error(reader.any("columns")->place, "only a table has 'columns'");
    }
    if (spec.type == ParamType::scattering_profile) spec.columns = scattering_columns();
    if (spec.type == ParamType::objects) spec.columns = {listed_column()};
    spec.doc = reader.text("doc", Presence::required).value_or("");
    const Node* identity_node = nullptr;
    if (owner == SpecOwner::manifest) {
        read_manifest_keys(reader, node, spec, diagnostics);
        identity_node = reader.any("identity");
    }
    const bool default_needed = spec.type != ParamType::table;
    const Node* default_node =
        reader.any("default", default_needed ? Presence::required : Presence::optional);
    reader.finish();
    if (!type || diagnostics.error_count() > errors_before) return std::nullopt;

    if (spec.min && spec.max && *spec.min > *spec.max) {
        diagnostics.error(node.place, thing + ": 'min' is above 'max'");
        return std::nullopt;
    }
    Node no_rows;
    no_rows.kind = Node::Kind::object;
    const Node& written = default_node ? *default_node : no_rows;
    const auto value = parse_param_value(spec, written, label + ".default", diagnostics);
    if (value) spec.default_value = *value;
    if (identity_node)
        spec.identity = parse_param_value(spec, *identity_node, label + ".identity", diagnostics);
    if (!value || !check_default_path(spec, written, label, diagnostics)) return std::nullopt;
    return spec;
}

std::optional<ParamSpec> parse_param_spec(const std::string& name, const Node& node,
                                          Diagnostics& diagnostics) {
    return parse_spec(name, "parameter '" + name + "'", name, SpecOwner::manifest, node, diagnostics);
}

}  // namespace aftershade
