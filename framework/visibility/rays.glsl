// Rays of visibility samples, each at its own moment, and the triangles that they meet.
struct Triangle {
    vec4 corner;         // in the object's space, m; w: the object, as bits
    vec4 to_second;      // w: the grid's first cell, as bits
    vec4 to_third;       // w: opacity
    vec4 view[3];        // the corners before the reference pose's camera, m; w of the first: the opacity of its shadow
    vec4 cells_from_px;  // columns
    vec4 grid;           // low corner, in cells; size, as bits
};
struct Moment {
    vec4 object_from_world[3];  // rows
};
struct Ray {
    vec4 origin;     // w: the moment, as bits
    vec4 direction;  // w: the pixel's seed, as bits
    vec4 stops;      // for the first transparent surfaces
};

layout(std430, binding = 0) readonly buffer Nodes { Node nodes[]; };
layout(std430, binding = 1) readonly buffer Triangles { Triangle triangles[]; };  // as the leaves order them
layout(std430, binding = 2) readonly buffer Moments { Moment moments[]; };        // objects of a moment side by side
layout(std430, binding = 3) readonly buffer Rays { Ray rays[]; };
layout(std140, binding = 0) uniform Settings {
    vec2 size_px;
    float px_per_tangent;
    uint node_count;
    uint object_count;
    uint pixel_count;
    uint sample_index;
    uint sample_count;
    uint transparent;  // 1: some triangles are
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
    uint triangle;
    vec2 barycentric;
    bool from_behind;
};

// Both sides, in the object's space.
void meet_triangle(uint index, vec3 origin, vec3 direction, uint moment, float low, inout Hit hit) {
    Moment at = moments[moment * object_count + floatBitsToUint(triangles[index].corner.w)];
    vec4 p1 = vec4(origin, 1.0), d1 = vec4(direction, 0.0);
    vec3 o = vec3(dot(at.object_from_world[0], p1), dot(at.object_from_world[1], p1), dot(at.object_from_world[2], p1));
    vec3 d = vec3(dot(at.object_from_world[0], d1), dot(at.object_from_world[1], d1), dot(at.object_from_world[2], d1));
    vec3 ab = triangles[index].to_second.xyz, ac = triangles[index].to_third.xyz;
    vec3 met = on_plane(triangles[index].corner.xyz, ab, ac, o, d);
    if (is_inside(met.yz) && met.x > low && met.x < hit.t) hit = Hit(met.x, index, met.yz, dot(cross(ab, ac), d) > 0.0);
}

// The twin of StopNumbers::at.
float stop_at(uint pixel, uint crossing) {
    if (crossing < 4u) return rays[pixel].stops[crossing];
    return float(pcg3d(uvec3(floatBitsToUint(rays[pixel].direction.w), sample_index, crossing)).x >> 8u) / 16777216.0;
}

// The nearest triangle beyond `low`.
Hit trace(vec3 origin, vec3 direction, uint moment, float low) {
    vec3 inverse = 1.0 / direction;
    Hit hit = Hit(1e30, kNoShading, vec2(0.0), false);
    uint at = 0u;
    // A ray comes to each node once at most, since it only goes on to later ones.
    for (uint step = 0u; step < node_count && at < node_count; ++step) {
        if (!meets(origin, inverse, nodes[at].low_skip.xyz, nodes[at].high_items.xyz, hit.t)) {
            at = floatBitsToUint(nodes[at].low_skip.w);
            continue;
        }
        uint items = floatBitsToUint(nodes[at].high_items.w), first = items >> 3;
        for (uint i = 0u; i < (items & 7u); ++i) meet_triangle(first + i, origin, direction, moment, low, hit);
        ++at;
    }
    return hit;
}

// The triangle that stops the ray of a pixel: the nearest, or by chance one behind transparent ones (Enderton et al. 2010).
Hit stopped(uint pixel, vec3 origin, vec3 direction, uint moment) {
    Hit hit = trace(origin, direction, moment, 0.0);
    uint crossed = 0u;
    for (uint i = 0u; transparent != 0u && hit.triangle != kNoShading && i < kMostCrossings; ++i) {
        float opacity = triangles[hit.triangle].to_third.w;
        if (opacity >= 1.0 || stop_at(pixel, crossed) < opacity) break;
        ++crossed;
        hit = trace(origin, direction, moment, hit.t * kPast);
    }
    return hit;
}
