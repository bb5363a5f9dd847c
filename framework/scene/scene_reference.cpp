#include <sstream>

#include "framework/scene/fields.h"
#include "framework/scene/scene_schema.h"

namespace aftershade::scene {

namespace {

std::string link(const std::string& block) {
    return "[" + block + "](#" + block + ")";
}

std::string type_of(const Field& field) {
    std::string text{param_type_name(field.spec.type)};
    for (std::size_t i = 0; i < field.spec.values.size(); ++i)
        text += (i ? ", " : ": ") + field.spec.values[i];
    if (field.whole) text += " of whole numbers";
    if (field.uniform) text += ", or one number";
    if (!field.block.empty()) text += ", or " + link(field.block);
    return text;
}

std::string type_of(const Part& part) {
    switch (part.form) {
        case Part::Form::text: return "text";
        case Part::Form::file: return "path from the document's folder";
        case Part::Form::name: return "name of a declared " + link(part.of);
        case Part::Form::object: return link(part.of);
        case Part::Form::scattering: return "[scattering profile](params.md#scattering-profiles)";
        case Part::Form::list: return "list of " + link(part.of);
        case Part::Form::by_name: return link(part.of) + " by name";
        case Part::Form::values: return "list of values as " + part.of + " has";
        case Part::Form::frame_range: return "range such as \"1-24\" or \"1-100x2,120\", or a number";
        case Part::Form::frames: return "list of whole numbers";
    }
    return "";
}

std::string count_of(const Part& part) {
    if (part.form == Part::Form::frames)
        return "-" + std::to_string(kMaxCut) + " to " + std::to_string(kMaxCut);
    if (part.max_items < 0) return "";
    const std::string most = std::to_string(part.max_items);
    return part.min_items == part.max_items ? most : "at most " + most;
}

std::string default_of(const Field& field) {
    if (field.required) return "required";
    if (const auto* word = std::get_if<std::string>(&field.spec.default_value)) return *word;
    return format_value(field.spec, field.spec.default_value);
}

struct Row {
    std::string key, type, unit, range, value, animated, doc;
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
    return out << "| `" << row.key << "` | " << row.type << " | " << row.unit << " | " << row.range << " | "
               << row.value << " | " << row.animated << " | " << row.doc << " |\n";
}

void write_block(const Block& block, const std::string& heading, const std::vector<Row>& first,
                 std::ostream& out) {
    out << "\n" << heading << "\n\n" << block.doc << "\n";
    if (first.empty() && block.fields.empty() && block.parts.empty()) return;
    out << "\n| key | type | unit | range | default | animated | |\n|---|---|---|---|---|---|---|\n";
    for (const Row& row : first) out << row;
    for (const Field& field : block.fields)
        out << Row{field.spec.name,        type_of(field),    field.spec.unit,
                   range_text(field.spec), default_of(field), field.animated ? "yes" : "",
                   field.spec.doc};
    for (const Part& part : block.parts)
        out << Row{part.name, type_of(part), "", count_of(part), part.required ? "required" : "",
                   "",        part.doc};
}

void write_kinds(const Block& common, const std::string& selector, const std::vector<Block>& kinds,
                 std::ostream& out) {
    std::string names = "enum";
    for (std::size_t i = 0; i < kinds.size(); ++i) names += (i ? ", " : ": ") + kinds[i].name;
    write_block(common, "## " + common.name, {{selector, names, "", "", "required", "", "See below."}}, out);
    for (const Block& kind : kinds) write_block(kind, "### " + selector + " \"" + kind.name + "\"", {}, out);
}

constexpr const char* kHead =
    R"(<!-- Made by `aftershade docs` from framework/scene/fields.cpp; do not edit. -->
# Scene documents

What a `scene.json` for `aftershade render` may say. It is JSON with `//` comments; a key that is not listed is
an error. `aftershade schema scene` prints the same as a JSON Schema.

A value with a unit is a number in that unit, or a string in any unit that converts to it: `50` or `"5 cm"` for
mm; so is each number of a vector. The range holds for each of them. Where *animated* says yes, the value may be
`{ "keys": { "1": ..., "12.5": ... }, "interpolation": ... }`: values by frame, between which it is)";

}  // namespace

std::string scene_reference() {
    std::ostringstream out;
    out << kHead;
    for (std::size_t i = 0; i < interpolation_names().size(); ++i)
        out << (i ? ", `" : "\n`") << interpolation_names()[i] << (i ? "`" : "` (the default)");
    out << ".\n";
    const auto write = [&](const Block& block) { write_block(block, "## " + block.name, {}, out); };
    write_block(scene_block(), "## " + scene_block().name,
                {{"aftershade", "int", "", "1", "required", "", "Version of the format."},
                 {"$schema", "text", "", "", "", "", "Where an editor finds the schema."}},
                out);
    for (const Block* block : {&camera_block(), &shutter_block(), &material_block(), &checker_block(),
                               &mesh_block(), &height_field_block(), &wave_block()})
        write(*block);
    write_kinds(object_block(), "shape", shape_blocks(), out);
    write(repeat_block());
    write_kinds(light_block(), "type", light_blocks(), out);
    write(pattern_block());
    return out.str();
}

}  // namespace aftershade::scene
