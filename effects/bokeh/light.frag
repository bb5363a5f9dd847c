#version 450 core
#include <pass>
#include <lens/packing.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    out_light = pack_light(Light(texel.rgb, texel.a, texelFetch(coc, p, 0).r));
}
