// Materials at a point: the twin of scene::finish_at() and of World::mapped_normal().
struct Material {
    vec4 albedo;         // w: roughness
    vec4 albedo_2;       // w: specular
    vec4 emission;       // w: metallic
    vec4 checker_cells;  // xy; z: scale of the normal map, w: strength of occlusion
    uvec4 maps;          // indices into Textures: base colour, emission, metallic and roughness, occlusion
    uvec4 normal_map;    // x
};
struct Finish {
    vec3 albedo;
    vec3 reflectance;
    vec3 emission;
    float roughness;
    float ambient;  // share of the ambient light
};

layout(std430, binding = 4) readonly buffer Materials { Material materials[]; };
layout(std430, binding = 10) readonly buffer Tangents { vec4 tangents[]; };  // of the corners of each triangle, if any has a normal map

// As scene::kLeastRoughness.
const float kLeastRoughness = 0.03;

bool has_maps(Material material) {
    return any(notEqual(material.maps, uvec4(kNoMap))) || material.normal_map.x != kNoMap;
}

vec3 base_color_at(Material material, vec2 uv, mat2 uv_of_pixel) {
    if (material.maps.x != kNoMap) return material.albedo.rgb * map_at(material.maps.x, uv, uv_of_pixel);
    ivec2 square = ivec2(floor(uv * material.checker_cells.xy));
    return ((square.x + square.y) & 1) != 0 ? material.albedo_2.rgb : material.albedo.rgb;
}

vec3 metallic_roughness_at(Material material, vec2 uv, mat2 uv_of_pixel) {
    return material.maps.z != kNoMap ? map_at(material.maps.z, uv, uv_of_pixel) : vec3(1.0);
}

vec3 albedo_at(Material material, vec2 uv, mat2 uv_of_pixel) {
    vec3 base_color = base_color_at(material, uv, uv_of_pixel);
    if (material.emission.w <= 0.0) return base_color;
    return base_color * (1.0 - material.emission.w * metallic_roughness_at(material, uv, uv_of_pixel).z);
}

Finish finish_at(Material material, vec2 uv, mat2 uv_of_pixel) {
    vec3 base_color = base_color_at(material, uv, uv_of_pixel), shares = metallic_roughness_at(material, uv, uv_of_pixel);
    float metallic = material.emission.w * shares.z;
    Finish finish;
    finish.albedo = base_color * (1.0 - metallic);
    finish.reflectance = mix(vec3(material.albedo_2.w), base_color, metallic);
    finish.roughness = max(material.albedo.w * shares.y, kLeastRoughness);
    finish.emission = material.emission.rgb;
    if (material.maps.y != kNoMap) finish.emission *= map_at(material.maps.y, uv, uv_of_pixel);
    finish.ambient = 1.0;
    if (material.maps.w != kNoMap) finish.ambient += material.checker_cells.w * (map_at(material.maps.w, uv, uv_of_pixel).x - 1.0);
    return finish;
}

// The object's tangent of a point of triangle `index`; w: the sign of the bitangent.
vec4 tangent_at(uint index, vec3 weights) {
    return vec4(mat3(tangents[3u * index].xyz, tangents[3u * index + 1u].xyz, tangents[3u * index + 2u].xyz) * weights, tangents[3u * index].w);
}

// `normal`: outwards, of unit length; `along`: the tangent in its space.
vec3 mapped_normal(Material material, vec2 uv, mat2 uv_of_pixel, vec3 normal, vec3 along, float side) {
    vec3 texel = map_at(material.normal_map.x, uv, uv_of_pixel);
    along -= dot(along, normal) * normal;
    if (texel.xy == vec2(0.0) || !(length(along) > 0.0)) return normal;
    along = normalize(along);
    vec3 bent = material.checker_cells.z * (texel.x * along + texel.y * side * cross(normal, along)) + texel.z * normal;
    return length(bent) > 0.0 ? normalize(bent) : normal;
}
