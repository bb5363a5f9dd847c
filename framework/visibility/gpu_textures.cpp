#include "framework/visibility/gpu_textures.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <map>

#include "framework/base/error.h"
#include "framework/base/option.h"

namespace aftershade::visibility {

using glm::vec4;
using scene::SurfaceTexture;

namespace {

constexpr std::uint32_t kNoMap = 0xffffffff;  // as textures.glsl has it
constexpr std::size_t kMaterialWords = 24;
static_assert(sizeof(GpuObject) == 8 * sizeof(std::uint32_t), "as world.glsl has it");

static_assert(int(scene::TextureWrap::repeat) == 0 && int(scene::TextureWrap::mirror) == 1 &&
                  int(scene::TexelValues::srgb) == 1 && int(scene::TexelValues::normal) == 2,
              "as textures.glsl has them");

bool has_alpha(const scene::Material& material) {
    return material.blends || material.alpha_cutoff > 0;
}

/// Writes textures behind what is there, each once.
class Textures {
public:
    explicit Textures(std::vector<std::uint32_t>& words) : words_(words) {}

    std::uint32_t map_of(const scene::MaterialMap& map) {
        if (!map) return kNoMap;
        const auto [entry, is_new] = first_.try_emplace(map.texture.get(), std::uint32_t(words_.size()));
        if (is_new) {
            const SurfaceTexture& texture = *map.texture;
            const SurfaceTexture::Level& finest = texture.levels().front();
            const scene::TextureSampling& sampling = texture.sampling();
            words_.push_back(std::uint32_t(finest.size.x));
            words_.push_back(std::uint32_t(finest.size.y));
            words_.push_back(std::uint32_t(texture.levels().size()));
            words_.push_back(std::uint32_t(sampling.wrap_u) | std::uint32_t(sampling.wrap_v) << 2 |
                             std::uint32_t(texture.values()) << 4 | (sampling.nearest ? 64u : 0u) |
                             (sampling.by_alpha ? 128u : 0u));
            words_.insert(words_.end(), texture.texels().begin(), texture.texels().end());
        }
        return entry->second << 3 | std::uint32_t(map.channel);
    }

private:
    std::vector<std::uint32_t>& words_;
    std::map<const SurfaceTexture*, std::uint32_t> first_;
};

/// As world.glsl has it.
std::vector<std::uint32_t> words_of(const scene::Material& material, Textures& textures, bool light) {
    const scene::MaterialMaps& maps = material.maps;
    std::vector<std::uint32_t> words;
    for (const vec4& row :
         {with(material.albedo, material.roughness), with(material.albedo_2, material.specular),
          with(material.emission, material.metallic),
          vec4(glm::vec2(material.checker_cells), maps.normal_scale, maps.occlusion_strength)})
        for (int i = 0; i < 4; ++i) words.push_back(std::bit_cast<std::uint32_t>(row[i]));
    words.push_back(light || has_alpha(material) ? textures.map_of(maps.base_color) : kNoMap);
    for (const scene::MaterialMap* map :
         {&maps.emission, &maps.metallic_roughness, &maps.occlusion, &maps.normal})
        words.push_back(light ? textures.map_of(*map) : kNoMap);
    words.push_back(std::bit_cast<std::uint32_t>(float(material.alpha_cutoff)));
    words.push_back(material.blends ? 1 : 0);
    words.push_back(std::bit_cast<std::uint32_t>(float(material.opacity)));
    return words;
}

/// The tangents of a triangle's corners.
void add_tangents(std::vector<vec4>& values, const scene::Mesh& mesh, std::uint32_t triangle,
                  const glm::dmat3& linear) {
    for (const std::uint32_t vertex : mesh.triangles[triangle]) {
        const glm::dvec4 tangent = mesh.tangents.empty() ? glm::dvec4(0) : mesh.tangents[vertex];
        values.push_back(with(linear * glm::dvec3(tangent), tangent.w));
    }
}

}  // namespace

GpuLooks gpu_looks(const scene::Scene& scene, std::span<const GpuObject> objects, bool light,
                   std::size_t max_bytes) {
    GpuLooks result;
    for (const GpuObject& object : objects) {
        const auto words = std::bit_cast<std::array<std::uint32_t, 8>>(object);
        result.words.insert(result.words.end(), words.begin(), words.end());
    }
    result.materials_at = std::uint32_t(result.words.size());
    result.words.resize(result.words.size() + kMaterialWords * scene.materials.size());
    Textures textures(result.words);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const std::vector<std::uint32_t> words = words_of(scene.materials[i], textures, light);
        std::ranges::copy(words,
                          result.words.begin() + std::ptrdiff_t(result.materials_at + kMaterialWords * i));
    }
    if (const std::size_t bytes = result.words.size() * sizeof(std::uint32_t); bytes > max_bytes)
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: textures of {} bytes, the limit of visibility by GL is {}; scale them "
                        "down, or choose {}",
                        scene.path.string(), bytes, max_bytes, spelled(Option::visibility_on, "cpu")));
    return result;
}

GpuExtras gpu_extras(const scene::SceneRenderer& renderer, bool light, const scene::SceneState* world,
                     std::size_t max_bytes) {
    const scene::Scene& scene = renderer.scene();
    const std::vector<std::array<std::uint32_t, 2>> sources = gpu_sources(scene);
    std::size_t channels = 0;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::ObjectAlpha& alpha = renderer.geometry().alpha_of(i);
        if (alpha.has_holes || alpha.is_mixed) channels = std::max(channels, std::size_t(1));
    }
    bool has_tangents = false;
    for (const scene::Material& material : scene.materials) {
        has_tangents = has_tangents || (light && material.maps.normal);
        const int own = has_alpha(material) ? material.maps.base_color.channel : 0;
        if (own > 0) channels = std::max(channels, std::size_t(own) + 1);
    }
    for (const scene::Mesh& mesh : scene.meshes)
        if (light && !mesh.more_uvs.empty()) channels = std::max(channels, mesh.more_uvs.size() + 1);
    GpuExtras result;
    result.uvs_at = has_tangents ? 3 : 0;
    result.stride = result.uvs_at + 2 * std::uint32_t(channels);
    if (const std::size_t bytes = sources.size() * result.stride * sizeof(vec4); bytes > max_bytes)
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: {} bytes of tangents and texture coordinates, the limit of visibility by GL "
                        "is {}; choose {}",
                        scene.path.string(), bytes, max_bytes, spelled(Option::visibility_on, "cpu")));
    if (result.stride == 0) return result;
    for (const auto& [object, triangle] : sources) {
        const scene::Mesh& mesh = scene.meshes[std::size_t(scene.objects[object].shape.mesh)];
        if (has_tangents)
            add_tangents(result.values, mesh, triangle,
                         world ? glm::dmat3(world->world_from_object[object]) : glm::dmat3(1));
        const auto& corner = mesh.triangles[triangle];
        const auto material = std::uint32_t(scene.material_at(int(object), triangle));
        for (int channel = 0; channel < int(channels); ++channel) {
            const bool is_there = channel <= int(mesh.more_uvs.size());
            std::array<glm::vec2, 3> uvs{};
            for (std::size_t i = 0; is_there && i < 3; ++i) uvs[i] = mesh.uv(channel, corner[i]);
            result.values.emplace_back(uvs[0], uvs[1]);
            result.values.emplace_back(uvs[2], std::bit_cast<float>(material), 0);
        }
    }
    return result;
}

}  // namespace aftershade::visibility
