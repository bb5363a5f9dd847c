#version 450 core
#include <pass>
#include <camera_rays.glsl>

const float kWholePixel = 0.999;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float depth_m = texelFetch(depth, p, 0).r;
#ifdef HAS_OUT_SHARE
    float alpha = texelFetch(first, p, 0).a;
    bool is_shared = alpha > 0.0 && alpha < kWholePixel && texelFetch(second, p, 0).a > 0.0;
    out_share = is_shared ? alpha : 1.0;
    if (is_shared) depth_m = texelFetch(first_depth, p, 0).r;
#endif
    out_surface = inverse_depth(depth_m);
#ifdef HAS_OBJECT_ID
    if (!objects(texelFetch(object_id, p, 0).r).blurs) out_surface = -1.0;
#endif
}
