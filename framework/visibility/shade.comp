// Light at shading samples, at the frame's own time: the twin of scene::ShadingGrids::shade() in single precision.
struct Surface {
    vec4 corner;          // world, m; w: material, as bits
    vec4 to_second;       // w: v of the first corner
    vec4 to_third;        // w: v of the second
    vec4 normals[3];      // of the corners, world, of any length; w: their u
    vec4 px_from_cells;   // columns
    vec4 grid;            // xy: low corner, in cells; z: columns, as bits; w: v of the third
};
layout(std430, binding = 2) readonly buffer Ids { uint ids[]; };  // the first cell of each surface; then the shading samples
layout(std430, binding = 3) readonly buffer Surfaces { Surface surfaces[]; };
layout(std430, binding = 6) writeonly buffer Shaded { vec4 shaded[]; };
layout(std140, binding = 0) uniform Settings {
    mat4 world_from_camera;
    vec4 ambient;  // w: rays that seek what hides it
    vec2 size_px;
    float px_per_tangent;
    uint id_count;
    uint surface_count;
    uint light_count;
};

// Places of a cell a side whose mean albedo counts, as ShadingGrids::kAlbedoPoints.
const int kAlbedoPoints = 4;

// The last surface whose cells begin at or before `cell`.
uint surface_of(uint cell) {
    uint low = 0u, high = surface_count;
    for (int step = 0; step < 32 && low + 1u < high; ++step) {
        uint middle = (low + high) / 2u;
        if (ids[middle] <= cell) low = middle;
        else high = middle;
    }
    return low;
}

// Weights of the second and third corner where the pinhole camera sees a place of the grid.
vec2 weights_at(Surface at, vec2 place) {
    vec2 tangent = (mat2(at.px_from_cells) * place - 0.5 * size_px) / px_per_tangent;
    vec3 direction = mat3(world_from_camera) * vec3(tangent.x, -tangent.y, -1.0);
    return on_plane(at.corner.xyz, at.to_second.xyz, at.to_third.xyz, world_from_camera[3].xyz, direction).yz;
}

mat3x2 uvs_of(Surface at) {
    return mat3x2(at.normals[0].w, at.to_second.w, at.normals[1].w, at.to_third.w, at.normals[2].w, at.grid.w);
}

// Where a ray runs along the plane, its middle; as barycentric_on_plane() of the CPU.
vec2 finite_weights(Surface at, vec2 place) {
    vec2 on = weights_at(at, place);
    return any(isnan(on)) || any(isinf(on)) ? vec2(1.0 / 3.0) : on;
}

// The sides of the cell whose corner is `corner`, in weights.
mat2 weights_of_cell(Surface at, vec2 corner) {
    return mat2(finite_weights(at, corner + vec2(1.0, 0.5)) - finite_weights(at, corner + vec2(0.0, 0.5)),
                finite_weights(at, corner + vec2(0.5, 1.0)) - finite_weights(at, corner + vec2(0.5, 0.0)));
}

// How much a place of the cell counts: as much as it is opaque.
float opaque_part(Material material, TexturePoint at) {
    if (!kHasAlpha) return 1.0;
    if (material.alpha_cutoff > 0.0) return is_hole(at.surface, at.weights) ? 0.0 : 1.0;
    return material.blends && material.opacity > 0.0 ? map_at(material.maps.x, at).w : 1.0;
}

// Over the cell whose corner is `corner`; `middle` stands for a cell of which no place lies on the triangle. It comes last in the loop, since
// compilers write a call out at each place.
vec3 mean_albedo(Surface at, Material material, vec2 corner, TexturePoint middle) {
    mat2 weights_of_place = middle.weights_of_pixel / float(kAlbedoPoints);
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int i = 0; i < kAlbedoPoints * kAlbedoPoints + (count > 0.0 ? 0 : 1); ++i) {
        bool is_middle = i == kAlbedoPoints * kAlbedoPoints;
        vec2 on = weights_at(at, corner + (vec2(float(i % kAlbedoPoints), float(i / kAlbedoPoints)) + 0.5) / float(kAlbedoPoints));
        if (is_middle) on = middle.weights.yz;
        else if (!is_inside(on)) continue;
        TexturePoint place = texture_point(middle.surface, vec3(1.0 - on.x - on.y, on), weights_of_place, uvs_of(at));
        float part = is_middle ? 1.0 : opaque_part(material, place);
        sum += part * albedo_at(material, place);
        count += part;
    }
    return sum / count;
}

// The cell's centre as the pinhole camera sees it, drawn into the triangle.
Point point_of(uint id) {
    uint index = surface_of(id / 2u);
    Surface at = surfaces[index];
    uint cell = id / 2u - ids[index], columns = floatBitsToUint(at.grid.z);
    vec2 corner = at.grid.xy + vec2(float(cell % columns), float(cell / columns));
    vec2 on = finite_weights(at, corner + 0.5);
    vec3 weights = max(vec3(1.0 - on.x - on.y, on.x, on.y), vec3(0.0));
    weights /= weights.x + weights.y + weights.z;
    Material material = material_at(floatBitsToUint(at.corner.w));
    bool textured = has_maps(material);
    TexturePoint own = texture_point(index, weights, textured ? weights_of_cell(at, corner) : mat2(0.0), uvs_of(at));
    Point point;
    point.position = at.corner.xyz + weights.y * at.to_second.xyz + weights.z * at.to_third.xyz;
    point.geometric_normal = normalize(cross(at.to_second.xyz, at.to_third.xyz)) * ((id & 1u) != 0u ? -1.0 : 1.0);
    vec3 smooth_normal = normalize(mat3(at.normals[0].xyz, at.normals[1].xyz, at.normals[2].xyz) * weights);
    point.normal = smooth_normal;
    if (material.normal_map != kNoMap) {
        vec4 tangent = tangent_at(own);
        point.normal = mapped_normal(material, own, smooth_normal, tangent.xyz, tangent.w);
    }
    if (dot(point.geometric_normal, smooth_normal) < 0.0) point.normal = -point.normal;
    point.seed = pcg3d(uvec3(id, 0u, 0x2545f491u)).x;  // as scene::light_seed()
    point.finish = finish_at(material, own);
    if (textured || material.checker_cells.xy != vec2(0.0)) point.finish.albedo = mean_albedo(at, material, corner, own);
    return point;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= id_count) return;
    ray_moment = 0u;
    Point point = point_of(ids[surface_count + index]);
    vec3 light = light_at(point, world_from_camera[3].xyz, ambient, 0u, light_count);
    shaded[index] = vec4(light, 1.0);
    check_loops();
}
