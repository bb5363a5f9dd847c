#include "framework/visibility/gpu_textures.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>

#include "framework/base/error.h"
#include "framework/base/option.h"

namespace aftershade::visibility {

using glm::vec4;
using scene::SurfaceTexture;

namespace {

constexpr std::uint32_t kNoMap = 0xffffffff;  // as textures.glsl has it

static_assert(int(scene::TextureWrap::repeat) == 0 && int(scene::TextureWrap::mirror) == 1 &&
                  int(scene::TexelValues::srgb) == 1 && int(scene::TexelValues::normal) == 2,
              "as textures.glsl has them");

class Textures {
public:
    explicit Textures(std::vector<std::uint32_t>& words) : words_(words) {}

    std::uint32_t index_of(const scene::MaterialMaps::Map& map) {
        if (!map) return kNoMap;
        const auto [entry, is_new] = first_.try_emplace(map.get(), std::uint32_t(words_.size()));
        if (is_new) {
            const SurfaceTexture::Level& finest = map->levels().front();
            const scene::TextureSampling& sampling = map->sampling();
            words_.push_back(std::uint32_t(finest.size.x));
            words_.push_back(std::uint32_t(finest.size.y));
            words_.push_back(std::uint32_t(map->levels().size()));
            words_.push_back(std::uint32_t(sampling.wrap_u) | std::uint32_t(sampling.wrap_v) << 2 |
                             std::uint32_t(map->values()) << 4 | (sampling.nearest ? 64u : 0u));
            words_.insert(words_.end(), map->texels().begin(), map->texels().end());
        }
        return entry->second;
    }

private:
    std::vector<std::uint32_t>& words_;
    std::map<const SurfaceTexture*, std::uint32_t> first_;
};

}  // namespace

GpuMaterials gpu_materials(const scene::Scene& scene, std::size_t max_bytes) {
    GpuMaterials result;
    Textures textures(result.textures);
    for (const scene::Material& material : scene.materials) {
        const scene::MaterialMaps& maps = material.maps;
        result.materials.push_back(
            {vec4(glm::vec3(material.albedo), material.roughness),
             vec4(glm::vec3(material.albedo_2), material.specular),
             vec4(glm::vec3(material.emission), material.metallic),
             vec4(glm::vec2(material.checker_cells), maps.normal_scale, maps.occlusion_strength),
             {textures.index_of(maps.base_color), textures.index_of(maps.emission),
              textures.index_of(maps.metallic_roughness), textures.index_of(maps.occlusion)},
             glm::uvec4(textures.index_of(maps.normal))});
    }
    if (const std::size_t bytes = result.textures.size() * sizeof(std::uint32_t); bytes > max_bytes)
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: textures of {} bytes, the limit of visibility by GL is {}; scale them "
                        "down, or choose {}",
                        scene.path.string(), bytes, max_bytes, spelled(Option::visibility_on, "cpu")));
    return result;
}

std::vector<vec4> gpu_tangents(const scene::Scene& scene,
                               std::span<const std::array<std::uint32_t, 2>> triangles) {
    const auto is_mapped = [](const scene::Material& material) { return material.maps.normal != nullptr; };
    std::vector<vec4> tangents;
    if (std::none_of(scene.materials.begin(), scene.materials.end(), is_mapped)) return tangents;
    tangents.reserve(3 * triangles.size());
    for (const auto& [object, triangle] : triangles) {
        const scene::Mesh& mesh = scene.meshes[std::size_t(scene.objects[object].shape.mesh)];
        for (const std::uint32_t vertex : mesh.triangles[triangle])
            tangents.push_back(mesh.tangents.empty() ? vec4(0) : vec4(mesh.tangents[vertex]));
    }
    return tangents;
}

}  // namespace aftershade::visibility
