// Rays of visibility samples, each at its own moment, and the triangles that they meet: a hierarchy over the objects as they stand at the
// sample's moments, and one over the triangles of each mesh, in its own space.
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
    float opacity;
    float shadow_opacity;
    float unused_1, unused_2;
};
struct Moment {
    vec4 object_from_world[3];  // rows
};
struct Ray {
    vec4 origin;     // w: the moment, as bits
    vec4 direction;  // w: the pixel's seed, as bits
    vec4 stops;      // for the first transparent surfaces
};

layout(std430, binding = 0) readonly buffer Nodes { Node nodes[]; };              // of all meshes
layout(std430, binding = 1) readonly buffer Triangles { Triangle triangles[]; };  // the same
layout(std430, binding = 2) readonly buffer Moments { Moment moments[]; };        // objects of a moment side by side
layout(std430, binding = 3) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 11) readonly buffer Top { Node top[]; };                 // a leaf's item is an object
layout(std430, binding = 12) readonly buffer Objects { Object objects[]; };
layout(std140, binding = 0) uniform Settings {
    vec2 size_px;
    float px_per_tangent;
    uint top_count;
    uint object_count;
    uint pixel_count;
    uint sample_index;
    uint sample_count;
    uint transparent;  // 1: some objects are
    uint light_count;
    uint unused_1, unused_2;
    vec4 ambient;  // w: rays that seek what hides it
    vec4 background;
    vec4 camera_right;  // the reference pose's axes
    vec4 camera_up;
};

const uint kNoShading = 0xffffffffu;
// As World::kMostCrossings; and past a surface, as a ratio of distances in single precision.
const uint kMostCrossings = 1024u;
const float kPast = 1.0 + 2e-6;

struct Hit {
    float t;
    uint object;
    uint triangle;  // index into Triangles
    vec2 barycentric;
    bool from_behind;
};

Hit no_hit(float before) {
    return Hit(before, 0u, kNoShading, vec2(0.0), false);
}

uint surface_of(Hit hit) {
    return objects[hit.object].first_surface + floatBitsToUint(triangles[hit.triangle].corner.w);
}

struct LocalRay {
    vec3 origin;
    vec3 direction;
};

LocalRay local_ray(vec3 origin, vec3 direction, uint moment, uint object) {
    Moment at = moments[moment * object_count + object];
    vec4 p1 = vec4(origin, 1.0), d1 = vec4(direction, 0.0);
    return LocalRay(vec3(dot(at.object_from_world[0], p1), dot(at.object_from_world[1], p1), dot(at.object_from_world[2], p1)),
                    vec3(dot(at.object_from_world[0], d1), dot(at.object_from_world[1], d1), dot(at.object_from_world[2], d1)));
}

// Both sides.
void meet_triangle(uint index, uint object, LocalRay ray, float low, inout Hit hit) {
    vec3 ab = triangles[index].to_second.xyz, ac = triangles[index].to_third.xyz;
    vec3 met = on_plane(triangles[index].corner.xyz, ab, ac, ray.origin, ray.direction);
    if (is_inside(met.yz) && met.x > low && met.x < hit.t) hit = Hit(met.x, object, index, met.yz, dot(cross(ab, ac), ray.direction) > 0.0);
}

void meet_object(uint object, vec3 origin, vec3 direction, uint moment, float low, inout Hit hit) {
    LocalRay ray = local_ray(origin, direction, moment, object);
    vec3 inverse = 1.0 / ray.direction;
    uint first = objects[object].first_node, count = objects[object].node_count, at = 0u;
    // A ray comes to each node once at most, since it only goes on to later ones.
    for (uint step = 0u; step < count && at < count; ++step) {
        Node node = nodes[first + at];
        if (!meets(ray.origin, inverse, node.low_skip.xyz, node.high_items.xyz, hit.t)) {
            at = floatBitsToUint(node.low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(node.high_items.w), begin = objects[object].first_triangle + (items >> 3);
        for (uint i = 0u; i < (items & 7u); ++i) meet_triangle(begin + i, object, ray, low, hit);
        ++at;
    }
}

// The nearest triangle beyond `low`.
Hit trace(vec3 origin, vec3 direction, uint moment, float low) {
    vec3 inverse = 1.0 / direction;
    Hit hit = no_hit(1e30);
    uint at = 0u;
    for (uint step = 0u; step < top_count && at < top_count; ++step) {
        if (!meets(origin, inverse, top[at].low_skip.xyz, top[at].high_items.xyz, hit.t)) {
            at = floatBitsToUint(top[at].low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(top[at].high_items.w);
        if ((items & 7u) != 0u) meet_object(items >> 3, origin, direction, moment, low, hit);
        ++at;
    }
    return hit;
}

// The twin of StopNumbers::at.
float stop_at(uint pixel, uint crossing) {
    if (crossing < 4u) return rays[pixel].stops[crossing];
    return float(pcg3d(uvec3(floatBitsToUint(rays[pixel].direction.w), sample_index, crossing)).x >> 8u) / 16777216.0;
}

// The triangle that stops the ray of a pixel: the nearest, or by chance one behind transparent ones (Enderton et al. 2010).
Hit stopped(uint pixel, vec3 origin, vec3 direction, uint moment) {
    Hit hit = trace(origin, direction, moment, 0.0);
    uint crossed = 0u;
    for (uint i = 0u; transparent != 0u && hit.triangle != kNoShading && i < kMostCrossings; ++i) {
        float opacity = objects[hit.object].opacity;
        if (opacity >= 1.0 || stop_at(pixel, crossed) < opacity) break;
        ++crossed;
        hit = trace(origin, direction, moment, hit.t * kPast);
    }
    return hit;
}
