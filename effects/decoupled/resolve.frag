#version 450 core
#include <pass>
#include "key.glsl"
#include "surfel.glsl"
#include "layers.glsl"

// Of a layer's pixel, as a surface that covers it.
vec4 covering(vec4 texel) { return texel / max(texel.a, kNothing); }

vec4 light_of(ivec2 p, int layer) {
#ifdef HAS_SECOND
    if (layer == 1) return covering(texelFetch(second, p, 0));
#endif
#ifdef HAS_THIRD
    if (layer == 2) return covering(texelFetch(third, p, 0));
#endif
#ifdef HAS_FOURTH
    if (layer == 3) return covering(texelFetch(fourth, p, 0));
#endif
#if defined(HAS_FRONT) && defined(HAS_SECOND)
    vec4 nearest = texelFetch(front, p, 0);
    if (nearest.a >= kNothing && nearest.a < kWhole) return covering(nearest);
#endif
    return texelFetch(light, p, 0);
}

#ifdef HAS_OUT_MET
// How far lens and shutter move what is seen.
vec2 blurs_of(ivec2 p, int layer, float at_infinity_px) {
#ifdef HAS_HIDDEN_AT
    if (layer == kEstimatedLayer) {
        uvec4 at = texelFetch(hidden_at, p, 0);
        return vec2(abs(coc_of(uintBitsToFloat(at.z), at_infinity_px)), longest_way_px(vec4(unpackHalf2x16(at.x), unpackHalf2x16(at.y))));
    }
#endif
    Surfel surfel = surfel_at(layer, p, at_infinity_px);
    return vec2(abs(surfel.coc_px), longest_way_px(surfel.path));
}
#endif

bool is_inside(vec2 p) { return all(greaterThanEqual(p, vec2(-0.5))) && all(lessThan(p, vec2(frame.size) - 0.5)); }

// Beyond the edges lie the pixels of the edges.
vec4 beyond(vec2 from) { return texelFetch(light, clamp(ivec2(floor(from + 0.5)), ivec2(0), frame.size - 1), 0); }

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef HAS_OUT_MET
    float at_infinity_px = lens_at_infinity_px();
    vec2 blurs_px = vec2(0.0);
#endif
    float coc_px = texelFetch(coc, p, 0).r;
    // Differences from the pixel's own light: where there are none, it stays as it is to the bit.
    vec4 path = path_at(p), own = texelFetch(color, p, 0), sum = vec4(0.0);
    vec2 missing = vec2(0.0);
    for (int s = BAND * kBandSamples; s < min(param.samples, (BAND + 1) * kBandSamples); ++s) {
        ivec3 at = ivec3(p, s - BAND * kBandSamples);
        uint key = imageLoad(keys, at).r;
        if (key == kEmpty) {
            vec3 point = texelFetch(points, ivec2(s, 0), 0).xyz;
            vec2 from = vec2(p) - coc_px * point.xy - way_px(path, point.z);
            sum += beyond(from) - own;
            if (is_inside(from)) missing.y += 1.0;
            continue;
        }
        imageStore(keys, at, uvec4(kEmpty));
#ifdef HAS_OUT_MET
        blurs_px += blurs_of(p - way_in(key), layer_in(key), at_infinity_px);
#endif
#ifdef HAS_HIDDEN
        if (layer_in(key) == kEstimatedLayer) {
            sum += texelFetch(hidden, p - way_in(key), 0) - own;
            missing.x += 1.0;
            continue;
        }
#endif
        sum += light_of(p - way_in(key), layer_in(key)) - own;
    }
    out_sum = sum;
    out_gaps = missing;
#ifdef HAS_OUT_MET
    out_met = blurs_px;
#endif
}
