#version 450 core
#include <pass>
#include "shape.glsl"
#include "bend.glsl"

// How the normal turns over the surface beside a pixel: the squares of the turn and of the way, whose quotient's root is the
// curvature, 1/mm, and the product of both, which over the way's square is the bend with its sign. Differences to pixels of
// the same surface, not dFdx, which would see 2x2 blocks and silhouettes.
vec3 turn_and_way(ivec2 there, Shape own, vec3 p) {
    Shape other = shape_at(there);
    vec3 turn = other.normal - own.normal, way = place_mm(there, other) - p;
    // So steep a way leads over an edge within the surface.
    bool counts = other.key == own.key && abs(way.z) <= 4.0 * length(way.xy);
    return counts ? vec3(dot(turn, turn), dot(way, way), dot(turn, way_in_world(way))) : vec3(0.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    Shape own = shape_at(at);
    vec3 p = place_mm(at, own), sum = vec3(0.0);
    int step_px = own.key != 0u ? bend_step(scattering_profile(own.key - 1u), own.depth_m) : 0;
    const ivec2 sides[4] = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
    for (int side = 0; side < 4; ++side) {
        vec3 found = vec3(0.0);
        // Nearer where the surface ends before.
        for (int px = step_px; px > 0 && found.y == 0.0; px /= 4) found = turn_and_way(at + px * sides[side], own, p);
        sum += found;
    }
    out_bend = vec4(sum, 0.0);
}
