// Takes a scene document apart; for the sources of this folder.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/scene/fields.h"
#include "framework/scene/scene.h"

namespace aftershade::scene {

class SceneReader {
public:
    SceneReader(Scene& scene, Diagnostics& diagnostics) : scene_(scene), diagnostics_(diagnostics) {}

    void read(const Node& node);

private:
    void read_frames(const grammar::Reader& reader);
    void read_camera(const grammar::Reader& reader);
    void read_shutter(const grammar::Reader& reader);
    void read_material(const std::string& name, const grammar::Reader& reader);
    void read_mesh(const std::string& name, const grammar::Reader& reader, bool with_materials);
    Mesh read_model(const grammar::Reader& reader, const std::filesystem::path& path);
    void give_default_material();
    std::optional<Mesh> read_height_field(const grammar::Reader& reader);

    void read_object(const grammar::Reader& reader);
    Shape read_shape(const grammar::Reader& reader);
    void add_repeated(const Object& object, const grammar::Reader& reader, const std::string& label);
    void read_light(const grammar::Reader& reader);

    /// The index of the name that the key gives, or nullopt and an error that lists the known names.
    std::optional<int> find_name(const grammar::Reader& reader, const std::string& key,
                                 const std::string& what, const std::map<std::string, int>& names);

    Scene& scene_;
    Diagnostics& diagnostics_;
    std::map<std::string, int> materials_;
    std::map<std::string, int> meshes_;
    std::map<std::string, int> objects_;
};

}  // namespace aftershade::scene
