#include "framework/scene/material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace aftershade::scene {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

dvec4 TexturePoint::of(const MaterialMap& map) const {
    if (!map) return dvec4(1);
    std::array<dvec2, 3> uvs{};
    if (mesh)
        for (std::size_t i = 0; i < 3; ++i) uvs[i] = mesh->uv(map.channel, mesh->triangles[triangle][i]);
    const dvec2 own = map.channel == 0 ? uv
                                       : (1 - barycentric.x - barycentric.y) * uvs[0] +
                                             barycentric.x * uvs[1] + barycentric.y * uvs[2];
    return map.texture->at(own, glm::dmat2(uvs[1] - uvs[0], uvs[2] - uvs[0]) * weights_of_pixel);
}

namespace {

/// Before metals take their share.
dvec3 base_color_at(const Material& material, const TexturePoint& at) {
    if (material.maps.base_color) return material.albedo * dvec3(at.of(material.maps.base_color));
    const auto cell = [](double place) { return std::int64_t(std::floor(place)); };
    const bool second =
        ((cell(at.uv.x * material.checker_cells.x) + cell(at.uv.y * material.checker_cells.y)) & 1) != 0;
    return second ? material.albedo_2 : material.albedo;
}

}  // namespace

Finish finish_at(const Material& material, const TexturePoint& at) {
    const MaterialMaps& maps = material.maps;
    const dvec3 base_color = base_color_at(material, at);
    const dvec3 shares(at.of(maps.metallic_roughness));
    const double metallic = material.metallic * shares.z;
    Finish finish;
    finish.albedo = base_color * (1 - metallic);
    finish.reflectance = glm::mix(dvec3(material.specular), base_color, metallic);
    finish.roughness = std::max(material.roughness * shares.y, kLeastRoughness);
    finish.emission = material.emission * dvec3(at.of(maps.emission));
    finish.ambient += maps.occlusion_strength * (at.of(maps.occlusion).x - 1);
    return finish;
}

dvec3 albedo_at(const Material& material, const TexturePoint& at) {
    const double metallic = material.metallic * at.of(material.maps.metallic_roughness).z;
    return base_color_at(material, at) * (1 - metallic);
}

double opacity_at(const Material& material, const TexturePoint& at) {
    return material.blends ? material.opacity * at.of(material.maps.base_color).w : material.opacity;
}

bool is_hole(const Material& material, TexturePoint at) {
    if (material.alpha_cutoff <= 0) return false;
    at.weights_of_pixel = glm::dmat2(0);
    return at.of(material.maps.base_color).w < material.alpha_cutoff;
}

}  // namespace aftershade::scene
