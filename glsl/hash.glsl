// Random numbers without state. Jarzynski and Olano 2020, Hash Functions for GPU Rendering, Journal of Computer Graphics
// Techniques 9(3), listings of pcg3d and
// pcg3d16.

uvec3 pcg3d(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Three numbers of 16 bits.
uvec3 pcg3d16(uvec3 v) {
    v = v * 12829u + 47989u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v >> 16u;
}

// In (0, 1): the upper 23 bits, so that every value and its distance from 1 are exact in a float.
float unit_float(uint bits) { return (float(bits >> 9u) + 0.5) * (1.0 / 8388608.0); }

// Two independent standard normal numbers from two hashes: Box and Muller 1958. They stay within 5.8.
vec2 normal_pair(uint a, uint b) {
    float angle_rad = 6.283185307 * unit_float(b);
    return sqrt(-2.0 * log(unit_float(a))) * vec2(cos(angle_rad), sin(angle_rad));
}
