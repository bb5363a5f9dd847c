// With layers of the capture, near things out of focus that have something behind them are blurred by themselves and laid over the rest,
// in which bulbs behind them are then whole.
#include <lens/lens.glsl>
#include <lens/hidden.glsl>

const float kWholePixel = 0.999;

struct Parted {
    Light front;   // alpha 0: nothing
    Light behind;
};

Parted parted_at(ivec2 p, vec4 texel, float radius) {
    Layers layers = layers_at(p, lens_at_infinity_px());
    Light own = Light(vec4(texel.rgb, 1.0), radius);
#if defined(HAS_NEAREST) && defined(HAS_NEAREST_DEPTH)
    vec4 part = texelFetch(nearest, p, 0);
    if (part.a > 0.0 && part.a < kWholePixel)
        own = Light(part, coc_of(texelFetch(nearest_depth, p, 0).r, lens_at_infinity_px()));
#endif
    int behind = layer_hidden_by(own.coc, layers);
    if (behind == 0) return Parted(Light(vec4(0.0), 0.0), Light(texel, radius));
    vec4 hidden = layers.color[behind];
    return Parted(own, Light(vec4(hidden.rgb / hidden.a, texel.a), layers.coc[behind]));
}
