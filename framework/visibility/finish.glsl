// Materials at a point: the twin of scene::finish_at() and of World::mapped_normal().
struct Finish {
    vec3 albedo;
    vec3 reflectance;
    vec3 emission;
    float roughness;
    float ambient;  // share of the ambient light
};

// As scene::kLeastRoughness.
const float kLeastRoughness = 0.03;

bool has_maps(Material material) {
    return any(notEqual(material.maps, uvec4(kNoMap))) || material.normal_map != kNoMap;
}

vec3 base_color_at(Material material, TexturePoint at) {
    if (material.maps.x != kNoMap) return material.albedo.rgb * map_at(material.maps.x, at).rgb;
    ivec2 square = ivec2(floor(at.uv * material.checker_cells.xy));
    return ((square.x + square.y) & 1) != 0 ? material.albedo_2.rgb : material.albedo.rgb;
}

vec3 albedo_at(Material material, TexturePoint at) {
    vec3 base_color = base_color_at(material, at);
    if (material.emission.w <= 0.0) return base_color;
    return base_color * (1.0 - material.emission.w * map_at(material.maps.z, at).z);
}

Finish finish_at(Material material, TexturePoint at) {
    vec3 base_color = base_color_at(material, at), shares = map_at(material.maps.z, at).rgb;
    float metallic = material.emission.w * shares.z;
    Finish finish;
    finish.albedo = base_color * (1.0 - metallic);
    finish.reflectance = mix(vec3(material.albedo_2.w), base_color, metallic);
    finish.roughness = max(material.albedo.w * shares.y, kLeastRoughness);
    finish.emission = material.emission.rgb * map_at(material.maps.y, at).rgb;
    finish.ambient = 1.0 + material.checker_cells.w * (map_at(material.maps.w, at).x - 1.0);
    return finish;
}

// The tangent of a point of a triangle; w: the sign of the bitangent.
vec4 tangent_at(TexturePoint at) {
    uint first = at.surface * extras_stride;
    return vec4(mat3(extras[first].xyz, extras[first + 1u].xyz, extras[first + 2u].xyz) * at.weights, extras[first].w);
}

// `normal`: outwards, of unit length; `along`: the tangent in its space.
vec3 mapped_normal(Material material, TexturePoint at, vec3 normal, vec3 along, float side) {
    vec3 texel = map_at(material.normal_map, at).xyz;
    along -= dot(along, normal) * normal;
    if (texel.xy == vec2(0.0) || !(length(along) > 0.0)) return normal;
    along = normalize(along);
    vec3 bent = material.checker_cells.z * (texel.x * along + texel.y * side * cross(normal, along)) + texel.z * normal;
    return length(bent) > 0.0 ? normalize(bent) : normal;
}
