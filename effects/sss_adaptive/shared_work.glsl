// Who does a pixel of the hybrid: samples or blurs.
#include "tile.glsl"

// Share of the samples in a pixel that may be sampled, by the range of the light around.
float share_of_range(float range) {
#if HYBRID == HYBRID_SEPARABLE
    return 0.0;
#else
    return param.calm_range > 0.0 ? smoothstep(param.calm_range, 2.0 * param.calm_range, range) : 1.0;
#endif
}
