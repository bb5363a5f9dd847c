// Light at what one visibility sample of every pixel of a band meets, at the sample's own moment.
struct Corners {
    vec4 normals[3];  // in the object's space, of any length; w: u
    vec4 v_material;  // v of the three; the material, as bits
};
layout(std430, binding = 6) readonly buffer CornersOfTriangles { Corners corners[]; };  // as the triangles
layout(std430, binding = 7) buffer Sums { vec4 sums[]; };                               // of a pixel's light; w: the samples that met something

uint ray_moment;

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
            Hit hit = Hit(high, kNoShading, vec2(0.0), false);
            meet_triangle(i, origin, direction, ray_moment, 0.0, hit);
            if (hit.triangle == i) share *= 1.0 - triangles[i].view[0].w;
        }
        ++at;
    }
    return share;
}

Point point_of(Hit hit, vec3 origin, vec3 direction, uint seed) {
    Triangle at = triangles[hit.triangle];
    Corners of = corners[hit.triangle];
    Moment moment = moments[ray_moment * object_count + floatBitsToUint(at.corner.w)];
    // Normals go by the inverse's transpose.
    mat3 normal_matrix = mat3(moment.object_from_world[0].xyz, moment.object_from_world[1].xyz, moment.object_from_world[2].xyz);
    vec3 weights = vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    Point point;
    point.position = origin + hit.t * direction;
    point.geometric_normal = normalize(normal_matrix * cross(at.to_second.xyz, at.to_third.xyz)) * (hit.from_behind ? -1.0 : 1.0);
    point.normal = normalize(normal_matrix * (mat3(of.normals[0].xyz, of.normals[1].xyz, of.normals[2].xyz) * weights));
    if (dot(point.geometric_normal, point.normal) < 0.0) point.normal = -point.normal;
    point.material = floatBitsToUint(of.v_material.w);
    point.seed = seed;
    vec2 uv = vec2(dot(vec3(of.normals[0].w, of.normals[1].w, of.normals[2].w), weights), dot(of.v_material.xyz, weights));
    point.albedo = checked_albedo(materials[point.material], uv);
    return point;
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= pixel_count) return;
    vec3 origin = rays[pixel].origin.xyz, direction = rays[pixel].direction.xyz;
    ray_moment = floatBitsToUint(rays[pixel].origin.w);
    Hit hit = stopped(pixel, origin, direction, ray_moment);
    vec4 light = vec4(background.rgb, 0.0);
    if (hit.triangle != kNoShading) {
        uint seed = pcg3d(uvec3(floatBitsToUint(rays[pixel].direction.w), sample_index, 0x2545f491u)).x;  // as scene::light_seed()
        light = vec4(light_at(point_of(hit, origin, direction, seed), origin, ambient, ray_moment * light_count, light_count), 1.0);
    }
    sums[pixel] = light + (sample_index == 0u ? vec4(0.0) : sums[pixel]);
    check_loops();
}
