#version 450 core
#include <pass>
#include <behind.glsl>
#include <lens/lens.glsl>
#include <lens/packing.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float coc_px = coc_of(texelFetch(second_depth, p, 0).r, lens_at_infinity_px());
    out_behind = pack_light(Light(covering(texelFetch(second, p, 0)), coc_px));
}
