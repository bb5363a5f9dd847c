// With layers of the capture, near things out of focus that have something behind them are blurred by themselves and laid over the rest,
// in which bulbs behind them are then whole.
#include <lens/lens.glsl>

const float kNearPx = 1.0;  // CoC radius from which a surface in front of the focus hides as much as it shows
const float kWholePixel = 0.999;

struct Parted {
    Light front;   // alpha 0: nothing
    Light behind;
};

// The first layer behind that is not near and out of focus, or else the last one; 0: there is none.
int layer_behind(Layers layers) {
    int behind = 0;
    for (int k = 1; k < kLayers; ++k)
        if (layers.color[k].a > 0.0 && (behind == 0 || layers.coc[behind] < -kNearPx)) behind = k;
    return behind;
}

Parted parted_at(ivec2 p, vec4 texel, float radius) {
    Parted parted = Parted(Light(vec4(0.0), 0.0), Light(texel, radius));
    Layers layers = layers_at(p, lens_at_infinity_px());
    Light own = Light(vec4(texel.rgb, 1.0), radius);
#if defined(HAS_NEAREST) && defined(HAS_NEAREST_DEPTH)
    vec4 part = texelFetch(nearest, p, 0);
    if (part.a > 0.0 && part.a < kWholePixel)
        own = Light(part, coc_of(texelFetch(nearest_depth, p, 0).r, lens_at_infinity_px()));
#endif
    int behind = layer_behind(layers);
    bool is_front = own.coc < -kNearPx && behind > 0 && layers.coc[behind] - own.coc > kOneSurfacePx;
    if (!is_front) return parted;
    vec4 hidden = layers.color[behind];
    return Parted(own, Light(vec4(hidden.rgb / hidden.a, texel.a), layers.coc[behind]));
}
