// The capture's layers at a pixel, and the surface that stands for it where they share it. Included by lens.glsl.
#define KNOWS_LAYERS
#include <coverage.glsl>
#if defined(HAS_FIRST) && defined(HAS_FIRST_DEPTH)
#define SHARES_PIXELS
#endif

const int kLayers = 4;
const float kSharedPx = 1.0;  // difference of CoC radii of layers that are one surface

struct Layers {
    vec4 color[kLayers];  // premultiplied
    float coc[kLayers];
};

Layers layers_at(ivec2 p, float at_infinity_px) {
    Layers layers;
#ifdef SHARES_PIXELS
    layers.color[0] = texelFetch(first, p, 0);
    layers.coc[0] = coc_of(texelFetch(first_depth, p, 0).r, at_infinity_px);
#else
    layers.color[0] = vec4(texelFetch(color, p, 0).rgb, 1.0);
    layers.coc[0] = coc_of(texelFetch(depth, p, 0).r, at_infinity_px);
#endif
    layers.color[1] = texelFetch(second, p, 0);
    layers.coc[1] = coc_of(texelFetch(second_depth, p, 0).r, at_infinity_px);
#if defined(HAS_THIRD) && defined(HAS_THIRD_DEPTH)
    layers.color[2] = texelFetch(third, p, 0);
    layers.coc[2] = coc_of(texelFetch(third_depth, p, 0).r, at_infinity_px);
#else
    layers.color[2] = vec4(0.0);
    layers.coc[2] = at_infinity_px;
#endif
#if defined(HAS_FOURTH) && defined(HAS_FOURTH_DEPTH)
    layers.color[3] = texelFetch(fourth, p, 0);
    layers.coc[3] = coc_of(texelFetch(fourth_depth, p, 0).r, at_infinity_px);
#else
    layers.color[3] = vec4(0.0);
    layers.coc[3] = at_infinity_px;
#endif
    return layers;
}

// Layers that are one surface with a given one, composited, without `from` layers in front; alpha: their share of the rest.
vec4 composite_of(Layers layers, int given, int from) {
    vec4 sum = vec4(0.0);
    float left = 1.0;
    for (int k = from; k < kLayers; ++k) {
        if (abs(layers.coc[k] - layers.coc[given]) <= kSharedPx) sum += left * layers.color[k];
        left *= 1.0 - layers.color[k].a;
    }
    return sum;
}

#ifdef SHARES_PIXELS
const float kFocusPx = 2.0;   // CoC radius below which a surface keeps its antialiasing
const float kBlurredPx = 4.0;  // and from which it makes way for what is behind
const float kWholePixel = 0.999;

struct Surface {
    vec4 color;      // not premultiplied
    float coc;
    bool is_shared;  // otherwise the picture's own colour and depth are the surface's
};

// A layer in focus and all behind it, composited, with the CoC of the one that holds most of it, if that is well out of focus. The
// blur of another would take the antialiasing away.
Surface surface_in_focus(Layers layers, int from) {
    vec4 sum = vec4(0.0);
    float left = 1.0, most = 0.0, coc = layers.coc[from];
    for (int k = from; k < kLayers; ++k) {
        float share = left * layers.color[k].a;
        if (share > most && abs(layers.coc[k]) >= kBlurredPx) coc = layers.coc[k];
        most = max(most, share);
        sum += left * layers.color[k];
        left *= 1.0 - layers.color[k].a;
    }
    return Surface(sum / sum.a, coc, true);
}

// Surfaces out of focus are drawn by lot, each by its share: a blur then spreads as much of each as there is, and each pixel's
// light is of one surface. The first in focus takes the rest with all behind it, which is its antialiasing.
// The lot is the interleaved gradient noise of Jimenez 2014, Next Generation Post Processing in Call of Duty: Advanced Warfare.
Surface surface_at(ivec2 p, float at_infinity_px) {
    float alpha = texelFetch(first, p, 0).a;
    Surface whole = Surface(vec4(0.0), coc_of(texelFetch(depth, p, 0).r, at_infinity_px), false);
    if (!has_coverage(alpha) || alpha >= kWholePixel) return whole;
    Layers layers = layers_at(p, at_infinity_px);
    float lot = fract(52.9829189 * fract(dot(vec2(p), vec2(0.06711056, 0.00583715))));
    float left = 1.0, drawn = 0.0;
    for (int k = 0; k < kLayers; ++k) {
        if (!has_coverage(layers.color[k].a)) continue;
        if (abs(layers.coc[k]) < kFocusPx) return surface_in_focus(layers, k);
        drawn += left * layers.color[k].a;
        if (lot < drawn) {
            vec4 sum = composite_of(layers, k, 0);
            return Surface(sum / sum.a, layers.coc[k], true);
        }
        left *= 1.0 - layers.color[k].a;
    }
    return whole;
}
#endif
