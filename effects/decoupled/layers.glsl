// A surfel of a layer of the capture, 0 in front.
#if defined(HAS_FRONT) && defined(HAS_FRONT_DEPTH) && defined(HAS_SECOND)
#define HAS_LAYER_0
#endif
#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
#define HAS_LAYER_1
#endif
#if defined(HAS_THIRD) && defined(HAS_THIRD_DEPTH)
#define HAS_LAYER_2
#endif
#if defined(HAS_FOURTH) && defined(HAS_FOURTH_DEPTH)
#define HAS_LAYER_3
#endif

Surfel surfel_behind(float alpha, float depth_m, vec2 since, float at_infinity_px) {
    since = finite(since);
    return Surfel(depth_m, coc_of(depth_m, at_infinity_px), path_of(since, since), alpha);
}

Surfel surfel_at(int layer, ivec2 p, float at_infinity_px) {
    vec2 since = vec2(0.0);
#ifdef HAS_LAYER_1
    if (layer == 1) {
#ifdef HAS_SECOND_VELOCITY
        since = texelFetch(second_velocity, p, 0).xy;
#endif
        return surfel_behind(texelFetch(second, p, 0).a, texelFetch(second_depth, p, 0).r, since, at_infinity_px);
    }
#endif
#ifdef HAS_LAYER_2
    if (layer == 2) {
#ifdef HAS_THIRD_VELOCITY
        since = texelFetch(third_velocity, p, 0).xy;
#endif
        return surfel_behind(texelFetch(third, p, 0).a, texelFetch(third_depth, p, 0).r, since, at_infinity_px);
    }
#endif
#ifdef HAS_LAYER_3
    if (layer == 3) {
#ifdef HAS_FOURTH_VELOCITY
        since = texelFetch(fourth_velocity, p, 0).xy;
#endif
        return surfel_behind(texelFetch(fourth, p, 0).a, texelFetch(fourth_depth, p, 0).r, since, at_infinity_px);
    }
#endif
#ifdef HAS_LAYER_0
    float share = texelFetch(front, p, 0).a;
    if (share >= kNothing && share < kWhole) {
#ifdef HAS_FRONT_VELOCITY
        since = texelFetch(front_velocity, p, 0).xy;
#endif
        return surfel_behind(share, texelFetch(front_depth, p, 0).r, since, at_infinity_px);
    }
#endif
    return Surfel(texelFetch(depth, p, 0).r, texelFetch(coc, p, 0).r, path_at(p), layer == 0 ? 1.0 : 0.0);
}
