// What becomes of a tile: the draws of a list, and nothing where nothing moves.
#include "motion.glsl"
#include "tile_kinds.glsl"

uint kind_of(ivec2 tile) { return texelFetch(around_kind, tile, 0).r; }

bool even_tiles(ivec2 tile) { return kind_of(tile) == kEven; }

bool uneven_tiles(ivec2 tile) { return kind_of(tile) == kUneven; }

bool veiled_tiles(ivec2 tile) { return kind_of(tile) == kVeiled; }

bool crowded_tiles(ivec2 tile) { return kind_of(tile) == kCrowded; }
