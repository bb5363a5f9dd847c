// What a surface does with light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

#include "framework/scattering/scattering_profile.h"
#include "framework/scene/mesh.h"
#include "framework/scene/surface_texture.h"

namespace aftershade::scene {

/// How light goes under the surface: Burley's normalized diffusion with d_m (Christensen and Burley 2015),
/// unless the profile is of another type; then d_m is of Burley's with the same mean square distance.
struct Scattering {
    glm::dvec3 d_m{0};
    ScatteringProfile profile = {};
};

/// A texture, by the texture coordinates of a channel of its mesh; null: none.
struct MaterialMap {
    std::shared_ptr<const SurfaceTexture> texture;
    int channel = 0;
    explicit operator bool() const { return texture != nullptr; }
};

/// Textures as glTF 2.0 has them (3.9).
struct MaterialMaps {
    using Map = MaterialMap;
    Map base_color;           ///< times the albedo; its alpha: as Material says
    Map emission;             ///< times the emission
    Map metallic_roughness;   ///< green times the roughness, blue times metallic
    Map occlusion;            ///< red: the share of the ambient light that comes here
    Map normal;               ///< in the frame of Mesh::tangents
    double normal_scale = 1;  ///< of the normal's x and y
    double occlusion_strength = 1;

    bool any() const {
        for (const Map* map : {&base_color, &emission, &metallic_roughness, &occlusion, &normal})
            if (*map) return true;
        return false;
    }
};

struct Material {
    std::string name;
    glm::dvec3 albedo{0.8};
    glm::dvec3 albedo_2{0.8};     ///< of every second square where there are cells
    glm::dvec2 checker_cells{0};  ///< squares along u and v; 0: none
    double roughness = 0.5;       ///< GGX alpha is its square
    double specular = 0.04;       ///< reflectance at normal incidence; 0: none
    double metallic = 0;          ///< share of the albedo that reflects as a mirror does instead
    glm::dvec3 emission{0};       ///< radiance
    double opacity = 1;           ///< share of the light that the surface stops; the rest continues unbent
    bool blends = false;          ///< the opacity is multiplied by the base colour's alpha
    double alpha_cutoff = 0;  ///< where the base colour's alpha, 1 without a map, is below, there is a hole
    std::optional<Scattering> scattering;
    MaterialMaps maps;

    bool is_transparent() const { return opacity < 1 || blends; }
};

/// A point of a surface, for its textures.
struct TexturePoint {
    glm::dvec2 uv{0};            ///< channel 0
    const Mesh* mesh = nullptr;  ///< null: a shape, which has no other channel and no textures
    std::uint32_t triangle = 0;
    glm::dvec2 barycentric{0};       ///< weights of the second and third corner
    glm::dmat2 weights_of_pixel{0};  ///< a pixel's two sides, in these weights; 0: textures are not filtered

    /// RGB and alpha; 1 without a map.
    glm::dvec4 of(const MaterialMap& map) const;
};

/// A material at one point.
struct Finish {
    glm::dvec3 albedo{0};
    glm::dvec3 reflectance{0};  ///< of the highlight, at normal incidence
    double roughness = 1;
    glm::dvec3 emission{0};
    double ambient = 1;  ///< share of the ambient light
};

/// A smoother surface has a highlight that no pixel's ray meets.
inline constexpr double kLeastRoughness = 0.03;

Finish finish_at(const Material& material, const TexturePoint& at);
/// The albedo alone.
glm::dvec3 albedo_at(const Material& material, const TexturePoint& at);
double opacity_at(const Material& material, const TexturePoint& at);
/// Whether the surface has a hole there. Its alpha is not filtered, so that a hole's edge is sharp from
/// everywhere.
bool is_hole(const Material& material, TexturePoint at);

}  // namespace aftershade::scene
