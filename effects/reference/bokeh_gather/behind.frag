#version 450 core
#include <pass>
#include <behind.glsl>
#include <lens/lens.glsl>
#include <lens/packing.glsl>

const float kLeastBlurPx = 0.5;

// A near thing behind another one is passed over: what shows between them is behind both, and its own blur lacks no more than the
// width of the one in front.
void take(inout Light found, vec4 color_there, float depth_m, float at_infinity_px) {
    if (found.color.a > 0.0 && found.coc > -kLeastBlurPx) return;
    vec4 light = covering(color_there);
    if (light.a > 0.0) found = Light(light, coc_of(depth_m, at_infinity_px));
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float at_infinity_px = lens_at_infinity_px();
    Light found = Light(vec4(0.0), 0.0);
    take(found, texelFetch(second, p, 0), texelFetch(second_depth, p, 0).r, at_infinity_px);
#if defined(HAS_THIRD) && defined(HAS_THIRD_DEPTH)
    take(found, texelFetch(third, p, 0), texelFetch(third_depth, p, 0).r, at_infinity_px);
#endif
#if defined(HAS_FOURTH) && defined(HAS_FOURTH_DEPTH)
    take(found, texelFetch(fourth, p, 0), texelFetch(fourth_depth, p, 0).r, at_infinity_px);
#endif
    out_behind = pack_light(found);
}
