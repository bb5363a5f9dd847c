#include <cctype>

#include "framework/image/camera.h"
#include "framework/image/color_space.h"
#include "framework/image/frame_range.h"
#include "framework/image/light.h"
#include "framework/image/role.h"
#include "framework/pipeline/schema.h"
#include "framework/pipeline/schema_role.h"

namespace aftershade {

using schema::json;

namespace {

const json kNumber = {{"type", "number"}};
const json kFlag = {{"type", "boolean"}};

json length_m() {
    ParamSpec spec;
    spec.unit = "m";
    spec.min = 0;
    return schema::quantity(spec);
}

/// As profile_parse.cpp reads them.
json decoding_of(const ChannelRole& role) {
    const json names = schema::array_of(schema::text(), role.channels, role.channels);
    json keys = {{"channels", names}, {"sum", schema::array_of(names, 1)}};
    std::vector<std::string> components;
    for (const std::string& native : role.native_channels) {
        components.emplace_back(1, char(std::tolower(static_cast<unsigned char>(native.back()))));
        keys[components.back()] = schema::text();
    }
    // Colour may have no alpha.
    if (role.has_optional_alpha()) components.pop_back();
    if (role.has_optional_alpha()) keys["luminance"] = schema::text();
    if (role.kind == RoleKind::distance) {
        for (const char* key : {"scale", "no_hit", "no_hit_stored"}) keys[key] = kNumber;
        keys["zero_is_no_hit"] = keys["reversed"] = kFlag;
        keys["encoding"] = schema::one_of({"linear", "inverse", "z_buffer", "normalized"});
        keys["kind"] = schema::one_of({"planar", "radial"});
        keys["near"] = keys["far"] = length_m();
    }
    if (role.kind == RoleKind::motion) {
        keys["delta"] = schema::one_of(role.to_next ? std::vector<std::string>{"next-cur", "cur-next"}
                                                    : std::vector<std::string>{"cur-prev", "prev-cur"});
        keys["y_axis"] = schema::one_of({"up", "down"});
        keys["unit"] = schema::one_of({"px", "uv", "ndc"});
        keys["scale"] = {{"anyOf", {kNumber, schema::array_of(kNumber, 2, 2)}}};
        keys["bias"] = keys["no_motion_above"] = kNumber;
        keys["premultiplied"] = kFlag;
        keys["shutter_frames"] = {{"type", "number"}, {"exclusiveMinimum", 0}};
    }
    json decoding = schema::object(keys);
    decoding["description"] = role.meaning;
    decoding["anyOf"] = {{{"required", {"channels"}}}, {{"required", {"sum"}}}, {{"required", components}}};
    json together = json::object();
    for (const std::string& native : role.native_channels)
        together[std::string(1, char(std::tolower(static_cast<unsigned char>(native.back()))))] = components;
    decoding["dependentRequired"] = together;
    return decoding;
}

json camera() {
    json fields = {{"lens_model", schema::one_of({"thin", "pinhole"})}};
    for (const CameraField& field : camera_fields()) {
        ParamSpec spec;
        spec.unit = field.unit;
        spec.min = field.min;
        fields[field.name] = schema::quantity(spec);
    }
    return schema::object(fields);
}

/// As light.cpp reads them.
json light() {
    const auto numbers = [](ParamType type, const char* unit, std::optional<double> min) {
        ParamSpec spec;
        spec.type = type;
        spec.unit = unit;
        spec.min = min;
        return schema::literal(spec);
    };
    std::vector<json> forms;
    for (const std::string& kind : light_kind_names()) {
        json keys = {{"type", {{"const", kind}}},
                     {"name", schema::text()},
                     {"intensity", numbers(ParamType::vec3, "", 0)}};
        std::vector<std::string> required = {"type", "intensity"};
        const auto add = [&](const char* key, const json& form) {
            keys[key] = form;
            required.emplace_back(key);
        };
        if (kind != "directional") add("position", numbers(ParamType::vec3, "m", {}));
        if (kind != "point") {
            add("direction", numbers(ParamType::vec3, "", {}));
            keys["direction"]["not"] = {{"const", {0, 0, 0}}};
        }
        if (kind == "area") add("size", numbers(ParamType::vec2, "m", 1e-6));
        forms.push_back(schema::object(keys, required));
    }
    return schema::any_of(forms);
}

}  // namespace

std::string capture_schema() {
    json decodings = json::object(), files = json::object();
    for (const ChannelRole& role : channel_roles()) {
        decodings[role.name] = decoding_of(role);
        files[role.name] = schema::text();
    }
    json by_role = schema::object(decodings), file_by_role = schema::object(files);
    by_role["patternProperties"] = {{schema::kAovPattern, decoding_of(*find_role("aov:name"))}};
    file_by_role["patternProperties"] = {{schema::kAovPattern, schema::text()}};
    std::vector<std::string> spaces = color_space_names();
    spaces.insert(spaces.begin(), "auto");
    json document = schema::document(
        "Aftershade capture",
        {{"frames", {{"type", "string"}, {"description", "The main files: \"gbuffer_####.exr\"."}}},
         {"files", file_by_role},
         {"range",
          {{"type", "string"},
           {"description", "Frames that there are: \"1-100x2,120\"."},
           {"pattern", frame_range_pattern()}}},
         {"fps", {{"type", "number"}, {"exclusiveMinimum", 0}}},
         {"profile", {{"type", "string"}, {"description", "Conventions of the producer; default auto."}}},
         {"view", schema::text()},
         {"color_space", schema::one_of(spaces)},
         {"channels", by_role},
         {"camera", camera()},
         {"lights", schema::array_of(light())},
         {"cryptomatte",
          schema::object({{"layer", schema::text()}, {"mask", schema::array_of(schema::text())}})},
         {"cuts", schema::array_of({{"type", "integer"}})},
         {"subframes", {{"type", "integer"}, {"minimum", 1}, {"maximum", 1024}}}},
        {});
    document["anyOf"] = {
        {{"required", {"frames"}}},
        {{"required", {"files"}}, {"properties", {{"files", {{"required", {kColorRole}}}}}}}};
    return document.dump(2) + "\n";
}

}  // namespace aftershade
