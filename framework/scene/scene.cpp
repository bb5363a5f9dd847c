#include "framework/scene/scene.h"

#include <algorithm>
#include <array>

#include "framework/core/error.h"
#include "framework/image/frame_range.h"
#include "framework/scene/scene_reader.h"

namespace aftershade::scene {

using Presence = ObjectReader::Presence;

Shot Scene::shot_of(int frame) const {
    Shot shot;
    for (const int cut : cuts) {
        if (cut <= frame) {
            shot.first = cut;
        } else {
            shot.last = cut - 1;
            break;
        }
    }
    return shot;
}

std::optional<int> SceneReader::find_name(const Node& node, const std::string& what,
                                          const std::map<std::string, int>& names) {
    if (!node.is_string()) {
        diagnostics_.error(node.place, "expected the name of a " + what);
        return std::nullopt;
    }
    if (const auto found = names.find(node.string); found != names.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [name, index] : names) known.push_back(name);
    diagnostics_.error(node.place, "there is no " + what + " '" + node.string + "'" +
                                       (known.empty() ? "" : did_you_mean(node.string, known)));
    return std::nullopt;
}

void SceneReader::read(const Node& node) {
    ObjectReader reader(node, "the scene", diagnostics_);
    if (!reader.is_object()) return;
    check_document_version(reader, node, diagnostics_);
    reader.text("$schema");
    scene_.summary = reader.text("summary").value_or("");
    FieldReader fields(reader, "", diagnostics_);
    const glm::dvec2 size_px = fields.vec2(scene_block(), "size");
    scene_.width_px = int(size_px.x);
    scene_.height_px = int(size_px.y);
    scene_.fps = fields.number(scene_block(), "fps");
    scene_.background = fields.vec3(scene_block(), "background");
    scene_.ambient = fields.vec3(scene_block(), "ambient");
    read_frames(reader);
    if (const Node* camera = reader.object("camera", Presence::required)) read_camera(*camera);
    if (const Node* shutter = reader.object("shutter")) read_shutter(*shutter);
    if (const Node* materials = reader.object("materials")) read_materials(*materials);
    if (const Node* meshes = reader.object("meshes")) read_meshes(*meshes);
    if (const Node* objects = reader.array("objects", Presence::required)) read_objects(*objects);
    if (const Node* lights = reader.array("lights")) read_lights(*lights);
    reader.finish();
    if (scene_.materials.empty()) scene_.materials.emplace_back();
}

void SceneReader::read_frames(ObjectReader& reader) {
    if (const Node* frames = reader.any("frames")) {
        const auto range = frames->is_string() ? parse_frame_range(frames->string)
                           : frames->kind == Node::Kind::integer
                               ? parse_frame_range(std::to_string(frames->integer))
                               : std::nullopt;
        if (!range || range->empty())
            diagnostics_.error(frames->place, "frames are a range such as \"1-24\" or \"1-100x2,120\"");
        else scene_.frames = *range;
    }
    if (const Node* cuts = reader.array("cuts")) {
        for (const Node& cut : cuts->items) {
            if (cut.kind != Node::Kind::integer || cut.integer < -kMaxCut || cut.integer > kMaxCut)
                diagnostics_.error(cut.place, "a cut is the number of the frame that begins a shot");
            else scene_.cuts.push_back(int(cut.integer));
        }
        std::sort(scene_.cuts.begin(), scene_.cuts.end());
        if (std::adjacent_find(scene_.cuts.begin(), scene_.cuts.end()) != scene_.cuts.end())
            diagnostics_.error(cuts->place, "a frame is named twice");
    }
}

void SceneReader::read_camera(const Node& node) {
    ObjectReader reader(node, "the camera", diagnostics_);
    FieldReader fields(reader, "camera.", diagnostics_);
    const Block& block = camera_block();
    SceneCamera& camera = scene_.camera;
    camera.position_m = fields.animated_vec3(block, "position");
    camera.target_m = fields.animated_vec3(block, "target");
    camera.roll_deg = fields.animated_number(block, "roll");
    camera.focal_length_mm = fields.animated_number(block, "focal_length");
    camera.sensor_width_mm = fields.number(block, "sensor_width");
    camera.focus_distance_m = fields.animated_number(block, "focus_distance");
    camera.f_number = fields.number(block, "f_number");
    camera.blades = fields.integer(block, "blades");
    camera.rotation_deg = fields.number(block, "rotation");
    reader.finish();
}

void SceneReader::read_shutter(const Node& node) {
    ObjectReader reader(node, "the shutter", diagnostics_);
    FieldReader fields(reader, "shutter.", diagnostics_);
    scene_.camera.shutter_angle_deg = fields.number(shutter_block(), "angle");
    const std::string phase = fields.choice(shutter_block(), "phase");
    scene_.camera.shutter_phase = phase == "start" ? ShutterPhase::start
                                  : phase == "end" ? ShutterPhase::end
                                                   : ShutterPhase::center;
    reader.finish();
}

void SceneReader::read_albedo(ObjectReader& reader, FieldReader& fields, const std::string& label,
                              Material& material) {
    const Node* node = reader.any("albedo");
    if (!node) return;
    if (node->is_object()) read_checker(*node, fields, label, material);
    else if (const auto value = fields.vec3(material_block().field("albedo"), *node))
        material.albedo = material.albedo_2 = *value;
}

void SceneReader::read_checker(const Node& node, FieldReader& fields, const std::string& label,
                               Material& material) {
    ObjectReader reader(node, "the albedo", diagnostics_);
    material.checker_cells =
        FieldReader(reader, label + "albedo.", diagnostics_).vec2(checker_block(), "cells");
    const Node* colors = reader.array("checker", Presence::required);
    reader.finish();
    if (!colors) return;
    if (colors->items.size() != 2) {
        diagnostics_.error(colors->place, "a checker has two colours");
        return;
    }
    const Field& albedo = material_block().field("albedo");
    if (const auto value = fields.vec3(albedo, colors->items[0])) material.albedo = *value;
    if (const auto value = fields.vec3(albedo, colors->items[1])) material.albedo_2 = *value;
}

std::optional<Scattering> SceneReader::read_scattering(const Node& node, const std::string& label) {
    auto profile =
        parse_scattering_profile(node, label + "scattering_profile", scene_.path.parent_path(), diagnostics_);
    if (!profile) return std::nullopt;
    const Rgb d_mm = profile->fitted_d_mm();
    return Scattering{glm::dvec3(d_mm[0], d_mm[1], d_mm[2]) * 1e-3, std::move(*profile)};
}

void SceneReader::read_materials(const Node& node) {
    for (const Member& member : node.members) {
        const std::string label = "materials." + member.key + ".";
        ObjectReader reader(member.value, "the material '" + member.key + "'", diagnostics_);
        FieldReader fields(reader, label, diagnostics_);
        Material material;
        material.name = member.key;
        read_albedo(reader, fields, label, material);
        material.roughness = fields.number(material_block(), "roughness");
        material.specular = fields.number(material_block(), "specular");
        material.emission = fields.vec3(material_block(), "emission");
        if (const Node* scattering = reader.any("scattering_profile"))
            material.scattering = read_scattering(*scattering, label);
        reader.finish();
        materials_[member.key] = int(scene_.materials.size());
        scene_.materials.push_back(std::move(material));
    }
}

std::optional<Mesh> SceneReader::read_height_field(const Node& node, const std::string& label) {
    ObjectReader reader(node, "the height field", diagnostics_);
    FieldReader fields(reader, label + "height_field.", diagnostics_);
    const glm::dvec2 size_m = fields.vec2(height_field_block(), "size");
    const int segments = fields.integer(height_field_block(), "segments");
    std::vector<Wave> waves;
    if (const Node* list = reader.array("waves"))
        for (const Node& item : list->items) {
            ObjectReader wave_reader(item, "the wave", diagnostics_);
            FieldReader wave(wave_reader, label + "height_field.", diagnostics_);
            const double amplitude_m = wave.number(wave_block(), "amplitude");
            const glm::dvec2 cycles_per_m = wave.vec2(wave_block(), "cycles");
            waves.push_back({amplitude_m, cycles_per_m, glm::radians(wave.number(wave_block(), "phase"))});
            wave_reader.finish();
        }
    reader.finish();
    if (diagnostics_.has_errors()) return std::nullopt;
    return make_height_field(size_m, waves, segments);
}

void SceneReader::read_meshes(const Node& node) {
    for (const Member& member : node.members) {
        ObjectReader reader(member.value, "the mesh '" + member.key + "'", diagnostics_);
        const auto file = reader.text("file");
        const Node* height_field = reader.object("height_field");
        reader.finish();
        if (bool(file) == bool(height_field)) {
            diagnostics_.error(member.value.place, "a mesh has either a 'file' or a 'height_field'");
            continue;
        }
        std::optional<Mesh> mesh;
        if (height_field) mesh = read_height_field(*height_field, "meshes." + member.key + ".");
        else try {
                mesh = read_gltf(scene_.path.parent_path() / *file);
            } catch (const Error& error) {
                diagnostics_.error(member.value.find("file")->place, error.what());
            }
        // A mesh that is not usable keeps its name, so that the objects that use it are no faults too.
        meshes_[member.key] = int(scene_.meshes.size());
        scene_.meshes.push_back(mesh ? std::move(*mesh) : Mesh{});
    }
}

std::optional<Scene> parse_scene(const Node& node, Diagnostics& diagnostics) {
    Scene scene;
    scene.path = node.place.file;
    const int errors_before = diagnostics.error_count();
    SceneReader(scene, diagnostics).read(node);
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return scene;
}

std::optional<Scene> read_scene(const std::filesystem::path& path, Diagnostics& diagnostics) {
    const auto node = read_document(path, diagnostics);
    if (!node) return std::nullopt;
    return parse_scene(*node, diagnostics);
}

}  // namespace aftershade::scene
