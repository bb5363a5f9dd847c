// Takes a scene document apart; for the sources of this folder.
#pragma once

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
    void read_frames(ObjectReader& reader);
    void read_camera(const Node& node);
    void read_shutter(const Node& node);
    void read_materials(const Node& node);
    void read_albedo(ObjectReader& reader, FieldReader& fields, const std::string& label, Material& material);
    void read_checker(const Node& node, FieldReader& fields, const std::string& label, Material& material);
    std::optional<Scattering> read_scattering(const Node& node, const std::string& label);
    void read_meshes(const Node& node);
    std::optional<Mesh> read_height_field(const Node& node, const std::string& label);

    void read_objects(const Node& node);
    void read_object(const Node& node, std::size_t index);
    Shape read_shape(ObjectReader& reader, FieldReader& fields);
    void add_repeated(const Object& object, const Node& node, const std::string& label);
    void read_lights(const Node& node);
    void read_light(const Node& node, std::size_t index);
    LightPattern read_pattern(const Node& node, const std::string& label);

    /// The index of a name in `names`, or nullopt and an error that lists them.
    std::optional<int> find_name(const Node& node, const std::string& what,
                                 const std::map<std::string, int>& names);

    Scene& scene_;
    Diagnostics& diagnostics_;
    std::map<std::string, int> materials_;
    std::map<std::string, int> meshes_;
    std::map<std::string, int> objects_;
};

}  // namespace aftershade::scene
