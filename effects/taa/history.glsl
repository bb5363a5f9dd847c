// History between pixels, by single texels: where nothing moves it is the pixel's own, bit for bit.

// The sampler takes the texel whose centre this is, or the edge's: on llvmpipe faster than texelFetch() with a clamp.
vec4 kept_at(ivec2 p) { return textureLod(kept_prev, (vec2(p) + 0.5) * kept_prev_size.zw, 0.0); }

#if HISTORY_FILTER == HISTORY_FILTER_BILINEAR
vec4 history_at(vec2 px) {
    ivec2 base = ivec2(floor(px - 0.5));
    vec2 t = px - 0.5 - vec2(base);
    return mix(mix(kept_at(base), kept_at(base + ivec2(1, 0)), t.x),
               mix(kept_at(base + ivec2(0, 1)), kept_at(base + ivec2(1, 1)), t.x), t.y);
}
#else
// 4 x 4 texels without the corners, which count least. Held to the range of what it reads: the negative lobes would let an edge
// grow from frame to frame, and make light negative.
vec4 history_at(vec2 px) {
    ivec2 base = ivec2(floor(px - 0.5));
    vec2 t = px - 0.5 - vec2(base);
    vec2 weights[4] = vec2[](t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (-2.5 + 1.5 * t),
                             t * (0.5 + t * (2.0 - 1.5 * t)), t * t * (-0.5 + 0.5 * t));
    vec4 sum = vec4(0.0), least = kept_at(base), greatest = least;
    float weight_sum = 0.0;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            if ((i == 0 || i == 3) && (j == 0 || j == 3)) continue;
            vec4 texel = kept_at(base + ivec2(i, j) - 1);
            float weight = weights[i].x * weights[j].y;
            sum += weight * texel;
            weight_sum += weight;
            least = min(least, texel);
            greatest = max(greatest, texel);
        }
    return clamp(sum / weight_sum, least, greatest);
}
#endif
