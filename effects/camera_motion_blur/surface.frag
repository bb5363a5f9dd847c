#version 450 core
#include <pass>
#include <camera_rays.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_surface = inverse_depth(texelFetch(depth, p, 0).r);
#ifdef HAS_OBJECT_ID
    if (!objects(texelFetch(object_id, p, 0).r).blurs) out_surface = -1.0;
#endif
}
