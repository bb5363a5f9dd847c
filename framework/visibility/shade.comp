// Light at shading samples, at the frame's own time: the twin of scene::ShadingGrids::shade() in single precision.
struct Surface {
    vec4 corner;          // world, m; w: material, as bits
    vec4 to_second;       // w: v of the first corner
    vec4 to_third;        // w: v of the second
    vec4 normals[3];      // of the corners, world, of any length; w: their u
    vec4 px_from_cells;   // columns
    vec4 grid;            // xy: low corner, in cells; z: columns, as bits; w: v of the third
};
struct Blocker {
    vec4 corner;  // world, m; w: opacity
    vec4 to_second;
    vec4 to_third;
};
layout(std430, binding = 0) readonly buffer Nodes { Node nodes[]; };
layout(std430, binding = 1) readonly buffer Blockers { Blocker blockers[]; };  // as the leaves order them
layout(std430, binding = 2) readonly buffer Starts { uint starts[]; };         // the first cell of each surface
layout(std430, binding = 3) readonly buffer Surfaces { Surface surfaces[]; };
layout(std430, binding = 6) readonly buffer Ids { uint ids[]; };
layout(std430, binding = 7) writeonly buffer Shaded { vec4 shaded[]; };
layout(std140, binding = 0) uniform Settings {
    mat4 world_from_camera;
    vec4 ambient;  // w: rays that seek what hides it
    vec2 size_px;
    float px_per_tangent;
    uint id_count;
    uint node_count;
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
        if (starts[middle] <= cell) low = middle;
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

vec2 uv_at(Surface at, vec2 on) {
    vec3 weights = vec3(1.0 - on.x - on.y, on);
    return vec2(dot(vec3(at.normals[0].w, at.normals[1].w, at.normals[2].w), weights), dot(vec3(at.to_second.w, at.to_third.w, at.grid.w), weights));
}

// Where a ray runs along the plane, its middle; as barycentric_on_plane() of the CPU.
vec2 finite_weights(Surface at, vec2 place) {
    vec2 on = weights_at(at, place);
    return any(isnan(on)) || any(isinf(on)) ? vec2(1.0 / 3.0) : on;
}

// The sides of the cell whose corner is `corner`, in texture coordinates.
mat2 uv_of_cell(Surface at, vec2 corner) {
    return mat2(uv_at(at, finite_weights(at, corner + vec2(1.0, 0.5))) - uv_at(at, finite_weights(at, corner + vec2(0.0, 0.5))),
                uv_at(at, finite_weights(at, corner + vec2(0.5, 1.0))) - uv_at(at, finite_weights(at, corner + vec2(0.5, 0.0))));
}

// Over the cell whose corner is `corner`; `middle` stands for a cell of which no place lies on the triangle.
vec3 mean_albedo(Surface at, Material material, vec2 corner, vec2 middle, mat2 uv_of_cell) {
    mat2 uv_of_place = uv_of_cell / float(kAlbedoPoints);
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int i = 0; i < kAlbedoPoints * kAlbedoPoints; ++i) {
        vec2 on = weights_at(at, corner + (vec2(float(i % kAlbedoPoints), float(i / kAlbedoPoints)) + 0.5) / float(kAlbedoPoints));
        if (!is_inside(on)) continue;
        sum += albedo_at(material, uv_at(at, on), uv_of_place);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : albedo_at(material, uv_at(at, middle), uv_of_place);
}

// The cell's centre as the pinhole camera sees it, drawn into the triangle.
Point point_of(uint id) {
    uint index = surface_of(id / 2u);
    Surface at = surfaces[index];
    uint cell = id / 2u - starts[index], columns = floatBitsToUint(at.grid.z);
    vec2 corner = at.grid.xy + vec2(float(cell % columns), float(cell / columns));
    vec2 on = finite_weights(at, corner + 0.5);
    vec3 weights = max(vec3(1.0 - on.x - on.y, on.x, on.y), vec3(0.0));
    weights /= weights.x + weights.y + weights.z;
    Material material = materials[floatBitsToUint(at.corner.w)];
    bool textured = has_maps(material);
    vec2 uv = uv_at(at, weights.yz);
    mat2 uv_of_own = textured ? uv_of_cell(at, corner) : mat2(0.0);
    Point point;
    point.position = at.corner.xyz + weights.y * at.to_second.xyz + weights.z * at.to_third.xyz;
    point.geometric_normal = normalize(cross(at.to_second.xyz, at.to_third.xyz)) * ((id & 1u) != 0u ? -1.0 : 1.0);
    vec3 smooth_normal = normalize(mat3(at.normals[0].xyz, at.normals[1].xyz, at.normals[2].xyz) * weights);
    point.normal = smooth_normal;
    if (material.normal_map.x != kNoMap) {
        vec4 tangent = tangent_at(index, weights);
        point.normal = mapped_normal(material, uv, uv_of_own, smooth_normal, tangent.xyz, tangent.w);
    }
    if (dot(point.geometric_normal, smooth_normal) < 0.0) point.normal = -point.normal;
    point.seed = pcg3d(uvec3(id, 0u, 0x2545f491u)).x;  // as scene::light_seed()
    point.finish = finish_at(material, uv, uv_of_own);
    if (textured || material.checker_cells.xy != vec2(0.0)) point.finish.albedo = mean_albedo(at, material, corner, weights.yz, uv_of_own);
    return point;
}

// The share of light that crosses what stands on a ray before `high`.
float light_through(vec3 origin, vec3 direction, float high) {
    vec3 inverse = 1.0 / direction;
    float share = 1.0;
    uint at = 0u;
    // A ray comes to each node once at most, since it only goes on to later ones.
    for (uint step = 0u; step < node_count && at < node_count && share > 0.0; ++step) {
        if (!meets(origin, inverse, nodes[at].low_skip.xyz, nodes[at].high_items.xyz, high)) {
            at = floatBitsToUint(nodes[at].low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(nodes[at].high_items.w), first = items >> 3;
        for (uint i = first; i < first + (items & 7u); ++i) {
            vec3 met = on_plane(blockers[i].corner.xyz, blockers[i].to_second.xyz, blockers[i].to_third.xyz, origin, direction);
            if (is_inside(met.yz) && met.x > 0.0 && met.x < high) share *= 1.0 - blockers[i].corner.w;
        }
        ++at;
    }
    return share;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= id_count) return;
    Point point = point_of(ids[index]);
    vec3 light = light_at(point, world_from_camera[3].xyz, ambient, 0u, light_count);
    shaded[index] = vec4(light, 1.0);
    check_loops();
}
