// Edges of surfaces by blocks of pixels, which say where a patch may be.
#include "tile.glsl"
#include <lens/highlight.glsl>

const int kBlock = 8;  // px, as effect.json declares edges and beyond
const float kNoEdge = -1000.0;

// The far side of an edge may slope up to what is clearly behind a pixel.
const float kBehindPx = 0.5 * kClear;

// A difference of CoC radii between neighbours from which on there is an edge; a slope, however long, hides nothing.
bool has_edges(ivec2 tile) {
    return is_repaired(texelFetch(tile_step, tile, 0).r);
}
