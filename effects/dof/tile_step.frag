#version 450 core
#include <pass>
#include <lens/highlight.glsl>
#include <lens/coc_of.glsl>

// With layers, of the module's own. Else of depth: a frame in focus then has no CoC of each pixel to make.
#if defined(HAS_COC_STEP)
void main() { out_tile_step = texelFetch(coc_step, ivec2(gl_FragCoord.xy), 0); }
#else
#if defined(HAS_COC)
vec2 texel_of_blocks() { return coc_size.zw; }
vec4 block(ivec2 p, vec2 texel) { return textureGather(coc, vec2(p + 1) * texel); }
#else
float at_infinity_px = lens_at_infinity_px();

vec2 texel_of_blocks() { return depth_size.zw; }
vec4 block(ivec2 p, vec2 texel) {
    vec4 depth_m = textureGather(depth, vec2(p + 1) * texel);
    return vec4(coc_of(depth_m.x, at_infinity_px), coc_of(depth_m.y, at_infinity_px), coc_of(depth_m.z, at_infinity_px),
                coc_of(depth_m.w, at_infinity_px));
}
#endif

#include <lens/step.glsl>

void main() { out_tile_step = step_of(ivec2(gl_FragCoord.xy)); }
#endif
