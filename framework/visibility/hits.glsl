// Rays and the triangles that they meet: a hierarchy over the objects as they stand at some moments, and one over the triangles of each mesh,
// in its own space.
struct Hit {
    float t;
    uint object;
    uint surface;   // the triangle's number among those of all objects; kNoShading: none
    uint triangle;  // index into the meshes'
    vec2 barycentric;
    bool from_behind;
};
struct LocalRay {
    vec3 origin;
    vec3 direction;
};

const uint kNoShading = 0xffffffffu;

Node mesh_node(uint index) {
    return Node(meshes[2u * index], meshes[2u * index + 1u]);
}

// A leaf's item is an object.
Node top_node(uint index) {
    return Node(moving[top_at + 2u * index], moving[top_at + 2u * index + 1u]);
}

Hit no_hit(float before) {
    return Hit(before, 0u, kNoShading, 0u, vec2(0.0), false);
}

vec3 weights_of(Hit hit) {
    return vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
}

// The rows of object_from_world.
mat3x4 object_from_world(uint moment, uint object) {
    uint at = 3u * (moment * object_count + object);
    return mat3x4(moving[at], moving[at + 1u], moving[at + 2u]);
}

LocalRay local_ray(vec3 origin, vec3 direction, uint moment, uint object) {
    mat3x4 rows = object_from_world(moment, object);
    return LocalRay(vec4(origin, 1.0) * rows, vec4(direction, 0.0) * rows);
}

// Both sides. `number`: the object's.
void meet_triangle(uint index, Object object, uint number, LocalRay ray, float low, inout Hit hit) {
    Triangle at = triangle_at(index);
    vec3 ab = at.to_second.xyz, ac = at.to_third.xyz;
    vec3 met = on_plane(at.corner.xyz, ab, ac, ray.origin, ray.direction);
    if (!is_inside(met.yz) || !(met.x > low && met.x < hit.t)) return;
    uint surface = object.first_surface + floatBitsToUint(at.corner.w);
    if (kHasAlpha && object.has_holes && is_hole(surface, vec3(1.0 - met.y - met.z, met.yz))) return;
    hit = Hit(met.x, number, surface, index, met.yz, dot(cross(ab, ac), ray.direction) > 0.0);
}

void meet_object(uint number, vec3 origin, vec3 direction, uint moment, float low, inout Hit hit) {
    LocalRay ray = local_ray(origin, direction, moment, number);
    vec3 inverse = 1.0 / ray.direction;
    Object object = object_at(number);
    uint at = 0u;
    // A ray comes to each node once at most, since it only goes on to later ones.
    for (uint step = 0u; step < object.node_count && at < object.node_count; ++step) {
        Node node = mesh_node(object.first_node + at);
        if (!meets(ray.origin, inverse, node.low_skip.xyz, node.high_items.xyz, hit.t)) {
            at = floatBitsToUint(node.low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(node.high_items.w), begin = object.first_triangle + (items >> 3);
        for (uint i = 0u; i < (items & 7u); ++i) meet_triangle(begin + i, object, number, ray, low, hit);
        ++at;
    }
}

// The nearest triangle beyond `low`.
Hit trace(vec3 origin, vec3 direction, uint moment, float low) {
    vec3 inverse = 1.0 / direction;
    Hit hit = no_hit(1e30);
    uint at = 0u;
    for (uint step = 0u; step < top_count && at < top_count; ++step) {
        Node node = top_node(at);
        if (!meets(origin, inverse, node.low_skip.xyz, node.high_items.xyz, hit.t)) {
            at = floatBitsToUint(node.low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(node.high_items.w);
        if ((items & 7u) != 0u) meet_object(items >> 3, origin, direction, moment, low, hit);
        ++at;
    }
    return hit;
}
