// Colour of the surface that stands for a pixel where layers share it, for a texture `own` of own.glsl; alpha 0 elsewhere.
#include "lens.glsl"

vec4 shared_color(ivec2 p) {
#ifdef SHARES_PIXELS
    Surface surface = surface_at(p, lens_at_infinity_px());
    if (surface.is_shared) return vec4(surface.color.rgb, 1.0);
#endif
    return vec4(0.0);
}
