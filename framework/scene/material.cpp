#include "framework/scene/material.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace aftershade::scene {

using glm::dmat2;
using glm::dvec2;
using glm::dvec3;

namespace {

/// Before metals take their share.
dvec3 base_color_at(const Material& material, const dvec2& uv, const dmat2& uv_of_pixel) {
    if (material.maps.base_color) return material.albedo * material.maps.base_color->at(uv, uv_of_pixel);
    const auto cell = [](double at) { return std::int64_t(std::floor(at)); };
    const bool second =
        ((cell(uv.x * material.checker_cells.x) + cell(uv.y * material.checker_cells.y)) & 1) != 0;
    return second ? material.albedo_2 : material.albedo;
}

/// y: the share of roughness, z: that of metallic.
dvec3 metallic_roughness_at(const Material& material, const dvec2& uv, const dmat2& uv_of_pixel) {
    const auto& map = material.maps.metallic_roughness;
    return map ? map->at(uv, uv_of_pixel) : dvec3(1);
}

}  // namespace

Finish finish_at(const Material& material, const dvec2& uv, const dmat2& uv_of_pixel) {
    const dvec3 base_color = base_color_at(material, uv, uv_of_pixel);
    const dvec3 shares = metallic_roughness_at(material, uv, uv_of_pixel);
    const double metallic = material.metallic * shares.z;
    Finish finish;
    finish.albedo = base_color * (1 - metallic);
    finish.reflectance = glm::mix(dvec3(material.specular), base_color, metallic);
    finish.roughness = std::max(material.roughness * shares.y, kLeastRoughness);
    finish.emission = material.emission;
    if (const auto& map = material.maps.emission) finish.emission *= map->at(uv, uv_of_pixel);
    if (const auto& map = material.maps.occlusion)
        finish.ambient += material.maps.occlusion_strength * (map->at(uv, uv_of_pixel).x - 1);
    return finish;
}

dvec3 albedo_at(const Material& material, const dvec2& uv, const dmat2& uv_of_pixel) {
    const double metallic = material.metallic * metallic_roughness_at(material, uv, uv_of_pixel).z;
    return base_color_at(material, uv, uv_of_pixel) * (1 - metallic);
}

}  // namespace aftershade::scene
