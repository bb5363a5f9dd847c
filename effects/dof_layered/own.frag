#version 450 core
#include <pass>
#include <lens/lens.glsl>

void main() {
    out_own = vec4(0.0);
#ifdef SHARES_PIXELS
    Surface surface = surface_at(ivec2(gl_FragCoord.xy), lens_at_infinity_px());
    if (surface.is_shared) out_own = vec4(surface.color.rgb, 1.0);
#endif
}
