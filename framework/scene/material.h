// What a surface does with light.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

#include "framework/scattering/scattering_profile.h"
#include "framework/scene/surface_texture.h"

namespace aftershade::scene {

/// How light goes under the surface: Burley's normalized diffusion with d_m (Christensen and Burley 2015),
/// unless the profile is of another type; then d_m is of Burley's with the same mean square distance.
struct Scattering {
    glm::dvec3 d_m{0};
    ScatteringProfile profile = {};
};

/// Textures as glTF 2.0 has them (3.9); null: none.
struct MaterialMaps {
    using Map = std::shared_ptr<const SurfaceTexture>;
    Map base_color;           ///< times the albedo
    Map emission;             ///< times the emission
    Map metallic_roughness;   ///< green times the roughness, blue times metallic
    Map occlusion;            ///< red: the share of the ambient light that comes here
    Map normal;               ///< in the frame of Mesh::tangents
    double normal_scale = 1;  ///< of the normal's x and y
    double occlusion_strength = 1;

    bool any() const { return base_color || emission || metallic_roughness || occlusion || normal; }
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
    std::optional<Scattering> scattering;
    MaterialMaps maps;
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

/// `uv_of_pixel` as SurfaceTexture::at() has it.
Finish finish_at(const Material& material, const glm::dvec2& uv, const glm::dmat2& uv_of_pixel);
/// The albedo alone.
glm::dvec3 albedo_at(const Material& material, const glm::dvec2& uv, const glm::dmat2& uv_of_pixel);

}  // namespace aftershade::scene
