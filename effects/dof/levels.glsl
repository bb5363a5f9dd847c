#include "coarse.glsl"

// Up to kFullSizePx the blur is gathered at full size; beyond, at half size, and beyond kHalfSizePx at a quarter. A gather takes the
// finest level whose texels are at most kTexels a radius in tiles with a silhouette, and elsewhere kPlainTexels, or kEvenTexels where all
// CoC are alike: about 2.6 times its square are fetched.
#if QUALITY == QUALITY_FAST
const float kFullSizePx = 4.0, kHalfSizePx = 16.0, kTexels = 8.0, kPlainTexels = 8.0, kEvenTexels = 6.0;
#elif QUALITY == QUALITY_NORMAL
const float kFullSizePx = 4.0, kHalfSizePx = 16.0, kTexels = 16.0, kPlainTexels = 11.0, kEvenTexels = 8.0;
#else
const float kFullSizePx = 64.0, kHalfSizePx = 1000.0, kTexels = 64.0, kPlainTexels = 64.0, kEvenTexels = 64.0;
#endif
const float kAlikePx = 4.0;         // difference of CoC radii
const float kHalfAlikePx = 1.0;     // of a pixel and a texel of half size of one surface
const float kQuarterAlikePx = 2.0;  // of a texel of half size and one of a quarter

// around_coc: the texel of `around`.
int level_for(float radius_px, vec4 around_coc) {
    if (!has_coarse_levels()) return 0;
#ifdef SILHOUETTES
    float texels = kTexels;
#else
    float texels = around_coc.w - around_coc.x <= kAlikePx ? kEvenTexels : kPlainTexels;
#endif
    return int(radius_px > texels) + int(radius_px > 2.0 * texels) + int(radius_px > 4.0 * texels);
}
