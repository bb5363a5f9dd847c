// Edges of surfaces by blocks of pixels, which say where a patch may be.
#include "tile.glsl"
#include "levels.glsl"
#include <lens/highlight.glsl>

const float kNoEdge = -1000.0;
const float kNoNarrow = 1000.0;  // px

// The far side of an edge may slope up to what is clearly behind a pixel.
const float kBehindPx = 0.5 * kClear;

// A difference of CoC radii between neighbours from which on there is an edge; a slope, however long, hides nothing.
bool has_edges(ivec2 tile) {
    return is_repaired(texelFetch(tile_step, tile, 0).r);
}

// What of CoC radii between these is of a blur too narrow for half size: the smallest.
float narrow_of(float smallest_px, float largest_px) {
    return smallest_px < kFullSizePx && largest_px > -kFullSizePx ? max(smallest_px, -kFullSizePx) : kNoNarrow;
}
