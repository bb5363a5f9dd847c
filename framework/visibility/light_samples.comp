// Light at what one visibility sample of every pixel of a band meets, at the sample's own moment.
struct Corners {
    vec4 normals[3];  // in the object's space, of any length; w: u
    vec4 v_material;  // v of the three; the material, as bits
};
layout(std430, binding = 6) readonly buffer CornersOfTriangles { Corners corners[]; };  // of the triangles of all objects
layout(std430, binding = 7) buffer Sums { vec4 sums[]; };                               // of a pixel's light; w: the samples that met something

uint ray_moment;

// The share of light that crosses an object on a ray before `high`.
float light_through_object(uint object, vec3 origin, vec3 direction, float high) {
    LocalRay ray = local_ray(origin, direction, ray_moment, object);
    vec3 inverse = 1.0 / ray.direction;
    uint first = objects[object].first_node, count = objects[object].node_count, at = 0u;
    float share = 1.0, opacity = objects[object].shadow_opacity;
    for (uint step = 0u; step < count && at < count && share > 0.0; ++step) {
        Node node = nodes[first + at];
        if (!meets(ray.origin, inverse, node.low_skip.xyz, node.high_items.xyz, high)) {
            at = floatBitsToUint(node.low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(node.high_items.w), begin = objects[object].first_triangle + (items >> 3);
        for (uint i = begin; i < begin + (items & 7u); ++i) {
            Hit hit = no_hit(high);
            meet_triangle(i, object, ray, 0.0, hit);
            if (hit.triangle == i) share *= 1.0 - opacity;
        }
        ++at;
    }
    return share;
}

// The share of light that crosses what stands on a ray before `high`.
float light_through(vec3 origin, vec3 direction, float high) {
    vec3 inverse = 1.0 / direction;
    float share = 1.0;
    uint at = 0u;
    for (uint step = 0u; step < top_count && at < top_count && share > 0.0; ++step) {
        if (!meets(origin, inverse, top[at].low_skip.xyz, top[at].high_items.xyz, high)) {
            at = floatBitsToUint(top[at].low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(top[at].high_items.w), object = items >> 3;
        if ((items & 7u) != 0u && objects[object].shadow_opacity > 0.0) share *= light_through_object(object, origin, direction, high);
        ++at;
    }
    return share;
}

// World::uv_of_pixel(), but with the camera at the frame's own time. The triangle is in the object's space, `normal` and `view`, of depth 1, are in the world; `rows`: those of
// object_from_world.
mat2 uv_of_pixel(vec3 ab, vec3 ac, vec2 ab_uv, vec2 ac_uv, mat3 rows, vec3 normal, vec3 view, float width) {
    float along = min(dot(normal, view), -1e-3 * length(view));
    vec3 right = width * (camera_right.xyz - dot(normal, camera_right.xyz) / along * view) * rows;
    vec3 up = width * (camera_up.xyz - dot(normal, camera_up.xyz) / along * view) * rows;
    vec3 area = cross(ab, ac);
    float area2 = dot(area, area);
    return mat2((dot(cross(right, ac), area) * ab_uv + dot(cross(ab, right), area) * ac_uv) / area2,
                (dot(cross(up, ac), area) * ab_uv + dot(cross(ab, up), area) * ac_uv) / area2);
}

Point point_of(Hit hit, vec3 origin, vec3 direction, uint seed) {
    Triangle at = triangles[hit.triangle];
    uint surface = surface_of(hit);
    Corners of = corners[surface];
    Moment moment = moments[ray_moment * object_count + hit.object];
    // Normals go by the inverse's transpose, whose columns these rows are.
    mat3 normal_matrix = mat3(moment.object_from_world[0].xyz, moment.object_from_world[1].xyz, moment.object_from_world[2].xyz);
    vec3 weights = vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    vec3 us = vec3(of.normals[0].w, of.normals[1].w, of.normals[2].w), vs = of.v_material.xyz;
    vec2 uv = vec2(dot(us, weights), dot(vs, weights));
    Material material = materials[floatBitsToUint(of.v_material.w)];
    Point point;
    point.position = origin + hit.t * direction;
    point.geometric_normal = normalize(normal_matrix * cross(at.to_second.xyz, at.to_third.xyz)) * (hit.from_behind ? -1.0 : 1.0);
    vec3 smooth_normal = normalize(normal_matrix * (mat3(of.normals[0].xyz, of.normals[1].xyz, of.normals[2].xyz) * weights));
    mat2 footprint = mat2(0.0);
    if (has_maps(material))
        footprint = uv_of_pixel(at.to_second.xyz, at.to_third.xyz, vec2(us.y - us.x, vs.y - vs.x), vec2(us.z - us.x, vs.z - vs.x), normal_matrix,
                                point.geometric_normal, direction, hit.t / (px_per_tangent * sqrt(float(sample_count))));
    point.normal = smooth_normal;
    if (material.normal_map.x != kNoMap) {
        vec4 tangent = tangent_at(surface, weights);
        point.normal = mapped_normal(material, uv, footprint, smooth_normal, inverse(transpose(normal_matrix)) * tangent.xyz, tangent.w);
    }
    if (dot(point.geometric_normal, smooth_normal) < 0.0) point.normal = -point.normal;
    point.seed = seed;
    point.finish = finish_at(material, uv, footprint);
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
