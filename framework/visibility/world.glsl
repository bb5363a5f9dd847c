// The scene as all shaders of this folder read it: few buffers, since GL promises eight to a shader.
layout(std430, binding = 0) readonly buffer Meshes { vec4 meshes[]; };  // nodes of two, then from triangles_at triangles of three
layout(std430, binding = 1) readonly buffer Moving { vec4 moving[]; };  // objects of a moment side by side; the top's nodes; lights
layout(std430, binding = 4) readonly buffer Looks { uint looks[]; };    // objects of eight, materials of 24, textures
layout(std430, binding = 5) readonly buffer Extras { vec4 extras[]; };  // of each triangle of each object, if any needs them
layout(std140, binding = 1) uniform World {
    uint triangles_at;
    uint object_count;
    uint top_at;
    uint top_count;
    uint lights_at;
    uint materials_at;
    uint extras_stride;
    uint extras_uvs;  // of a triangle's extras: its corners' texture coordinates, two for each channel
};

struct Triangle {
    vec4 corner;     // m; w: the triangle's number in its mesh, as bits
    vec4 to_second;
    vec4 to_third;
};
struct Object {
    uint first_node;
    uint node_count;
    uint first_triangle;  // of its mesh, as the leaves order them
    uint first_surface;   // of its triangles among those of all objects
    float opacity;        // unless it is mixed
    bool casts_shadow;
    bool has_holes;
    bool is_mixed;        // opacity goes by the triangle or by a texture
};
struct Material {
    vec4 albedo;         // w: roughness
    vec4 albedo_2;       // w: specular
    vec4 emission;       // w: metallic
    vec4 checker_cells;  // xy; z: scale of the normal map, w: strength of occlusion
    uvec4 maps;          // base colour, emission, metallic and roughness, occlusion: as textures.glsl has them
    uint normal_map;
    float alpha_cutoff;
    bool blends;         // the opacity times the base colour's alpha
    float opacity;
};

Triangle triangle_at(uint index) {
    uint at = triangles_at + 3u * index;
    return Triangle(meshes[at], meshes[at + 1u], meshes[at + 2u]);
}

Object object_at(uint index) {
    uint at = 8u * index, flags = looks[at + 5u];
    return Object(looks[at], looks[at + 1u], looks[at + 2u], looks[at + 3u], uintBitsToFloat(looks[at + 4u]), (flags & 1u) != 0u, (flags & 2u) != 0u,
                  (flags & 4u) != 0u);
}

uvec4 four_looks(uint at) {
    return uvec4(looks[at], looks[at + 1u], looks[at + 2u], looks[at + 3u]);
}

Material material_at(uint index) {
    uint at = materials_at + 24u * index;
    return Material(uintBitsToFloat(four_looks(at)), uintBitsToFloat(four_looks(at + 4u)), uintBitsToFloat(four_looks(at + 8u)),
                    uintBitsToFloat(four_looks(at + 12u)), four_looks(at + 16u), looks[at + 20u], uintBitsToFloat(looks[at + 21u]), looks[at + 22u] != 0u,
                    uintBitsToFloat(looks[at + 23u]));
}
