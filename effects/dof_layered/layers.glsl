// Which layers there are and what a pixel is in each. Layers are numbered from near to far. Their anchors are even in CoC
// from the nearest pixel's to the farthest's, kStep apart or, where there are too few, more; one is the focus plane.
const int kLayers = 24;  // as effect.json declares
const int kTile = 32;    // px; sums along a row restart so often
const int kRangeTile = 64;  // px a side of the tiles of range_tile
const int kOccupied = 16;  // px a side of the tiles of `occupied`

// Whether the sums along a row restart at a column. The last one stands alone: it is taken many times.
bool starts_run(int column, int width) { return column % kTile == 0 || column == width - 1; }

struct Layers {
    float near_px, far_px;  // largest CoC radius beyond kSharp
    int near_count, far_count;
};

// Pixels with a smaller CoC radius are in focus, px.
const float kSharp = 0.5;
const float kStep = 1.5;  // px of CoC radius

Layers make_layers(vec2 largest_px) {
    Layers layers;
    layers.near_px = max(largest_px.x - kSharp, 0.0);
    layers.far_px = max(largest_px.y - kSharp, 0.0);
    float share = layers.near_px / max(layers.near_px + layers.far_px, 1e-6);
    layers.near_count = clamp(int(float(kLayers - 1) * share + 0.5), layers.near_px > 0.0 ? 1 : 0,
                              kLayers - (layers.far_px > 0.0 ? 2 : 1));
    layers.far_count = layers.far_px > 0.0 ? kLayers - 1 - layers.near_count : 0;
    layers.near_count = min(layers.near_count, int(ceil(layers.near_px / kStep)));
    layers.far_count = min(layers.far_count, int(ceil(layers.far_px / kStep)));
    return layers;
}

int layer_count(Layers layers) { return layers.near_count + 1 + layers.far_count; }

// A layer's number between anchors.
float layer_of(Layers layers, float coc) {
    float blurred = max(abs(coc) - kSharp, 0.0);
    if (blurred == 0.0) return float(layers.near_count);
    return coc < 0.0 ? float(layers.near_count) * (1.0 - blurred / layers.near_px)
                     : float(layers.near_count) + float(layers.far_count) * (blurred / layers.far_px);
}

// Signed CoC radius of a layer, px.
float layer_radius(Layers layers, int layer) {
    int behind = layer - layers.near_count;
    if (behind == 0 || behind > layers.far_count) return 0.0;
    return behind < 0 ? float(behind) / float(layers.near_count) * layers.near_px - kSharp
                      : float(behind) / float(layers.far_count) * layers.far_px + kSharp;
}

// What a pixel is in a layer that lies `behind` layers behind it.
float seen_in(float behind) { return max(1.0 - abs(behind), 0.0); }
// The same with all layers behind that one: what the layer's opacity is a share of.
float seen_from(float behind) { return clamp(1.0 - behind, 0.0, 1.0); }
// How much the push-pull counts for a pixel. Less than two layers behind a surface it is the surface itself that continues,
// and counting it twice would harden its silhouette.
float hidden_in(float behind) { return clamp(behind - 1.0, 0.0, 1.0); }
