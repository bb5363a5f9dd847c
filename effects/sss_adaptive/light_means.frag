#version 450 core
#include <pass>
#include "marked_light.glsl"

void main() {
    ivec2 p = 2 * ivec2(gl_FragCoord.xy), next = min(p + 1, frame.size - 1);
    out_light_means = 0.25 * (marked_light(p) + marked_light(ivec2(next.x, p.y)) + marked_light(ivec2(p.x, next.y)) + marked_light(next));
}
