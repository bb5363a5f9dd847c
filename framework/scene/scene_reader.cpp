#include "framework/scene/scene_reader.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "framework/base/error.h"
#include "framework/capture/frame_range.h"
#include "framework/scene/gltf_model.h"
#include "framework/scene/scene_reader_internal.h"

namespace aftershade::scene {

std::optional<int> SceneReader::find_name(const grammar::Reader& reader, const std::string& key,
                                          const std::string& what, const std::map<std::string, int>& names) {
    if (!reader.has(key)) return std::nullopt;
    const std::string name = reader.text(key);
    if (const auto found = names.find(name); found != names.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [other, index] : names) known.push_back(other);
    diagnostics_.error(reader.place(key), "there is no " + what + " '" + name + "'" +
                                              (known.empty() ? "" : did_you_mean(name, known)));
    return std::nullopt;
}

void SceneReader::read(const Node& node) {
    grammar::check(node, scene_block(), diagnostics_);
    if (!node.is_object()) return;
    const grammar::Reader reader(node, scene_block());
    scene_.summary = reader.text("summary");
    const glm::dvec2 size_px = vec2(reader, "size");
    scene_.width_px = int(size_px.x);
    scene_.height_px = int(size_px.y);
    scene_.fps = number(reader, "fps");
    scene_.background = vec3(reader, "background");
    scene_.ambient = vec3(reader, "ambient");
    scene_.ambient_rays = integer(reader, "ambient_rays");
    read_frames(reader);
    if (const auto camera = reader.object("camera")) read_camera(*camera);
    if (const auto shutter = reader.object("shutter")) read_shutter(*shutter);
    for (const auto& [member, material] : reader.named("materials")) read_material(member->key, material);
    std::set<std::string> with_materials;  // meshes whose own materials some objects have
    for (const grammar::Reader& object : reader.objects("objects"))
        if (object.kind() == "mesh" && !object.has("material")) with_materials.insert(object.text("mesh"));
    for (const auto& [member, mesh] : reader.named("meshes"))
        read_mesh(member->key, mesh, with_materials.contains(member->key));
    for (const grammar::Reader& object : reader.objects("objects")) read_object(object);
    if (scene_.objects.size() > kMaxObjects)
        diagnostics_.error(
            reader.place("objects"),
            std::to_string(scene_.objects.size()) + " objects are more than " + std::to_string(kMaxObjects));
    for (const grammar::Reader& light : reader.objects("lights")) read_light(light);
    give_default_material();
}

/// To objects without one, and where there is none at all.
void SceneReader::give_default_material() {
    const auto needs_one = [](const Object& object) { return object.material < 0; };
    const bool any = std::any_of(scene_.objects.begin(), scene_.objects.end(), needs_one);
    if (any || scene_.materials.empty()) scene_.materials.emplace_back();
    for (Object& object : scene_.objects)
        if (needs_one(object)) object.material = int(scene_.materials.size()) - 1;
}

void SceneReader::read_frames(const grammar::Reader& reader) {
    if (const Node* frames = reader.find("frames"))
        scene_.frames =
            *parse_frame_range(frames->is_string() ? frames->string : std::to_string(frames->integer));
    if (const Node* cuts = reader.find("cuts"))
        for (const Node& cut : cuts->items) scene_.cuts.push_back(int(cut.integer));
    std::sort(scene_.cuts.begin(), scene_.cuts.end());
}

void SceneReader::read_camera(const grammar::Reader& reader) {
    SceneCamera& camera = scene_.camera;
    camera.position_m = animated_vec3(reader, "position");
    camera.target_m = animated_vec3(reader, "target");
    camera.roll_deg = animated_number(reader, "roll");
    camera.focal_length_mm = animated_number(reader, "focal_length");
    camera.sensor_width_mm = number(reader, "sensor_width");
    camera.focus_distance_m = animated_number(reader, "focus_distance");
    camera.f_number = number(reader, "f_number");
    camera.blades = integer(reader, "blades");
    camera.rotation_deg = number(reader, "rotation");
}

void SceneReader::read_shutter(const grammar::Reader& reader) {
    scene_.camera.shutter_angle_deg = number(reader, "angle");
    const std::string phase = reader.text("phase");
    scene_.camera.shutter_phase = phase == "start" ? ShutterPhase::start
                                  : phase == "end" ? ShutterPhase::end
                                                   : ShutterPhase::center;
}

void SceneReader::read_material(const std::string& name, const grammar::Reader& reader) {
    Material material;
    material.name = name;
    if (const auto checker = reader.object("albedo")) {
        material.checker_cells = vec2(*checker, "cells");
        const auto colors = checker->component_list("checker");
        if (colors.size() == 2) {
            material.albedo = {colors[0][0], colors[0][1], colors[0][2]};
            material.albedo_2 = {colors[1][0], colors[1][1], colors[1][2]};
        }
    } else if (reader.has("albedo")) {
        material.albedo = material.albedo_2 = vec3(reader, "albedo");
    }
    material.roughness = number(reader, "roughness");
    material.specular = number(reader, "specular");
    material.emission = vec3(reader, "emission");
    material.opacity = number(reader, "opacity");
    if (const Node* scattering = reader.find("scattering_profile"))
        if (auto profile = parse_scattering_profile(*scattering, "materials." + name + ".scattering_profile",
                                                    scene_.path.parent_path(), diagnostics_)) {
            const Rgb d_mm = profile->fitted_d_mm();
            material.scattering =
                Scattering{glm::dvec3(d_mm[0], d_mm[1], d_mm[2]) * 1e-3, std::move(*profile)};
        }
    materials_[name] = int(scene_.materials.size());
    scene_.materials.push_back(std::move(material));
}

std::optional<Mesh> SceneReader::read_height_field(const grammar::Reader& reader) {
    std::vector<Wave> waves;
    for (const grammar::Reader& wave : reader.objects("waves"))
        waves.push_back(
            {number(wave, "amplitude"), vec2(wave, "cycles"), glm::radians(number(wave, "phase"))});
    if (diagnostics_.has_errors()) return std::nullopt;
    return make_height_field(vec2(reader, "size"), waves, integer(reader, "segments"));
}

/// The file's mesh; its materials become the scene's.
Mesh SceneReader::read_model(const grammar::Reader& reader, const std::filesystem::path& path) {
    GltfModel model = read_gltf_model(path);
    for (const std::string& warning : model.warnings) diagnostics_.warning(reader.place("file"), warning);
    const int first = int(scene_.materials.size());
    for (int& material : model.mesh.materials)
        if (material >= 0) material += first;
    for (Material& material : model.materials) scene_.materials.push_back(std::move(material));
    return std::move(model.mesh);
}

void SceneReader::read_mesh(const std::string& name, const grammar::Reader& reader, bool with_materials) {
    std::optional<Mesh> mesh;
    if (const auto height_field = reader.object("height_field")) mesh = read_height_field(*height_field);
    else if (reader.has("file")) try {
            const std::filesystem::path path = scene_.path.parent_path() / reader.text("file");
            mesh = with_materials ? read_model(reader, path) : read_gltf(path);
        } catch (const Error& error) {
            diagnostics_.error(reader.place("file"), error.what());
        }
    // A mesh that is not usable keeps its name, so that the objects that use it are no faults too.
    meshes_[name] = int(scene_.meshes.size());
    scene_.meshes.push_back(mesh ? std::move(*mesh) : Mesh{});
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
