// Rays of visibility samples, each at its own moment, and what stops them.
struct Ray {
    vec4 origin;     // w: the moment, as bits
    vec4 direction;  // w: the pixel's seed, as bits
    vec4 stops;      // for the first transparent surfaces
};

layout(std430, binding = 2) readonly buffer Rays { Ray rays[]; };
layout(std140, binding = 0) uniform Settings {
    vec2 size_px;
    float px_per_tangent;
    uint pixel_count;
    uint sample_index;
    uint sample_count;
    uint transparent;  // 1: some objects are
    uint light_count;
    vec4 ambient;  // w: rays that seek what hides it
    vec4 background;
    vec4 camera_right;  // the reference pose's axes
    vec4 camera_up;
};

// As World::kMostCrossings; and past a surface, as a ratio of distances in single precision.
const uint kMostCrossings = 1024u;
const float kPast = 1.0 + 2e-6;

// The twin of StopNumbers::at.
float stop_at(uint pixel, uint crossing) {
    if (crossing < 4u) return rays[pixel].stops[crossing];
    return float(pcg3d(uvec3(floatBitsToUint(rays[pixel].direction.w), sample_index, crossing)).x >> 8u) / 16777216.0;
}

// World::weights_of_pixel(), but with the camera at the frame's own time; `direction`, of depth 1, is in the world.
mat2 weights_of_pixel(Hit hit, vec3 direction, uint moment) {
    Triangle at = triangle_at(hit.triangle);
    vec3 ab = at.to_second.xyz, ac = at.to_third.xyz, area = cross(ab, ac);
    mat3 rows = mat3(object_from_world(moment, hit.object));
    vec3 normal = normalize(rows * area) * (hit.from_behind ? -1.0 : 1.0);
    float along = min(dot(normal, direction), -1e-3 * length(direction));
    float width = hit.t / (px_per_tangent * sqrt(float(sample_count))), area2 = dot(area, area);
    vec3 right = width * (camera_right.xyz - dot(normal, camera_right.xyz) / along * direction) * rows;
    vec3 up = width * (camera_up.xyz - dot(normal, camera_up.xyz) / along * direction) * rows;
    return mat2(dot(cross(right, ac), area), dot(cross(ab, right), area), dot(cross(up, ac), area), dot(cross(ab, up), area)) / area2;
}

float opacity_of(Hit hit, vec3 direction, uint moment) {
    Object object = object_at(hit.object);
    return kHasAlpha && object.is_mixed ? mixed_opacity(hit.surface, weights_of(hit), weights_of_pixel(hit, direction, moment)) : object.opacity;
}

// The triangle that stops the ray of a pixel: the nearest, or by chance one behind transparent ones (Enderton et al. 2010).
Hit stopped(uint pixel, vec3 origin, vec3 direction, uint moment) {
    Hit hit = trace(origin, direction, moment, 0.0);
    uint crossed = 0u;
    for (uint i = 0u; transparent != 0u && hit.surface != kNoShading && i < kMostCrossings; ++i) {
        float opacity = opacity_of(hit, direction, moment);
        if (opacity >= 1.0 || stop_at(pixel, crossed) < opacity) break;
        ++crossed;
        hit = trace(origin, direction, moment, hit.t * kPast);
    }
    return hit;
}
