// What a pixel remembers of its luminance. Exponentially moving mean of weight a, and variance: Finch 2009, Incremental
// calculation of weighted mean and variance.
#include <color_luminance.glsl>
#include "past.glsl"
#include "tile.glsl"

// Luminance in the unit whose variance target_variance is.
float viewed(vec3 light) {
#if TARGET == TARGET_RELATIVE
    // Level 3 has squares of 64 px.
    vec2 around = textureLod(tile_light, gl_FragCoord.xy * tile_light_size.zw / float(kTile), 3.0).rg;
    return min(color_luminance(light) * around.y / max(around.x, 1e-20), 1e6);
#else
    return exp2(param.exposure) * color_luminance(light);
#endif
}

// The history after a frame whose luminance, less its control variate, was `value`.
vec4 updated_history(vec4 past, bool known, float count, float value, uint key) {
    // Without history the wanted variance is taken to be met.
    if (!known)
        return vec4(0.5 * float(param.min_samples + param.max_samples), sqrt(param.target_variance), value, key_of(key));
    float weight = param.history_weight, mean_count = mix(past.x, count, weight);
    if (count < 0.5) return vec4(mean_count, past.yz, key_of(key));
    float off = value - past.z;
    float variance = (1.0 - weight) * (past.y * past.y + weight * off * off);
    return vec4(mean_count, sqrt(variance), past.z + weight * off, key_of(key));
}
