#include <lens/lens.glsl>

// What the capture's layers have behind a pixel.
#ifdef KNOWS_LAYERS
#if HIGHLIGHTS == HIGHLIGHTS_SCATTER
#define FINDS_HIGHLIGHTS
#endif

const float kOneLayerPx = 2.0;  // difference of CoC radii of a surface and a guess of it

struct Known {
    Light light;
    bool is_there;
};

// Share of what is left of a pixel at a layer that it and those behind it hold.
float rest_of(Layers layers, int from) {
    float left = 1.0;
    for (int k = from; k < kLayers; ++k) left *= 1.0 - layers.color[k].a;
    return 1.0 - left;
}

// Of what has more than least_coc_px, the nearest surface that holds most of the rest of the pixel.
Known known_behind(Layers layers, float least_coc_px) {
    for (int k = 1; k < kLayers; ++k) {
        if (!has_coverage(layers.color[k].a) || layers.coc[k] <= least_coc_px) continue;
        vec4 sum = composite_of(layers, k, k);
        if (sum.a > 0.5 * rest_of(layers, k)) return Known(Light(sum / sum.a, layers.coc[k]), true);
    }
    return Known(Light(vec4(0.0), 0.0), false);
}
#endif
