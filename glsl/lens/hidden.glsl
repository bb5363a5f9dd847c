// What lies behind near things out of focus, by layers of the capture. After lens.glsl, where it knows layers.
#include <coverage.glsl>
#include <lens/highlight.glsl>

const float kNearPx = 1.0;  // CoC radius from which a surface in front of the focus lets what it hides be seen

// The first layer behind that is not near and out of focus, or else the last one; 0: there is none.
int layer_behind(Layers layers) {
    int behind = 0;
    for (int k = 1; k < kLayers; ++k)
        if (has_coverage(layers.color[k].a) && (behind == 0 || layers.coc[behind] < -kNearPx)) behind = k;
    return behind;
}

// That layer behind a surface of this CoC radius (px); 0 where the surface is not near, or the layer is one with it.
int layer_hidden_by(float coc, Layers layers) {
    int behind = layer_behind(layers);
    return coc < -kNearPx && layers.coc[behind] - coc > kOneSurfacePx ? behind : 0;
}
