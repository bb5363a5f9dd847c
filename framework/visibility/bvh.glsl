// A hierarchy of boxes without a stack, and the triangles in it.
struct Node {
    vec4 low_skip;    // xyz: m; w: the next node that is not below this one, as bits
    vec4 high_items;  // w: the first item times 8 plus their count, as bits; count 0: not a leaf
};

// Whether a ray meets the box between 0 and `nearest` (Kay and Kajiya 1986).
bool meets(vec3 origin, vec3 inverse_direction, vec3 low, vec3 high, float nearest) {
    vec3 a = (low - origin) * inverse_direction, b = (high - origin) * inverse_direction;
    vec3 near = min(a, b), far = max(a, b);
    float enter = max(max(near.x, near.y), near.z), leave = min(min(far.x, far.y), far.z);
    return enter <= leave && leave > 0.0 && enter < nearest;
}

// Where a ray meets the plane of a triangle: t, and the weights of the second and third corner (Moller and Trumbore 1997).
vec3 on_plane(vec3 corner, vec3 to_second, vec3 to_third, vec3 origin, vec3 direction) {
    vec3 p = cross(direction, to_third), s = origin - corner, q = cross(s, to_second);
    return vec3(dot(to_third, q), dot(s, p), dot(direction, q)) / dot(to_second, p);
}

bool is_inside(vec2 weights) {
    return weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0;
}
