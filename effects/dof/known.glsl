#include <behind.glsl>
#include <lens/lens.glsl>

// What the capture's layers have behind a pixel.
#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
#define KNOWS_BEHIND

const float kOneLayerPx = 2.0;  // difference of CoC radii on one surface

struct Known {
    Light light;
    bool is_there;
};

Known known_of(vec4 behind, float depth_m, float least_coc_px) {
    Light light = Light(covering(behind), coc_of(depth_m, lens_at_infinity_px()));
    return Known(light, light.color.a > 0.0 && light.coc > least_coc_px - kOneLayerPx);
}

// The first layer that does not lie clearly in front of least_coc_px.
Known known_behind(ivec2 p, float least_coc_px) {
    Known known = known_of(texelFetch(second, p, 0), texelFetch(second_depth, p, 0).r, least_coc_px);
#if defined(HAS_THIRD) && defined(HAS_THIRD_DEPTH)
    if (!known.is_there) known = known_of(texelFetch(third, p, 0), texelFetch(third_depth, p, 0).r, least_coc_px);
#endif
#if defined(HAS_FOURTH) && defined(HAS_FOURTH_DEPTH)
    if (!known.is_there) known = known_of(texelFetch(fourth, p, 0), texelFetch(fourth_depth, p, 0).r, least_coc_px);
#endif
    return known;
}
#endif
