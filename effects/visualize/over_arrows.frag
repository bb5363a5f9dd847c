#version 450 core
#include <pass>
#include "picture.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 over = texelFetch(arrows, p, 0);
    out_display = vec4(over.rgb + (1.0 - over.a) * dimmed_picture(p), 1.0);
}
