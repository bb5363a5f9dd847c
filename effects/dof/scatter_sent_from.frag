#version 450 core
#include <pass>
#include "scattered.glsl"
#include "sent_from.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float light = density_before(p) * dot(light_of_source, vec3(1.0));
    out_sent_from = light > 0.0 ? pack_sent(light, floor(source) - vec2(p)) : 0.0;
}
