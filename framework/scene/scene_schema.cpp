#include "framework/scene/scene_schema.h"

#include "framework/core/schema_pieces.h"
#include "framework/image/frame_range.h"
#include "framework/scattering/scattering_schema.h"
#include "framework/scene/fields.h"

namespace aftershade::scene {

using schema::json;

namespace {

/// As parse_number() reads them.
constexpr const char* kFrameNumber = R"(^[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$)";
/// parse_frame_range() takes nine digits.
constexpr int kMaxFrame = 999999999;

json reference(const std::string& block) {
    return {{"$ref", "#/$defs/" + block}};
}

json integers(int limit) {
    return {{"type", "integer"}, {"minimum", -limit}, {"maximum", limit}};
}

/// A value that is the same in every frame, or one key's.
std::vector<json> literals(const Field& field) {
    json literal = schema::literal(field.spec);
    if (field.whole) literal["items"]["type"] = "integer";
    if (!field.never.empty()) literal["not"] = {{"enum", field.never}};
    if (field.has_length)
        literal["not"] = {{"const", std::vector<int>(std::size_t(component_count(field.spec.type)), 0)}};
    std::vector<json> forms = {std::move(literal)};
    if (field.uniform) forms.push_back(schema::quantity(field.spec));
    return forms;
}

json any_of(std::vector<json> forms) {
    return forms.size() == 1 ? forms[0] : schema::any_of(std::move(forms));
}

json keyed(const Field& field) {
    const json keys = {{"type", "object"},
                       {"patternProperties", {{kFrameNumber, any_of(literals(field))}}},
                       {"additionalProperties", false},
                       {"minProperties", 1}};
    return schema::object({{"keys", keys}, {"interpolation", schema::one_of(interpolation_names())}},
                          {"keys"});
}

json form_of(const Field& field) {
    std::vector<json> forms = literals(field);
    if (field.animated) forms.push_back(keyed(field));
    if (!field.block.empty()) forms.push_back(reference(field.block));
    json form = any_of(std::move(forms));
    form["description"] = field.spec.doc + (field.spec.unit.empty() ? "" : " [" + field.spec.unit + "]");
    if (!field.required) form["default"] = json::parse(format_value(field.spec, field.spec.default_value));
    return form;
}

json form_of(const Part& part) {
    switch (part.form) {
        case Part::Form::text:
        case Part::Form::file:
        case Part::Form::name: return schema::text();
        case Part::Form::object: return reference(part.of);
        case Part::Form::scattering: return schema::any_of({schema::text(), schema::scattering_profile()});
        case Part::Form::list: return schema::array_of(reference(part.of), part.min_items, part.max_items);
        case Part::Form::by_name: return {{"type", "object"}, {"additionalProperties", reference(part.of)}};
        case Part::Form::values:
            return schema::array_of(any_of(literals(material_block().field(part.of))), part.min_items,
                                    part.max_items);
        case Part::Form::frame_range: {
            const json range = {{"type", "string"}, {"pattern", frame_range_pattern()}};
            return schema::any_of({range, integers(kMaxFrame)});
        }
        case Part::Form::frames: {
            json frames = schema::array_of(integers(kMaxCut));
            frames["uniqueItems"] = true;
            return frames;
        }
    }
    return json::object();
}

struct Keys {
    json properties = json::object();
    std::vector<std::string> required;

    void add(const Block& block) {
        for (const Field& field : block.fields) {
            properties[field.spec.name] = form_of(field);
            if (field.required) required.push_back(field.spec.name);
        }
        for (const Part& part : block.parts) {
            json form = form_of(part);
            form["description"] = part.doc;
            properties[part.name] = std::move(form);
            if (part.required) required.push_back(part.name);
        }
    }
};

json object_of(const Block& block) {
    Keys keys;
    keys.add(block);
    json object = schema::object(keys.properties, keys.required);
    object["description"] = block.doc;
    return object;
}

/// Objects of several kinds, which `selector` tells apart.
json kinds_of(const Block& common, const std::string& selector, const std::vector<Block>& kinds) {
    std::vector<json> forms;
    for (const Block& kind : kinds) {
        Keys keys;
        keys.properties[selector] = {{"const", kind.name}, {"description", kind.doc}};
        keys.required.push_back(selector);
        keys.add(kind);
        keys.add(common);
        forms.push_back(schema::object(keys.properties, keys.required));
    }
    json any = schema::any_of(forms);
    any["description"] = common.doc;
    return any;
}

/// An object of which exactly one part stands.
json one_part_of(const Block& block) {
    json object = object_of(block);
    object["minProperties"] = object["maxProperties"] = 1;
    return object;
}

/// Where there are materials, everything that is seen has one.
void require_materials(json& document) {
    const json is_group = {{"properties", {{"shape", {{"const", "group"}}}}}};
    const json has_material = {{"required", {"material"}}};
    document["if"] = {{"required", {"materials"}}, {"properties", {{"materials", {{"minProperties", 1}}}}}};
    document["then"] = {{"properties", {{"objects", {{"items", schema::any_of({is_group, has_material})}}}}}};
}

}  // namespace

std::string scene_schema() {
    Keys keys;
    keys.add(scene_block());
    json document = schema::document("Aftershade scene", keys.properties, keys.required);
    require_materials(document);
    json definitions = json::object();
    for (const Block* block : {&camera_block(), &shutter_block(), &material_block(), &checker_block(),
                               &height_field_block(), &wave_block(), &repeat_block(), &pattern_block()})
        definitions[block->name] = object_of(*block);
    definitions[mesh_block().name] = one_part_of(mesh_block());
    definitions[object_block().name] = kinds_of(object_block(), "shape", shape_blocks());
    definitions[light_block().name] = kinds_of(light_block(), "type", light_blocks());
    document["$defs"] = std::move(definitions);
    return document.dump(2) + "\n";
}

}  // namespace aftershade::scene
