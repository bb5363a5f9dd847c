#version 450 core
#include <pass>
#include <lens/packing.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_light = pack_light(Light(texelFetch(color, p, 0), texelFetch(coc, p, 0).r));
}
