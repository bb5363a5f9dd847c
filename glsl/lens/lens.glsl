// The CoC of the pixels of `depth`, by the module's parameters.
#include "coc_of.glsl"

#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
#include "surface.glsl"
#endif

float coc_at(ivec2 p, float at_infinity_px) {
#ifdef SHARES_PIXELS
    return surface_at(p, at_infinity_px).coc;
#else
    return coc_of(texelFetch(depth, p, 0).r, at_infinity_px);
#endif
}
